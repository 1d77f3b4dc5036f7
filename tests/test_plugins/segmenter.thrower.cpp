// Throws what it is asked to.
#include "kernel/stage/plugin.h"
#include "kernel/value/volume.h"

#include <new>
#include <stdexcept>

namespace {
using namespace pectora;

class Thrower final : public Stage {
 public:
  void describe(Visitor& v) override { v.choice("what", what_, {"error", "failed", "standard", "memory", "cancelled"}, "What to throw"); }
  Outputs run(const Inputs&, Host&) override {
    if (what_ == "error") throw Error("the slice is bad").of("ct").advise("Get another");
    if (what_ == "failed") throw Error("it did not converge", ErrorKind::runFailed);
    if (what_ == "memory") throw std::bad_alloc();
    if (what_ == "cancelled") throw Cancelled();
    throw std::runtime_error("surprise");
  }

 private:
  std::string what_ = "error";
};
}  // namespace

PECTORA_STAGE(Thrower, {.id = "segmenter.thrower", .version = "1.0", .summary = "Throws", .outputs = {{"ct", {"Volume"}}}})
