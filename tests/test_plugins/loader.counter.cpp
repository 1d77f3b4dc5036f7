// A loader that says in each volume how often it was run.
#include "kernel/stage/plugin.h"
#include "kernel/value/volume.h"

namespace {
using namespace pectora;
int runs = 0;

class Counter final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.integer("size", size_, "", {1, 64}, {1, 16}, "Voxels along each side");
    v.real("level", level_, "HU", {-1000, 3000}, {-1000, 1000}, "Value of every voxel");
    v.choice("texture", texture_, {"plain", "noisy"}, "Kind of filling");
    v.flag("warns", warns_, "Whether to warn");
    v.text("path", path_, TextRole::inputPath, "A file whose bytes matter");
    v.text("target", target_, TextRole::outputPath, "A file that does not");
    v.reals("weights", weights_, "kg", {0, 10}, "Numbers");
    v.texts("tags", tags_, TextRole::plain, "Words");
  }
  Outputs run(const Inputs&, Host& host) override {
    if (warns_) host.warn("as asked");
    auto volume = std::make_shared<Volume>();
    volume->grid.size = {size_, size_, size_};
    volume->grid.origin.x = ++runs;
    volume->hu.assign(volume->grid.voxels(), std::int16_t(level_));
    return {volume};
  }

 private:
  int size_ = 4;
  double level_ = 0;
  std::string texture_ = "plain", path_, target_;
  bool warns_ = false;
  std::vector<double> weights_{1, 2};
  std::vector<std::string> tags_;
};
}  // namespace

PECTORA_STAGE(Counter, {.id = "loader.counter", .version = "1.0", .summary = "Counts its runs", .outputs = {{"ct", {"Volume"}}}})
