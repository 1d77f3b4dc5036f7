#include "plugins/register/landmarks/fit.h"

#include "kernel/stage/plugin.h"

#include <fmt/format.h>

#include <cmath>

namespace {
using namespace pectora;

class LandmarkRegistration final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.choice("method", method_, {"rigid", "similarity", "affine"},
             "rigid: rotation and shift; similarity: with one scale; affine: the paper's, exact on four landmarks and so blind to their errors");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    const auto pairs = pairLandmarks(*inputs.get<Landmarks>("moving_landmarks"), *inputs.get<Landmarks>("fixed_landmarks"));
    const MapKind kind = method_ == "affine" ? MapKind::affine : method_ == "similarity" ? MapKind::similarity : MapKind::rigid;
    auto registration = std::make_shared<Registration>(fitLandmarks(pairs, kind));
    if (kind == MapKind::affine && pairs.size() == 4)
      host.warn("an affine map through four landmarks has no residual whatever their errors: it can hide or make up centimetres");
    if (kind != MapKind::rigid && std::abs(registration->scale - 1) > 0.05)
      host.warn(fmt::format("the map scales by {:.3f}: check the units of the scan", registration->scale));

    if (const auto mesh = inputs.get<Mesh>("moving")) {
      auto aligned = std::make_shared<Mesh>(*mesh);
      for (Vec3& p : aligned->points) p = registration->map(p);
      return {aligned, registration};
    }
    auto aligned = std::make_shared<Points>(*inputs.get<Points>("moving"));
    for (Vec3& p : aligned->points) p = registration->map(p);
    for (Vec3& n : aligned->normals) n = normalized(registration->map.rotate(n));
    return {aligned, registration};
  }

 private:
  std::string method_ = "rigid";
};

}  // namespace

PECTORA_STAGE(LandmarkRegistration, {.id = "register.landmarks", .version = "1.0",
                                     .summary = "Brings a scan onto the CT's skin by landmarks placed on both",
                                     .references = "Umeyama, IEEE TPAMI 1991; Moreira et al., SPIE 2012 (affine on neck, navel and nipples)",
                                     .inputs = {{"moving", {"Points", "Mesh"}}, {"moving_landmarks", {"Landmarks"}}, {"fixed_landmarks", {"Landmarks"}}},
                                     .outputs = {{"aligned", {"Points", "Mesh"}}, {"registration", {"Registration"}}}})
