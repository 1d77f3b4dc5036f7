// A flat wall whose anchors are pushed forwards, and solvers on it as scripts see them.
#pragma once

#include "kernel/host/compile.h"
#include "tests/kernel/host/helpers.h"

#include "kernel/value/motion.h"
#include "kernel/value/plan.h"

#include <cmath>

namespace pectora {

// A wall of points x points on a "sternum" that moves as a whole.
struct Wall {
  std::shared_ptr<Scene> scene = std::make_shared<Scene>();
  std::shared_ptr<Plan> plan = std::make_shared<Plan>();

  explicit Wall(double lift, double stiffnessScale = 1, int points = 17) {
    auto cage = std::make_shared<RibCage>();
    cage->anatomy = std::make_shared<Anatomy>();
    scene->cage = cage;
    plan->cage = cage;
    scene->rows = scene->columns = points;
    scene->rowSpacing = scene->columnSpacing = 8;
    scene->thickness = 20;
    for (int r = 0; r < points; ++r)
      for (int c = 0; c < points; ++c) {
        scene->outer.push_back({8.0 * c, -20, 8.0 * r});
        scene->inner.push_back({8.0 * c, 0, 8.0 * r});
        // The middle hangs on what moves, the rim on what does not.
        const bool moves = std::hypot(r - points / 2, c - points / 2) < 3.5;
        for (const Vec3 offset : {Vec3{0, 6, 0}, Vec3{7, 3, 0}, Vec3{0, 3, 7}})
          scene->anchors.push_back({scene->index(r, c), moves ? BodyKind::sternum : BodyKind::rib, 0, 0, scene->inner.back() + offset});
      }
    scene->outerMass.assign(std::size_t(points) * points, 1e-3);
    scene->innerMass = scene->outerMass;
    scene->effects = {call("effect.stretch", {{"youngs_modulus", 200 * stiffnessScale}}), call("effect.shear", {{"youngs_modulus", 200 * stiffnessScale}}),
                      call("effect.bend", {{"youngs_modulus", 200 * stiffnessScale}}), call("effect.direct", {{"youngs_modulus", 10 * stiffnessScale}}),
                      call("effect.cross", {{"youngs_modulus", 10 * stiffnessScale}}), call("effect.attachment", {{"youngs_modulus", 60 * stiffnessScale}})};
    plan->bars = {{.lift = lift}};
    plan->motion.translation = {0, -lift, 0};
    plan->frames.assign(2, {});
  }
};

struct Solve {
  std::string id;
  Registry registry{{PECTORA_PLUGINS, PECTORA_TEST_PLUGINS}};
  RecordedMessages messages;
  std::atomic<bool> cancel{false};
  Runner runner{registry, messages, cancel};

  explicit Solve(std::string solver) : id(std::move(solver)) {}
  std::shared_ptr<const Motion> operator()(const Wall& wall, Settings settings, std::shared_ptr<const Motion> start = nullptr) {
    const auto record = std::make_shared<Record>();
    record->key = std::to_string(wall.plan->lift()) + std::to_string(std::uintptr_t(wall.scene.get())) + std::to_string(std::uintptr_t(start.get()));
    std::vector<Handle> starts;
    if (start) starts.push_back({start, record});
    return std::dynamic_pointer_cast<const Motion>(runner.run(id, settings, {{{wall.scene, record}}, {{wall.plan, record}}, starts})[0].value);
  }
};

inline double largestDifference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, distance(a[i], b[i]));
  return largest;
}

}  // namespace pectora
