// Works until it is cancelled.
#include "kernel/stage/plugin.h"

#include <chrono>
#include <thread>

namespace {
class Slow final : public pectora::Stage {
 public:
  void describe(pectora::Visitor&) override {}
  pectora::Outputs run(const pectora::Inputs&, pectora::Host& host) override {
    for (int i = 0; i < 6000; ++i) {
      host.checkCancel();
      host.progress(i / 6000.0, "waiting");
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return {nullptr};
  }
};
}  // namespace

PECTORA_STAGE(Slow, {.id = "segmenter.slow", .version = "1.0", .summary = "Waits for half a minute", .outputs = {{"ct", {"Volume"}}}})
