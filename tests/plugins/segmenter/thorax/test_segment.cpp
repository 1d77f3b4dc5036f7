// The whole way, against the phantom's truth and against bad input.
#include "phantom.h"
#include "noting_host.h"
#include "solids.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"
#include "plugins/segmenter/thorax/segment.h"

#include <gtest/gtest.h>

using namespace pectora;

namespace {

/// One phantom for all tests of this file: coarse, so that it is drawn in seconds.
struct Case {
  std::shared_ptr<const Volume> ct;
  std::shared_ptr<const Truth> truth;
};
const Case& phantomCase() {
  static const Case made = [] {
    phantom::Settings settings;
    settings.matrix = 320;
    settings.sliceSpacing = 3;
    settings.coverage = "thorax";
    const phantom::Patient patient = phantom::makePatient(settings);
    const phantom::Images images = phantom::rasterise(patient, settings, [](double) {});
    return Case{images.ct, phantom::makeTruth(patient, images.labels)};
  }();
  return made;
}
std::shared_ptr<const Anatomy> segmented() {
  static const auto made = [] {
    NotingHost host;
    return thorax::segment(phantomCase().ct, {}, host);
  }();
  return made;
}

/// Distance from a point to a polyline, and where along it (in vertices).
double distanceTo(const std::vector<Vec3>& line, Vec3 p, double& where) {
  double nearest = 1e300;
  for (std::size_t n = 0; n + 1 < line.size(); ++n) {
    const Vec3 d = line[n + 1] - line[n];
    const double t = std::clamp(dot(p - line[n], d) / std::max(1e-12, dot(d, d)), 0.0, 1.0);
    if (distance(line[n] + d * t, p) < nearest) nearest = distance(line[n] + d * t, p), where = double(n) + t;
  }
  return nearest;
}
bool isInner(const std::vector<Vec3>& line, double where) { return where > 0.01 && where < double(line.size()) - 1.01; }

/// Mean absolute distance of a layer's points from the truth at the same level, for levels between two heights.
double layerError(const std::vector<LayerSlice>& found, const std::vector<LayerSlice>& truth, double low, double high) {
  double sum = 0;
  std::size_t count = 0;
  for (const LayerSlice& f : found)
    for (const LayerSlice& t : truth) {
      if (std::abs(f.z - t.z) > 0.01 || f.z < low || f.z > high || f.clipped) continue;
      for (const Vec3& p : f.points) {
        double where = 0;
        const double d = distanceTo(t.points, p, where);
        if (isInner(t.points, where)) sum += d, ++count;
      }
    }
  return count ? sum / double(count) : 1e300;
}

TEST(Segment, FindsAndNumbersAllTwelvePairsOfRibs) {
  for (Side side : {Side::right, Side::left})
    for (int n = 1; n <= 12; ++n) {
      const Rib* truth = phantomCase().truth->anatomy->rib(side, n);
      if (!truth) continue;
      const Rib* rib = segmented()->rib(side, n);
      ASSERT_NE(rib, nullptr) << sideName(side) << n;
      double sum = 0;
      int count = 0;
      for (const Vec3& p : rib->centerline) {
        double where = 0;
        const double d = distanceTo(truth->centerline, p, where);
        if (isInner(truth->centerline, where)) sum += d * d, ++count;
      }
      ASSERT_GT(count, 10);
      // Ribs 9 and 10 of the phantom touch in front.
      EXPECT_LT(std::sqrt(sum / count), n == 9 || n == 10 ? 4.0 : 1.5) << sideName(side) << n;
    }
  EXPECT_EQ(segmented()->ribs.size(), phantomCase().truth->anatomy->ribs.size());
}

TEST(Segment, FindsTheSkinToATenthOfAMillimetre) {
  EXPECT_LT(layerError(segmented()->skin, phantomCase().truth->anatomy->skin, -1e9, 1e9), 0.1);
}

TEST(Segment, FindsThePleuraToAMillimetreWhereThereIsAChest) {
  const Sternum& sternum = phantomCase().truth->anatomy->sternum;
  const double low = sternum.xiphisternalJoint.z - 40, high = sternum.jugularNotch.z - 5;
  EXPECT_LT(layerError(segmented()->pleura, phantomCase().truth->anatomy->pleura, low, high), 1.0);
}

TEST(Segment, MeasuresTheHallerIndexToThreeHundredths) {
  const LevelMetrics* truth = phantomCase().truth->anatomy->deepestLevel();
  ASSERT_NE(truth, nullptr);
  double found = 0;
  for (const LevelMetrics& m : segmented()->metrics)
    if (std::abs(m.z - truth->z) < 0.6 * phantomCase().ct->grid.spacing.z) found = m.haller();
  EXPECT_NEAR(found, phantomCase().truth->hallerIndex, 0.04);
}

TEST(Segment, FindsTheSternumsEndsAndJoints) {
  const Sternum &found = segmented()->sternum, &truth = phantomCase().truth->anatomy->sternum;
  EXPECT_NEAR(found.jugularNotch.z, truth.jugularNotch.z, 5);
  EXPECT_NEAR(found.manubriosternalJoint.z, truth.manubriosternalJoint.z, 8);
  EXPECT_NEAR(found.xiphisternalJoint.z, truth.xiphisternalJoint.z, 8);
  EXPECT_NEAR(found.torsionDeg, truth.torsionDeg, 3);
}

TEST(Segment, GivesLayersOfTheSameLevelsCaudalFirstFromRightToLeft) {
  const Anatomy& a = *segmented();
  ASSERT_EQ(a.skin.size(), a.pleura.size());
  ASSERT_GT(a.skin.size(), 50u);
  for (std::size_t n = 0; n < a.skin.size(); ++n) {
    EXPECT_EQ(a.skin[n].z, a.pleura[n].z);
    if (n > 0) {
      EXPECT_NEAR(a.skin[n].z - a.skin[n - 1].z, 3, 1e-6);
    }
    EXPECT_LT(a.skin[n].points.front().x, a.skin[n].points.back().x);
    EXPECT_LT(a.pleura[n].points.front().x, a.pleura[n].points.back().x);
  }
}

TEST(Segment, KeepsThePleuraInsideTheSkin) {
  const Anatomy& a = *segmented();
  for (std::size_t n = 0; n < a.skin.size(); ++n)
    for (const Vec3& p : a.pleura[n].points) {
      double where = 0;
      EXPECT_GT(distanceTo(a.skin[n].points, p, where), 3.5);
    }
}

TEST(Segment, GivesTheSameBitsForAnyNumberOfThreads) {
  const int before = threads();
  setThreads(1);
  NotingHost host;
  const auto one = thorax::segment(phantomCase().ct, {}, host);
  setThreads(before);
  const auto many = segmented();
  ASSERT_EQ(one->ribs.size(), many->ribs.size());
  for (std::size_t r = 0; r < one->ribs.size(); ++r) EXPECT_TRUE(one->ribs[r].centerline == many->ribs[r].centerline);
  ASSERT_EQ(one->pleura.size(), many->pleura.size());
  for (std::size_t n = 0; n < one->pleura.size(); ++n) {
    EXPECT_TRUE(one->pleura[n].points == many->pleura[n].points);
    EXPECT_TRUE(one->skin[n].points == many->skin[n].points);
  }
  EXPECT_TRUE(one->sternum.axis == many->sternum.axis);
}

TEST(Segment, DoesNotDependOnHowTheVoxelsAreStored) {
  // The same patient with rows from left to right, columns from back to front: a turn by 180 degrees about z.
  const Volume& ct = *phantomCase().ct;
  auto turned = std::make_shared<Volume>();
  turned->grid = ct.grid;
  turned->grid.axes = {{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}};
  turned->grid.origin = ct.grid.toPatient({ct.grid.size[0] - 1.0, ct.grid.size[1] - 1.0, 0});
  for (int k = 0; k < ct.grid.size[2]; ++k)
    for (int j = ct.grid.size[1] - 1; j >= 0; --j)
      for (int i = ct.grid.size[0] - 1; i >= 0; --i) turned->hu.push_back(ct.at(i, j, k));
  NotingHost host;
  const auto found = thorax::segment(turned, {}, host);
  ASSERT_EQ(found->ribs.size(), segmented()->ribs.size());
  for (std::size_t r = 0; r < found->ribs.size(); ++r)
    EXPECT_LT(distance(found->ribs[r].centerline.back(), segmented()->ribs[r].centerline.back()), 1e-6);
}

TEST(Segment, WarnsIfTheFirstRibIsNotInView) {
  // The lower 60 per cent of the CT.
  const Volume& ct = *phantomCase().ct;
  auto part = std::make_shared<Volume>();
  part->grid = ct.grid;
  part->grid.size[2] = ct.grid.size[2] * 6 / 10;
  part->hu.assign(ct.hu.begin(), ct.hu.begin() + std::ptrdiff_t(part->grid.voxels()));
  NotingHost host;
  const auto found = thorax::segment(part, {}, host);
  EXPECT_TRUE(host.warned("rib"));
  for (const Rib& rib : found->ribs) {
    if (rib.number == 0) continue;
    const Rib* truth = phantomCase().truth->anatomy->rib(rib.side, rib.number);
    ASSERT_NE(truth, nullptr);
    double where = 0;
    EXPECT_LT(distanceTo(truth->centerline, rib.centerline[rib.centerline.size() / 2], where), 3) << rib.number;
  }
}

TEST(Segment, RefusesCtsThatHoldNoChestWithOneClearError) {
  NotingHost host;
  const auto refused = [&](std::shared_ptr<Volume> ct) {
    EXPECT_THROW(thorax::segment(ct, {}, host), Error);
  };
  refused(std::make_shared<Volume>());
  refused(solids::air({64, 64, 40}, {3, 3, 3}));
  refused(solids::air({64, 64, 1}, {3, 3, 3}));
  refused(solids::air({4, 4, 40}, {3, 3, 3}));
  auto bone = solids::air({64, 64, 40}, {3, 3, 3});
  std::fill(bone->hu.begin(), bone->hu.end(), std::int16_t(900));
  refused(bone);
  auto water = solids::air({64, 64, 40}, {3, 3, 3});
  solids::fill(*water, 0, solids::cylinder(96, 96, 60, 60));
  refused(water);  // a body, but no spine
  auto shortOfVoxels = solids::air({64, 64, 40}, {3, 3, 3});
  shortOfVoxels->hu.resize(100);
  refused(shortOfVoxels);
}

TEST(Segment, StopsWhenTheUserCancels) {
  NotingHost host;
  host.isCancelled = true;
  EXPECT_THROW(thorax::segment(phantomCase().ct, {}, host), Cancelled);
}

}  // namespace
