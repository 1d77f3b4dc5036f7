// Bodies that are in the pleura's way.
#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

// How deep the worst pleura point lies within `radius` of one of its bodies, along the direction that it had at rest.
double deepest(const Wall& wall, const Motion& motion, double radius) {
  double worst = 0;
  for (std::size_t j = 0; j < wall.scene->anchors.size(); ++j) {
    const Anchor& a = wall.scene->anchors[j];
    const Vec3 away = normalized(wall.scene->inner[a.point] - a.rest);
    worst = std::max(worst, radius - dot(motion.inner[a.point] - motion.anchors[j], away));
  }
  return worst;
}

}  // namespace

TEST(RibContact, KeepsThePleuraOffTheBodiesThatPushIt) {
  // Attachments so weak that the bodies would go through the pleura.
  const double radius = 5;
  Wall free(25);
  free.scene->effects.back() = call("effect.attachment", {{"stiffness", 0.01}});
  Wall held(25);
  held.scene->effects.back() = free.scene->effects.back();
  held.scene->effects.push_back(call("effect.rib_contact", {{"radius", radius}, {"stiffness", 50.0}}));
  const auto without = Solve("solver.newton")(free, {}), with = Solve("solver.newton")(held, {});
  EXPECT_GT(deepest(free, *without, radius), 0.5);
  // Pushed back with 50 N/mm, by springs of some 0.3 N/mm that are up to 25 mm too long: a depth of up to 0.15 mm.
  EXPECT_LT(deepest(held, *with, radius), 0.15);
}

TEST(RibContact, HoldsNothingInPlace) {
  Registry registry({PECTORA_PLUGINS});
  Wall wall(10);
  wall.scene->effects = {call("effect.direct"), call("effect.stretch"), call("effect.cross"), call("effect.rib_contact")};
  EXPECT_TRUE(contains(errorOf([&] { compile(*wall.scene, registry); }).what(), "on nothing that holds them"));
}

TEST(RibContact, DropsOutWhereNoBodyIsNear) {
  Registry registry({PECTORA_PLUGINS});
  Wall wall(10);
  for (Anchor& anchor : wall.scene->anchors) anchor.body = BodyKind::still;
  wall.scene->effects.push_back(call("effect.rib_contact"));
  EXPECT_FALSE(compile(*wall.scene, registry).effects.back().isActive);
}
