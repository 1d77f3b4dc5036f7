#include "tests/app/view/walk.h"

#include "tests/app/helpers.h"

#include <cmath>

namespace pectora::view {
namespace {

double largestDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) largest = std::max(largest, distance(a[i], b[i]));
  return largest;
}

// How far a place lies from the nearest point of a mesh or cloud, mm.
double distanceFrom(const std::vector<Vec3>& points, Vec3 place) {
  double least = INFINITY;
  for (const Vec3& p : points) least = std::min(least, distance(p, place));
  return least;
}

}  // namespace

std::string ownHome(const std::string& name) {
  const std::string home = freshFolder(name).string();
  setenv("XDG_STATE_HOME", home.c_str(), 1);
  setenv("XDG_CONFIG_HOME", home.c_str(), 1);
  return home;
}

double meanDifference(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b, int width, ImVec4 part) {
  double sum = 0;
  for (int y = int(part.y); y < int(part.y + part.w); ++y)
    for (int x = int(part.x); x < int(part.x + part.z); ++x)
      for (int c = 0; c < 3; ++c) {
        const std::size_t i = (std::size_t(y) * width + x) * 4 + c;
        sum += std::abs(double(a[i]) - double(b[i]));
      }
  return sum / (3 * std::floor(part.z) * std::floor(part.w));
}

std::array<double, 3> meanColor(const std::vector<unsigned char>& rgba, int width, ImVec4 part) {
  std::array<double, 3> mean{};
  for (int y = int(part.y); y < int(part.y + part.w); ++y)
    for (int x = int(part.x); x < int(part.x + part.z); ++x)
      for (int c = 0; c < 3; ++c) mean[c] += rgba[(std::size_t(y) * width + x) * 4 + c] / (std::floor(part.z) * std::floor(part.w));
  return mean;
}

Walk walkThrough(App& app, Hand& hand, const Target& target, const std::string& folder) {
  Walk walk;
  std::tie(walk.width, walk.height) = target.size();
  Context& context = app.context();
  const auto rested = [&] { EXPECT_TRUE(hand.rest(500)) << context.activity.stage << " " << context.activity.what; };
  const auto skin = [&] { return context.results->motionValue() ? context.results->motionValue()->outer : std::vector<Vec3>{}; };
  rested();
  walk.empty = target.pixels();

  // A phantom; coarse, so that the walk is short.
  context.choices.loader = {"loader.phantom", {{"matrix", 128.0}, {"slice_spacing", 5.0}}};
  assign(context.choices.model.settings, "spacing", 14.0);
  hand.click("opening.phantom");
  rested();
  EXPECT_TRUE(context.results->motionValue()) << context.results->error;
  if (!context.results->motionValue()) return walk;
  walk.opened = target.pixels();
  walk.scene = {hand.place("scene", 0, 0).x, hand.place("scene", 0, 0).y, 0, 0};
  walk.scene.z = hand.place("scene", 1, 1).x - walk.scene.x, walk.scene.w = hand.place("scene", 1, 1).y - walk.scene.y;

  // The bar, taken in the scene and drawn back and up.
  hand.click("tab.bar");
  rested();
  const auto first = skin();
  const Plan* plan = context.results->planValue();
  const Vec3 middle = plan->bars[0].centerline[plan->bars[0].centerline.size() / 2], at = app.camera().project(middle);
  const double liftBefore = plan->lift();
  hand.drag("scene", {float(at.x), float(at.y)}, {float(at.x) + 0.03f, float(at.y) - 0.02f});
  EXPECT_TRUE(context.results->isLive || context.activity.isBusy) << "the skin follows at once";
  rested();
  plan = context.results->planValue();
  walk.lift = plan->lift(), walk.level = std::get<double>(*find(context.choices.planner.settings, "level"));
  EXPECT_LT(walk.lift, liftBefore) << "away from the eye is back";
  EXPECT_GT(walk.level, 0) << "up is up";
  EXPECT_FALSE(context.results->isLive) << "what has settled is the script's";
  EXPECT_GT(largestDistance(first, skin()), 1);
  walk.lifted = target.pixels();
  hand.control('z');
  rested();
  EXPECT_TRUE(context.results->planValue()) << "one step back, and no more";
  if (!context.results->planValue()) return walk;
  EXPECT_EQ(context.results->planValue()->lift(), liftBefore);
  EXPECT_EQ(largestDistance(skin(), first), 0) << "settled skins do not depend on what came before";

  // A stiffness by its slider; undo, redo and undo.
  hand.click("tab.tissue");
  rested();
  hand.click("effect.cross.open");
  rested();
  hand.drag("effect.cross.youngs_modulus", {0.5f, 0.5f}, {0.95f, 0.5f});
  rested();
  const auto stiff = skin();
  EXPECT_GT(largestDistance(first, stiff), 0.01);
  hand.click("undo");
  rested();
  EXPECT_EQ(largestDistance(skin(), first), 0);
  hand.click("redo");
  rested();
  EXPECT_EQ(largestDistance(skin(), stiff), 0);
  hand.control('z');
  rested();

  // An effect less, and again.
  const std::size_t effects = context.results->effects.size();
  hand.click("effect.bend");
  rested();
  EXPECT_EQ(context.results->effects.size(), effects - 1);
  EXPECT_GT(largestDistance(first, skin()), 0.001);
  hand.click("effect.bend");
  rested();
  EXPECT_EQ(largestDistance(skin(), first), 0);

  // A landmark on each surface: the click lies on it, and the other three are the phantom's own.
  hand.click("tab.compare");
  rested();
  walk.sawDistances = target.pixels();
  hand.click("landmarks.place");
  rested();
  hand.click("landmark.navel");
  for (const char* side : {"landmarks.ct", "landmarks.scan"}) {
    hand.click(side, 0.5f, 0.55f);
    rested();
  }
  EXPECT_EQ(context.choices.ctLandmarks.points.size(), 4u);
  EXPECT_EQ(context.choices.scanLandmarks.points.size(), 4u);
  const auto* onCt = context.choices.ctLandmarks.find("navel");
  const auto* onScan = context.choices.scanLandmarks.find("navel");
  const auto* cloud = Results::as<Points>(context.results->scan);
  const auto* mesh = Results::as<Mesh>(context.results->scan);
  EXPECT_TRUE(onCt && onScan && (cloud || mesh));
  if (onCt && onScan && (cloud || mesh)) {
    // Half a spacing of the skin that was found (voxels 5 mm apart at the most), and of the scan's points.
    std::vector<Vec3> found;
    for (const LayerSlice& slice : context.results->anatomyValue()->skin) found.insert(found.end(), slice.points.begin(), slice.points.end());
    EXPECT_LT(distanceFrom(found, onCt->position), 5);
    EXPECT_LT(distanceFrom(cloud ? cloud->points : mesh->points, onScan->position), 5);
  }
  const auto* registration = Results::as<Registration>(context.results->byLandmarks);
  EXPECT_TRUE(registration && registration->residuals.size() == 4);
  for (int i = 0; i < 2; ++i) hand.click("undo"), rested();
  EXPECT_TRUE(context.choices.ctLandmarks.points.empty()) << "clicks are taken back one by one";
  hand.click("landmarks.place");
  rested();

  // The screenshot of the script's tab.
  hand.click("tab.script");
  rested();
  hand.click("export.folder");
  hand.control('a');
  hand.type(folder, true);
  hand.click("screenshot");
  rested();
  EXPECT_TRUE(std::filesystem::exists(folder + "/screenshot.png"));
  EXPECT_EQ(context.results->error, "");
  EXPECT_EQ(openGlErrors(), 0);
  return walk;
}

}  // namespace pectora::view
