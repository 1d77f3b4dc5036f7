// What effects change, and which of them an accuracy calls for.
#include "kernel/host/probe.h"

#include "tests/kernel/host/quiet_host.h"
#include "tests/plugins/solver/wall.h"

using namespace pectora;

namespace {

const EffectUse& use(const Probe& probe, const std::string& id) {
  return *std::find_if(probe.effects.begin(), probe.effects.end(), [&](const EffectUse& u) { return u.id == id; });
}

}  // namespace

TEST(Probe, TellsWhatEachEffectChangesAndWhatCannotBeLeftOut) {
  Registry registry({PECTORA_PLUGINS});
  QuietHost host;
  const Wall wall(20);
  const Probe probe = probeEffects(*wall.scene, *wall.plan, registry, host);
  // The same, by solving without shear outright.
  Wall without(20);
  without.scene->effects.erase(without.scene->effects.begin() + 1);
  const auto all = Solve("solver.newton")(wall, {{"tolerance", 1e-6}}), part = Solve("solver.newton")(without, {{"tolerance", 1e-6}});
  EXPECT_NEAR(use(probe, "effect.shear").changeMax, largestDifference(all->outer, part->outer), 0.1 * largestDifference(all->outer, part->outer) + 0.01);
  EXPECT_FALSE(use(probe, "effect.attachment").notProbed.empty());
  EXPECT_LT(probe.uncertainty, 0.5);
}

TEST(Probe, LeavesOutWhatTogetherChangesLessThanIsWanted) {
  Registry registry({PECTORA_PLUGINS});
  QuietHost host;
  Wall wall(20);
  const auto all = Solve("solver.newton")(wall, {{"tolerance", 1e-6}});
  std::size_t before = 0;
  for (const double accuracy : {1e-9, 0.1, 0.5, 5.0}) {
    wall.scene->effectAccuracy = accuracy;
    const Choice choice = chooseEffects(*wall.scene, *wall.plan, registry, host);
    EXPECT_LT(choice.change, accuracy);
    const std::size_t left = wall.scene->effects.size() - choice.scene->effects.size();
    EXPECT_GE(left, before);
    before = left;
    for (const EffectUse& u : choice.probe.effects) EXPECT_EQ(u.isActive, u.reason.empty()) << u.id;
    EXPECT_TRUE(use(choice.probe, "effect.attachment").isActive);
  }
  EXPECT_GE(before, 1u);
  // What runs in the end is what was chosen.
  wall.scene->effectAccuracy = 0.5;
  const auto chosen = Solve("solver.newton")(wall, {{"tolerance", 1e-6}});
  EXPECT_LT(chosen->scene->effects.size(), wall.scene->effects.size());
}

TEST(Probe, DropsCandidatesThatCannotBeBuiltHere) {
  Registry registry({PECTORA_PLUGINS});
  QuietHost host;
  Wall wall(10);
  // A wall with a cell inside out can have springs, but no volume to keep.
  std::swap(wall.scene->outer[0], wall.scene->inner[0]);
  wall.scene->effects.push_back(call("effect.volume", {{"poissons_ratio", 0.45}}));
  wall.scene->effectAccuracy = 0.5;
  const Choice choice = chooseEffects(*wall.scene, *wall.plan, registry, host);
  EXPECT_FALSE(use(choice.probe, "effect.volume").isActive);
  EXPECT_TRUE(contains(use(choice.probe, "effect.volume").reason, "no positive volume"));
}
