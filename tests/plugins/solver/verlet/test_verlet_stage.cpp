// The solver as scripts see it, on a flat wall whose anchors are pushed forwards.
#include "tests/kernel/host/helpers.h"

#include "kernel/physics/workers.h"
#include "kernel/value/motion.h"
#include "kernel/value/plan.h"

#include <cmath>

using namespace pectora;

namespace {

// A wall of 17 x 17 points on a "sternum" that moves as a whole.
struct Wall {
  std::shared_ptr<Scene> scene = std::make_shared<Scene>();
  std::shared_ptr<Plan> plan = std::make_shared<Plan>();

  explicit Wall(double lift, double stiffnessScale = 1) {
    auto cage = std::make_shared<RibCage>();
    cage->anatomy = std::make_shared<Anatomy>();
    scene->cage = cage;
    plan->cage = cage;
    scene->rows = scene->columns = 17;
    scene->rowSpacing = scene->columnSpacing = 8;
    scene->thickness = 20;
    for (int r = 0; r < 17; ++r)
      for (int c = 0; c < 17; ++c) {
        scene->outer.push_back({8.0 * c, -20, 8.0 * r});
        scene->inner.push_back({8.0 * c, 0, 8.0 * r});
        // The middle hangs on what moves, the rim on what does not.
        const bool moves = std::hypot(r - 8, c - 8) < 3.5;
        for (const Vec3 offset : {Vec3{0, 6, 0}, Vec3{7, 3, 0}, Vec3{0, 3, 7}})
          scene->anchors.push_back({scene->index(r, c), moves ? BodyKind::sternum : BodyKind::rib, 0, 0, scene->inner.back() + offset});
      }
    scene->outerMass.assign(17 * 17, 1e-3);
    scene->innerMass = scene->outerMass;
    scene->effects = {call("effect.stretch", {{"youngs_modulus", 200 * stiffnessScale}}), call("effect.shear", {{"youngs_modulus", 200 * stiffnessScale}}),
                      call("effect.bend", {{"youngs_modulus", 200 * stiffnessScale}}), call("effect.direct", {{"youngs_modulus", 10 * stiffnessScale}}),
                      call("effect.cross", {{"youngs_modulus", 10 * stiffnessScale}}), call("effect.attachment", {{"youngs_modulus", 60 * stiffnessScale}})};
    plan->lift = lift;
    plan->motion.translation = {0, -lift, 0};
    plan->frames.assign(2, {});
  }
};

struct Solve {
  Registry registry{{PECTORA_PLUGINS}};
  RecordedMessages messages;
  std::atomic<bool> cancel{false};
  Runner runner{registry, messages, cancel};

  std::shared_ptr<const Motion> operator()(const Wall& wall, Settings settings) {
    const auto record = std::make_shared<Record>();
    record->key = std::to_string(wall.plan->lift) + std::to_string(std::uintptr_t(wall.scene.get()));
    return std::dynamic_pointer_cast<const Motion>(runner.run("solver.verlet", settings, {{{wall.scene, record}}, {{wall.plan, record}}, {}})[0].value);
  }
};

double largestDifference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, distance(a[i], b[i]));
  return largest;
}

}  // namespace

TEST(VerletSolver, ConvergesAndLiftsTheSkinWithTheBar) {
  const Wall wall(15);
  const auto motion = Solve()(wall, {});
  EXPECT_EQ(motion->status, SolveStatus::converged);
  EXPECT_EQ(motion->invertedPrisms, 0);
  const int middle = 8 * 17 + 8;
  const double lifted = -20 - motion->outer[middle].y;
  EXPECT_GT(lifted, 9);    // the skin follows
  EXPECT_LT(lifted, 15.5); // and not beyond the bar
  EXPECT_LT(distance(motion->outer[0], wall.scene->outer[0]), 1.5);
}

TEST(VerletSolver, StaysAtRestWhenNothingIsLifted) {
  const Wall wall(0);
  const auto motion = Solve()(wall, {});
  EXPECT_EQ(motion->status, SolveStatus::converged);
  EXPECT_LT(largestDifference(motion->outer, wall.scene->outer), 1e-12);
}

TEST(VerletSolver, ReachesTheSameEndWithEitherMass) {
  const Wall wall(10);
  Solve solve;
  const auto scaled = solve(wall, {{"tolerance", 1e-7}});
  const auto tissue = solve(wall, {{"tolerance", 1e-7}, {"mass", std::string("tissue")}, {"max_iterations", 200000.0}});
  EXPECT_LT(largestDifference(scaled->outer, tissue->outer), 1e-3);
}

TEST(VerletSolver, AbsoluteStiffnessCancels) {
  // The task is driven by displacements: scaling every modulus leaves the shape.
  const Wall soft(10, 1), stiff(10, 1000);
  Solve solve;
  EXPECT_LT(largestDifference(solve(soft, {{"tolerance", 1e-8}})->outer, solve(stiff, {{"tolerance", 1e-8}})->outer), 1e-4);
}

TEST(VerletSolver, KeepsTheMirrorSymmetryOfItsScene) {
  const Wall wall(10);
  // The anchors at +x are mirrored too, for this test.
  auto& anchors = wall.scene->anchors;
  const std::size_t count = anchors.size();
  for (std::size_t i = 0; i < count; ++i)
    if (Anchor a = anchors[i]; a.rest.x > wall.scene->inner[a.point].x + 1) a.rest.x -= 14, anchors.push_back(a);
  const auto motion = Solve()(wall, {{"tolerance", 1e-8}});
  for (int r = 0; r < 17; ++r)
    for (int c = 0; c < 17; ++c) {
      const Vec3 p = motion->outer[r * 17 + c], q = motion->outer[r * 17 + 16 - c];
      EXPECT_LT(distance(p, {128 - q.x, q.y, q.z}), 1e-4);
    }
}

TEST(VerletSolver, RefusesAStepBeyondItsLimitAndTellsTheLimit) {
  const Wall wall(10);
  Solve solve;
  const Error error = errorOf([&] { solve(wall, {{"time_step", 1.0}}); });
  EXPECT_TRUE(contains(error.what(), "stability limit")) << error.what();
  EXPECT_TRUE(contains(error.what(), "up to")) << error.what();
  EXPECT_EQ(error.kind(), ErrorKind::badInput);
}

TEST(VerletSolver, DoesNotPassOnWhatDidNotConverge) {
  const Wall wall(10);
  Solve solve;
  const Error error = errorOf([&] { solve(wall, {{"max_iterations", 120.0}}); });
  EXPECT_EQ(error.kind(), ErrorKind::runFailed);
  const auto motion = solve(wall, {{"max_iterations", 120.0}, {"accept_unconverged", true}});
  EXPECT_EQ(motion->status, SolveStatus::stalled);
  EXPECT_FALSE(motion->message.empty());
  for (const Vec3& p : motion->outer) EXPECT_TRUE(isFinite(p));
}

TEST(VerletSolver, GivesTheSameBitsForAnyNumberOfThreads) {
  const Wall wall(10);
  const int before = threads();
  std::vector<Vec3> first;
  for (int count : {1, 2, 8}) {
    setThreads(count);
    const auto motion = Solve()(wall, {});
    if (first.empty()) first = motion->outer;
    EXPECT_EQ(motion->outer, first) << count;
  }
  setThreads(before);
}

TEST(VerletSolver, StartsWhereAnEarlierMotionEnded) {
  const Wall wall(10);
  Solve solve;
  const auto cold = solve(wall, {{"tolerance", 1e-6}});
  const auto record = std::make_shared<Record>();
  const auto warm = std::dynamic_pointer_cast<const Motion>(
      solve.runner.run("solver.verlet", {{"tolerance", 1e-6}, {"ramp", 0.0}}, {{{wall.scene, record}}, {{wall.plan, record}}, {{cold, record}}})[0].value);
  EXPECT_LT(warm->iterations, cold->iterations);
  EXPECT_LT(largestDifference(warm->outer, cold->outer), 1e-2);
}

TEST(VerletSolver, StopsWhenCancelled) {
  const Wall wall(10);
  Solve solve;
  solve.cancel = true;
  EXPECT_THROW(solve(wall, {}), Cancelled);
}
