// Calls itself by another name than its file.
#include "kernel/stage/plugin.h"

namespace {
class Misnamed final : public pectora::Stage {
 public:
  void describe(pectora::Visitor&) override {}
  pectora::Outputs run(const pectora::Inputs&, pectora::Host&) override { return {}; }
};
}  // namespace

PECTORA_STAGE(Misnamed, {.id = "loader.other", .version = "1.0", .summary = "Misnamed"})
