#include "plugins/scan/rbf/reconstruct.h"

#include "kernel/stage/plugin.h"

#include <fmt/format.h>

namespace {
using namespace pectora;

class Rbf final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.real("noise", settings_.noise, "mm", {0, 50}, {0, 3}, "Standard deviation of the points along their normals, which is smoothed away; 0: estimated");
    v.real("cell", settings_.cell, "mm", {0.1, 100}, {1, 5}, "Size of the triangles");
    v.real("fill", settings_.fill, "mm", {0, 200}, {0, 30}, "Holes that are nowhere further than this from a point are filled, others stay open");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    const auto cloud = inputs.get<Points>("scan");
    Reconstruction made = reconstruct(cloud->points, cloud->normals, settings_, [&](double fraction) {
      host.checkCancel();
      host.progress(fraction, "fitting the surface");
    });
    host.info(fmt::format("{} points {:.2f} mm apart, noise {:.2f} mm, normals {}: {} local fits, {} triangles", cloud->points.size(), made.spacing, made.noise,
                          made.estimatedNormals ? "estimated" : "given", made.balls, made.mesh.triangles.size()));
    return {std::make_shared<Mesh>(std::move(made.mesh))};
  }

 private:
  ReconstructSettings settings_;
};

}  // namespace

PECTORA_STAGE(Rbf, {.id = "scan.rbf", .version = "1.0",
                    .summary = "Makes a surface of triangles from a scanned cloud by radial basis functions",
                    .references = "Carr et al., SIGGRAPH 2001; Wendland, Approximation Theory X, 2002 (partition of unity); Hoppe et al., SIGGRAPH 1992 (normals)",
                    .inputs = {{"scan", {"Points"}}},
                    .outputs = {{"surface", {"Mesh"}}}})
