// Returns fewer values than it promised.
#include "kernel/stage/plugin.h"

namespace {
class Short final : public pectora::Stage {
 public:
  void describe(pectora::Visitor&) override {}
  pectora::Outputs run(const pectora::Inputs&, pectora::Host&) override { return {}; }
};
}  // namespace

PECTORA_STAGE(Short, {.id = "segmenter.short", .version = "1.0", .summary = "Returns too little", .outputs = {{"ct", {"Volume"}}}})
