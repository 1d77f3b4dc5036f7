#include "plugins/common/surface/point_normals.h"
#include "plugins/register/icp/icp.h"

#include "kernel/stage/plugin.h"

namespace {
using namespace pectora;

class Icp final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.real("max_distance", settings_.maxDistance, "mm", {0.1, 1000}, {5, 60}, "Points further away than this have no counterpart");
    v.real("overlap", settings_.overlap, "", {0.05, 1}, {0.5, 1}, "Share of the points with a counterpart that is kept: the nearest ones");
    v.real("normal_angle", settings_.normalAngle, "deg", {1, 180}, {20, 90}, "Largest angle between the normals of a point and its counterpart");
    v.real("change_threshold", settings_.changeThreshold, "mm", {0, 100}, {1, 6}, "Left out is where fixed and changed differ by more than this");
    v.real("change_margin", settings_.changeMargin, "mm", {0, 200}, {0, 40}, "What lies within this of it is left out, too");
    v.reals("exclude", ball_, "mm", {-1e6, 1e6}, "A ball that is left out: x, y, z and radius, in the fixed surface's coordinates");
    v.integer("coarse_points", settings_.coarsePoints, "", {100, 1000000}, {1000, 20000}, "Points of the first level; each further one has ten times as many");
    v.integer("fine_points", settings_.finePoints, "", {100, 100000000}, {10000, 1000000}, "Points of the last level, at most");
    v.integer("max_iterations", settings_.maxIterations, "", {1, 10000}, {20, 200}, "Iterations over all levels");
    v.real("tolerance", settings_.tolerance, "mm", {1e-9, 10}, {1e-3, 0.1}, "Converged when no point moves further in one iteration");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    if (!ball_.empty()) {
      if (ball_.size() != 4 || !(ball_[3] > 0)) throw Error("a ball has a centre and a radius above 0").of("exclude").allowed("{ x, y, z, radius }");
      settings_.ballCenter = {ball_[0], ball_[1], ball_[2]};
      settings_.ballRadius = ball_[3];
    }
    const auto mesh = inputs.get<Mesh>("moving");
    const auto cloud = inputs.get<Points>("moving");
    const std::vector<Vec3> normals = mesh ? pointNormals(*mesh) : cloud->normals;
    const auto poll = [&](double fraction) {
      host.checkCancel();
      host.progress(fraction, "aligning surfaces");
    };
    auto registration = std::make_shared<Registration>(
        alignSurface({mesh ? mesh->points : cloud->points, normals}, *inputs.get<Mesh>("fixed"), inputs.get<Mesh>("changed").get(), settings_, poll));
    for (const Fact& fact : registration->details) {
      const auto* text = std::get_if<std::string>(&fact.value);
      if (!text || fact.name != "status" || *text == "converged") continue;
      host.warn(*text == "stopped" ? "the alignment was still moving at the last iteration: raise max_iterations"
                                   : "the surfaces leave a direction free, in which the scan stays where it was");
    }

    if (mesh) {
      auto aligned = std::make_shared<Mesh>(*mesh);
      for (Vec3& p : aligned->points) p = registration->map(p);
      return {aligned, registration};
    }
    auto aligned = std::make_shared<Points>(*cloud);
    for (Vec3& p : aligned->points) p = registration->map(p);
    for (Vec3& n : aligned->normals) n = registration->map.rotate(n);
    return {aligned, registration};
  }

 private:
  IcpSettings settings_;
  std::vector<double> ball_;
};

}  // namespace

PECTORA_STAGE(Icp, {.id = "register.icp", .version = "1.0",
                    .summary = "Aligns a scan that lies nearly right with a surface, on what the operation does not change",
                    .references = "Chen and Medioni, Image and Vision Computing 1992; Beaton and Tukey, Technometrics 1974 (weights)",
                    .inputs = {{"moving", {"Points", "Mesh"}}, {"fixed", {"Mesh"}}, {"changed", {"Mesh"}, true}},
                    .outputs = {{"aligned", {"Points", "Mesh"}}, {"registration", {"Registration"}}}})
