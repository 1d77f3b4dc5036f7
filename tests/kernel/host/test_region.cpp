// What the operation does not move is left out, and let back in where it moves after all.
#include "kernel/host/region.h"
#include "kernel/host/warm.h"

#include "tests/kernel/host/quiet_host.h"
#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

struct Listening : QuietHost {
  std::vector<std::string> infos;
  void info(const std::string& message) override { infos.push_back(message); }
};

struct Desk {
  Registry registry{{PECTORA_PLUGINS}};
  Listening host;

  std::unique_ptr<WarmSolve> warm(std::shared_ptr<Scene> scene, double still, const std::string& id = "solver.newton") {
    scene->still = still;
    auto solver = registry.open(id).descriptor->makeSolver();
    applySettings({{"tolerance", 1e-6}}, [&](Visitor& v) { solver->describe(v); });
    return std::make_unique<WarmSolve>(std::move(scene), id, std::move(solver), registry, host);
  }
  std::shared_ptr<const Motion> solve(const Wall& wall, double still) { return warm(wall.scene, still)->solve(*wall.plan, host); }
  // "225 of 1681 points are computed; ..."
  int computed() const { return host.infos.empty() ? 0 : std::stoi(host.infos.back()); }
};

constexpr int kPoints = 41;

}  // namespace

TEST(Region, ComputesOnlyWhatMovesToTheToleranceThatIsWanted) {
  Desk desk;
  const auto whole = desk.solve(Wall(10, 1, kPoints), 0);
  int before = 7 * 7;   // about so many hang on what moves
  for (const double still : {1.0, 0.3, 0.1, 0.01}) {
    const auto part = desk.solve(Wall(10, 1, kPoints), still);
    EXPECT_EQ(part->status, SolveStatus::converged);
    EXPECT_EQ(part->outer.size(), whole->outer.size());
    // What is left out would have moved by less, and the free edge errs by about as much again.
    EXPECT_LT(largestDifference(part->outer, whole->outer), 2 * still);
    EXPECT_LT(largestDifference(part->inner, whole->inner), 2 * still);
    EXPECT_GT(desk.computed(), before) << still;
    before = desk.computed();
  }
  EXPECT_EQ(before, kPoints * kPoints);   // a hundredth of a millimetre is felt everywhere
}

TEST(Region, LetsBackInWhatMovesAfterAll) {
  // A stiff skin on a soft wall carries the movement beyond the anchors that move and one thickness around them.
  Desk desk;
  const auto stiff = [] {
    Wall wall(10, 1, kPoints);
    wall.scene->effects = {call("effect.stretch", {{"youngs_modulus", 2000.0}}), call("effect.shear", {{"youngs_modulus", 2000.0}}), call("effect.bend", {{"youngs_modulus", 2000.0}}),
                           call("effect.direct", {{"youngs_modulus", 5.0}}), call("effect.cross", {{"youngs_modulus", 5.0}}), call("effect.attachment", {{"youngs_modulus", 60.0}})};
    return wall;
  };
  const auto whole = desk.solve(stiff(), 0), part = desk.solve(stiff(), 0.3);
  EXPECT_LT(largestDifference(part->outer, whole->outer), 0.6);
  EXPECT_GT(desk.computed(), 13 * 13);
}

TEST(Region, FollowsThePlanFromWhereItWas) {
  Desk desk;
  Wall wall(2, 1, kPoints);
  const auto warm = desk.warm(wall.scene, 0.1);
  warm->solve(*wall.plan, desk.host);
  const auto further = warm->solve(*Wall(12, 1, kPoints).plan, desk.host);
  EXPECT_LT(largestDifference(further->outer, desk.solve(Wall(12, 1, kPoints), 0)->outer), 0.2);
}

TEST(Region, HoldsNothingWhereNothingMoves) {
  Desk desk;
  const Wall wall(0, 1, kPoints);
  const auto motion = desk.solve(wall, 0.1);
  EXPECT_EQ(motion->status, SolveStatus::converged);
  EXPECT_EQ(motion->forceEvaluations, 0);
  EXPECT_EQ(largestDifference(motion->outer, wall.scene->outer), 0);
}

TEST(Region, KeepsTheCellsOfASolidWall) {
  Scene scene;
  scene.rows = 4, scene.columns = 5;
  scene.between = {{}};
  for (auto* layer : {&scene.outer, &scene.inner, &scene.between[0]})
    for (int i = 0; i < 20; ++i) layer->push_back({double(i), 0, 0});
  scene.outerMass = scene.innerMass = std::vector<double>(20, 1);
  scene.betweenMass = {scene.outerMass};
  for (int i = 0; i < scene.cells(); ++i) scene.cellTissue.push_back(std::uint8_t(i));
  scene.anchors = {{.point = 7, .rest = {}}, {.point = 0, .rest = {}}, {.point = 13, .rest = {}}};
  std::vector<std::size_t> anchors;
  const auto part = crop(scene, {1, 4, 2, 4}, anchors);
  EXPECT_EQ(part->outer, (std::vector<Vec3>{{7, 0, 0}, {8, 0, 0}, {12, 0, 0}, {13, 0, 0}, {17, 0, 0}, {18, 0, 0}}));
  // Cells (1, 2) and (2, 2) of 3 x 4 in either layer.
  EXPECT_EQ(part->cellTissue, (std::vector<std::uint8_t>{6, 10, 18, 22}));
  EXPECT_EQ(anchors, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(part->anchors[0].point, 0);
  EXPECT_EQ(part->anchors[1].point, 3);
}
