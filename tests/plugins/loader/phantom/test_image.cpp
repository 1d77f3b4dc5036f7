// The phantom's CT: determinism, noise, partial volume, and agreement of voxels and truth.
#include "plugins/loader/phantom/noise.h"
#include "plugins/loader/phantom/phantom.h"
#include "plugins/loader/phantom/tissue.h"
#include "kernel/physics/workers.h"

#include <gtest/gtest.h>

#include <map>

using namespace pectora;
using namespace pectora::phantom;

namespace {

Settings coarse() {
  Settings settings;
  settings.matrix = 128;
  settings.sliceSpacing = 5;
  return settings;
}

Images draw(const Settings& settings) { return rasterise(makePatient(settings), settings, [](double) {}); }

double deviation(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (double v : values) sum += v, squares += v * v;
  const double mean = sum / double(values.size());
  return std::sqrt(squares / double(values.size()) - mean * mean);
}

TEST(PhantomImage, isTheSameForAnyNumberOfThreads) {
  const int before = threads();
  setThreads(1);
  const Images one = draw(coarse());
  setThreads(2);
  const Images two = draw(coarse());
  setThreads(before);
  EXPECT_EQ(one.ct->hu, two.ct->hu);
  EXPECT_EQ(one.labels->label, two.labels->label);
}

TEST(PhantomImage, hasOtherNoiseForAnotherSeedAndTheSameAnatomy) {
  Settings settings = coarse();
  const Images first = draw(settings);
  settings.seed = 2;
  const Images second = draw(settings);
  EXPECT_NE(first.ct->hu, second.ct->hu);
  std::size_t different = 0;
  for (std::size_t i = 0; i < first.labels->label.size(); ++i) {
    const auto isLung = [](std::uint8_t label) { return label == kLung || label == kVessel; };  // vessels are random
    const std::uint8_t a = first.labels->label[i], b = second.labels->label[i];
    different += a != b && !(isLung(a) && isLung(b));
  }
  EXPECT_EQ(different, 0u);
}

TEST(PhantomImage, hasTheAskedNoiseInTheHeart) {
  Settings settings = coarse();
  settings.noise = 15;
  settings.texture = 0;
  settings.hasCouch = false;
  settings.matrix = 256;
  const Images images = draw(settings);
  const Grid& grid = images.ct->grid;
  // Not in air, where -1000 + 15 HU is clipped at -1024 in 5 % of the voxels. Well inside, away from partial volumes.
  std::vector<double> heart;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 4; j + 4 < grid.size[1]; ++j)
      for (int i = 4; i + 4 < grid.size[0]; ++i) {
        bool isInside = true;
        for (int d : {-4, 4})
          isInside &= images.labels->label[grid.index(i + d, j, k)] == kHeart &&
                      images.labels->label[grid.index(i, j + d, k)] == kHeart;
        if (isInside && images.labels->label[grid.index(i, j, k)] == kHeart) heart.push_back(images.ct->at(i, j, k));
      }
  ASSERT_GT(heart.size(), 5000u);
  // Neighbours are correlated: about 5000 / 10 free samples give the SD to 3 %.
  EXPECT_NEAR(deviation(heart), 15, 1);
}

TEST(PhantomImage, noiseOfAPairIsIndependentAndHasUnitDeviation) {
  const NoisePair pair = ctNoise(200, 0.34, 5);
  double both = 0;
  for (std::size_t i = 0; i < pair.first.size(); ++i) both += double(pair.first[i]) * pair.second[i];
  EXPECT_NEAR(deviation({pair.first.begin(), pair.first.end()}), 1, 0.03);
  EXPECT_NEAR(deviation({pair.second.begin(), pair.second.end()}), 1, 0.03);
  EXPECT_NEAR(both / double(pair.first.size()), 0, 0.03);
}

TEST(PhantomImage, surfacesCrossPixelsAsPartialVolumes) {
  Settings settings = coarse();
  settings.noise = settings.texture = 0;
  settings.matrix = 256;
  const Images images = draw(settings);
  const Patient patient = makePatient(settings);
  const Grid& grid = images.ct->grid;
  // Along a row through the flank a pixel between air and tissue has a value between, and the place where half of
  // air and half of tissue meet is the truth's skin to a quarter of a pixel.
  const int k = grid.size[2] / 2;
  const Level level = patient.before.level(patient.before.pose.levelToBody(grid.origin.z + k * grid.spacing.z));
  const Vec3 flank = patient.before.surfacePoint(patient.before.torso->skin, level, 1.57079632679);
  const int j = int(std::lround(grid.toVoxel(flank).y));
  // Where the true skin crosses this row of pixels.
  double trueX = 0;
  for (double a = 1.2; a < 1.9; a += 1e-4) {
    const Vec3 p = patient.before.surfacePoint(patient.before.torso->skin, level, a);
    if (grid.toVoxel(p).y >= j) {
      trueX = grid.toVoxel(p).x;
      break;
    }
  }
  int partial = 0;
  double found = 0;
  for (int i = int(trueX) + 6; i > int(trueX) - 6; --i) {
    const double hu = images.ct->at(i, j, k), inner = images.ct->at(i - 1, j, k);
    partial += hu > -990 && hu < -200;
    // Tissue just below the skin is skin and fat together, about -70 HU at this pixel size.
    if (hu < -535 && inner >= -535) found = i - (-535 - hu) / (inner - hu);
  }
  EXPECT_GE(partial, 1);
  EXPECT_NEAR(found, trueX, 0.25);
}

TEST(PhantomImage, labelsGiveTheTruthsHallerIndexToAVoxel) {
  Settings settings = coarse();
  settings.matrix = 512;
  settings.noise = 0;
  settings.coverage = "thorax";
  const Patient patient = makePatient(settings);
  const Images images = rasterise(patient, settings, [](double) {});
  const auto truth = makeTruth(patient, images.labels);
  const Grid& grid = images.ct->grid;
  const LevelMetrics* deepest = truth->anatomy->deepestLevel();
  ASSERT_NE(deepest, nullptr);
  const int k = int(std::lround((deepest->z - grid.origin.z) / grid.spacing.z));
  // Count voxels, with no use of the phantom's own geometry.
  int left = grid.size[0], right = 0, sternumBack = 0, vertebraFront = grid.size[1];
  for (int j = 0; j < grid.size[1]; ++j)
    for (int i = 0; i < grid.size[0]; ++i) {
      const std::uint8_t label = images.labels->label[grid.index(i, j, k)];
      if (label == kLung) left = std::min(left, i), right = std::max(right, i);
      if (label == kSternum) sternumBack = std::max(sternumBack, j);
      if (label == kVertebra || label == kDisc) vertebraFront = std::min(vertebraFront, j);
    }
  const double pixel = grid.spacing.x;
  EXPECT_NEAR((right - left + 1) * pixel, deepest->transverse, 2 * pixel);
  EXPECT_NEAR((vertebraFront - sternumBack - 1) * pixel, deepest->sternumToVertebra, 1.5 * pixel);
  EXPECT_NEAR(truth->hallerIndex, settings.haller, 0.02);
}

TEST(PhantomImage, theTruthsLinesRunThroughTheirVoxels) {
  Settings settings = coarse();
  settings.type = "asymmetric";
  settings.haller = 5;
  settings.turn = -6;
  settings.shiftX = 9;
  settings.matrix = 350;
  settings.sliceSpacing = 2.5;
  settings.noise = 0;
  const Patient patient = makePatient(settings);
  const Images images = rasterise(patient, settings, [](double) {});
  const auto truth = makeTruth(patient, images.labels);
  const Grid& grid = images.ct->grid;
  const auto labelAt = [&](Vec3 p) {
    const Vec3 v = grid.toVoxel(p);
    return int(images.labels->label[grid.index(int(std::lround(v.x)), int(std::lround(v.y)), int(std::lround(v.z)))]);
  };
  for (const Rib& rib : truth->anatomy->ribs) {
    int hits = 0;
    for (const Vec3& p : rib.centerline) hits += labelAt(p) == ribLabel(rib.side, rib.number);
    EXPECT_GE(hits, int(rib.centerline.size()) - 2) << sideName(rib.side) << rib.number;
  }
  for (const CartilageLine& cartilage : truth->cartilages) {
    // At its ends it lies under rib, sternum or the cartilage that it joins; the first two are short and end within
    // the broad manubrium.
    int hits = 0;
    for (const Vec3& p : cartilage.centerline) hits += labelAt(p) == cartilageLabel(cartilage.side, cartilage.rib);
    const double least = cartilage.rib <= 2 ? 1 : 0.6 * double(cartilage.centerline.size());
    EXPECT_GT(hits, least) << sideName(cartilage.side) << cartilage.rib;
  }
  int hits = 0;
  for (const Vec3& p : truth->anatomy->sternum.axis) hits += labelAt(p) == kSternum;
  EXPECT_GE(hits, int(truth->anatomy->sternum.axis.size()) - 2);
  // In front of the skin's line is air, behind it the body.
  int outside = 0, inside = 0, lines = 0;
  for (const LayerSlice& slice : truth->anatomy->skin)
    for (const Vec3& p : slice.points) {
      if (p.y > -80) continue;  // where the front faces forwards
      ++lines;
      outside += labelAt(p - Vec3{0, 3, 0}) == kAir;
      inside += labelAt(p + Vec3{0, 3, 0}) != kAir;
    }
  EXPECT_GT(outside, int(0.99 * lines));
  EXPECT_GT(inside, int(0.99 * lines));
}

TEST(PhantomImage, tissuesHaveTheirHounsfieldUnits) {
  Settings settings = coarse();
  settings.matrix = 256;
  const Images images = draw(settings);
  std::map<int, std::pair<double, int>> sums;
  for (std::size_t i = 0; i < images.ct->hu.size(); ++i) {
    auto& [sum, count] = sums[images.labels->label[i]];
    sum += images.ct->hu[i], ++count;
  }
  const auto mean = [&](int label) { return sums[label].first / sums[label].second; };
  // Wide enough for the partial volumes at each tissue's border.
  EXPECT_NEAR(mean(kLung), -870, 40);
  EXPECT_NEAR(mean(kHeart), 45, 15);
  EXPECT_NEAR(mean(kMuscle), 55, 25);
  EXPECT_NEAR(mean(kLiver), 60, 15);
  EXPECT_NEAR(mean(kAir), -1000, 20);
  for (Side side : {Side::right, Side::left})
    for (int number = 1; number <= 12; ++number) {
      // Ribs stand out from soft tissue: a bone threshold of 160 to 200 HU finds them.
      EXPECT_GT(mean(ribLabel(side, number)), 250) << sideName(side) << number;
      EXPECT_GT(sums[ribLabel(side, number)].second, 200);
    }
}

TEST(PhantomImage, calcificationRaisesCartilageAboveTheThreshold) {
  Settings settings = coarse();
  settings.noise = 0;
  settings.matrix = 256;
  const auto share = [&](double calcification) {
    settings.calcification = calcification;
    const Images images = draw(settings);
    double above = 0, all = 0;
    for (std::size_t i = 0; i < images.ct->hu.size(); ++i)
      if (images.labels->label[i] >= kFirstCartilage) above += images.ct->hu[i] > 187.5, ++all;
    return above / all;
  };
  EXPECT_LT(share(0), 0.05);
  EXPECT_GT(share(0.5), 0.15);
}

TEST(PhantomImage, aCancelStopsTheDrawing) {
  const Settings settings = coarse();
  const Patient patient = makePatient(settings);
  EXPECT_THROW(rasterise(patient, settings, [](double done) { if (done > 0.2) throw 1; }), int);
}

}  // namespace
