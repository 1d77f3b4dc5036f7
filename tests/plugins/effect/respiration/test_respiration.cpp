// Ribs that turn as the patient breathes.
#include "plugins/effect/respiration/breathing.h"

#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

// Ribs 2 to 7 of both sides as arcs that fall towards the front, with cartilages to the middle.
RibCage breathingCage() {
  RibCage cage;
  for (int number = 2; number <= 7; ++number)
    for (const Side side : {Side::right, Side::left}) {
      const double s = side == Side::left ? 1 : -1, z = -20.0 * number;
      RibCurve rib;
      rib.side = side;
      rib.number = number;
      rib.curve.controls = {{18 * s, 30, z}, {130 * s, 20, z - 20}, {130 * s, -80, z - 60}, {50 * s, -110, z - 80}};
      rib.curve.knots = clampedKnots(4, 3);
      cage.ribs.push_back(rib);
      Cartilage cartilage;
      cartilage.side = side;
      cartilage.rib = number;
      cartilage.curve.controls = {{50 * s, -110, z - 80}, {40 * s, -112, z - 78}, {28 * s, -113, z - 72}, {18 * s, -113, z - 70}};
      cartilage.curve.knots = clampedKnots(4, 3);
      cage.cartilages.push_back(cartilage);
    }
  return cage;
}

Anchor on(BodyKind body, int index, double u, Vec3 rest) { return {0, body, index, u, rest, false}; }

}  // namespace

TEST(Respiration, TurnsEachRibAboutItsHeadAndKeepsItsLengths) {
  const RibCage cage = breathingCage();
  const Breathing out(cage, 1);
  for (int i = 0; i < int(cage.ribs.size()); ++i) {
    const Curve& curve = cage.ribs[i].curve;
    const auto after = [&](double u) { return curve.at(u) + out.displacement(on(BodyKind::rib, i, u, curve.at(u))); };
    EXPECT_LT(distance(after(0), curve.at(0)), 1e-9);
    for (const double u : {0.3, 0.6, 1.0}) EXPECT_NEAR(distance(after(u), after(0.1)), distance(curve.at(u), curve.at(0.1)), 1e-9);
  }
}

TEST(Respiration, BreathingOutTakesTheFrontDownAndBackAndTheSidesDown) {
  const RibCage cage = breathingCage();
  const Breathing out(cage, 1);
  EXPECT_GT(out.sternum().y, 5);
  EXPECT_LT(out.sternum().z, -5);
  EXPECT_NEAR(out.sternum().x, 0, 1e-12);
  for (int i = 0; i < int(cage.ribs.size()); ++i) {
    const Curve& curve = cage.ribs[i].curve;
    EXPECT_LT(out.displacement(on(BodyKind::rib, i, 0.5, curve.at(0.5))).z, 0);
  }
  EXPECT_LT(Breathing(cage, -1).sternum().y, -4);
}

TEST(Respiration, LeavesNoStepWhereACartilageBeginsAndEnds) {
  const RibCage cage = breathingCage();
  const Breathing out(cage, 1);
  for (int i = 0; i < int(cage.cartilages.size()); ++i) {
    const Vec3 junction = cage.ribs[i].curve.at(1);
    EXPECT_LT(norm(out.displacement(on(BodyKind::cartilage, i, 0, junction)) - out.displacement(on(BodyKind::rib, i, 1, junction))), 1e-9);
    EXPECT_LT(norm(out.displacement(on(BodyKind::cartilage, i, 1, {})) - out.sternum()), 1e-9);
  }
}

TEST(Respiration, MovesTheWallAndDropsOutInTheSamePhase) {
  Registry registry({PECTORA_PLUGINS});
  Wall wall(0);
  wall.scene->cage = std::make_shared<RibCage>(breathingCage());
  for (Anchor& anchor : wall.scene->anchors) anchor.body = BodyKind::sternum;
  wall.scene->effects.push_back(call("effect.respiration", {{"exhaled", 1.0}}));
  const auto motion = Solve("solver.newton")(wall, {});
  // The whole wall hangs on the sternum, and goes with it.
  const Vec3 way = Breathing(*wall.scene->cage, 1).sternum();
  EXPECT_LT(norm(motion->outer[40] - wall.scene->outer[40] - way), 1e-3);
  wall.scene->effects.back() = call("effect.respiration", {{"exhaled", 0.0}});
  EXPECT_FALSE(compile(*wall.scene, registry).effects.back().isActive);
}
