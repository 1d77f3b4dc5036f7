#include "plugins/splines/cartilage/joint_fit.h"
#include "plugins/splines/cartilage/section.h"

#include "kernel/physics/workers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace pectora;

namespace {

// Middle of a tube at x, which runs from 15 to 95 mm.
using Way = std::function<Vec3(double)>;
Vec3 bow(double x) { return {x, 30, 30 + 8 * std::sin(M_PI * (x - 15) / 80)}; }

std::vector<Vec3> lineOf(const Way& way) {
  std::vector<Vec3> line;
  for (double x = 15; x <= 95; x += 0.5) line.push_back(way(x));
  return line;
}

// Tubes of cartilage (100 HU, 14 x 10 mm) in muscle (55 HU), with even noise of +-35 HU, 1 mm voxels.
Volume cartilages(const std::vector<Way>& ways) {
  Volume ct;
  ct.grid.size = {110, 60, 70};
  ct.hu.resize(ct.grid.voxels());
  std::mt19937 random(2);
  std::uniform_real_distribution<double> noise(-35, 35);
  for (int k = 0; k < 70; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 110; ++i) {
        double nearest = 1e9;
        for (const Way& way : ways)
          for (double x = 15; x <= 95; x += 2) {
            const Vec3 d = Vec3{double(i), double(j), double(k)} - way(x);
            nearest = std::min(nearest, std::hypot(d.x / 7, d.y / 5, d.z / 7));
          }
        ct.hu[ct.grid.index(i, j, k)] = std::int16_t((nearest < 1 ? 100 : 55) + noise(random));
      }
  return ct;
}

Course guess(int rib, std::vector<Vec3> line, Vec3 end) { return {.rib = rib, .line = std::move(line), .end = end}; }

// In all of the CT, cartilage of 100 HU, no pleura.
void fit(const Volume& ct, std::vector<Course>& courses, int steps) {
  const std::vector<Vec3> corners{ct.grid.toPatient({0, 0, 0}), ct.grid.toPatient({109, 59, 69})};
  fitJointly(WallVoxels(ct, Anatomy{}, corners, 0, 0), WallNormal({}), courses, 1, 100, steps, true);
}

double rmsBetween(const std::vector<Vec3>& points, const std::vector<Vec3>& line) {
  double sum = 0;
  for (const Vec3& p : points) {
    double nearest = 1e9;
    for (const Vec3& q : line) nearest = std::min(nearest, distance(p, q));
    sum += nearest * nearest;
  }
  return std::sqrt(sum / double(points.size()));
}

}  // namespace

TEST(FitJointly, FollowsABowThroughMuscleFromAStraightGuess) {
  std::vector<Course> courses{guess(5, {bow(15), bow(55) - Vec3{0, 0, 8}, bow(95)}, bow(95))};
  fit(cartilages({bow}), courses, 20);
  // Half of a voxel; the guess is 8 mm off in the middle.
  EXPECT_LT(rmsBetween(courses[0].line, lineOf(bow)), 0.5);
  EXPECT_NEAR(courses[0].likeness, 1, 0.4);
}

TEST(FitJointly, TellsCartilagesApartThatHaveGrownIntoOneAnother) {
  // Their middles come as near as 8 mm, where each is 14 mm high.
  const Way above = [](double x) { return Vec3{x, 30, 44 - 4 * std::sin(M_PI * (x - 15) / 80)}; };
  const Way below = [](double x) { return Vec3{x, 30, 26 + 6 * std::sin(M_PI * (x - 15) / 80)}; };
  const auto straight = [](const Way& way) { return std::vector<Vec3>{way(15), lerp(way(15), way(95), 0.5), way(95)}; };
  std::vector<Course> courses{guess(5, straight(above), above(95)), guess(6, straight(below), below(95))};
  fit(cartilages({above, below}), courses, 20);
  EXPECT_LT(rmsBetween(courses[0].line, lineOf(above)), 0.7);
  EXPECT_LT(rmsBetween(courses[1].line, lineOf(below)), 0.7);
}

TEST(FitJointly, IsNotDrawnIntoAThinMuscleWithFatBehindIt) {
  // A wall between fat and lung: 2 mm of muscle before the tube's front, which lies at y = 25, and 1.5 mm behind its back.
  Volume ct = cartilages({bow});
  for (int k = 0; k < 70; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 110; ++i)
        if (j < 23 || j > 36) ct.hu[ct.grid.index(i, j, k)] = j < 23 ? -100 : -870;
  std::vector<Course> courses{guess(5, lineOf(bow), bow(95))};
  fit(ct, courses, 20);
  double forwards = 0;
  for (const Vec3& p : courses[0].line) forwards += (30 - p.y) / double(courses[0].line.size());
  // A third of a voxel.
  EXPECT_LT(std::abs(forwards), 0.33);
}

TEST(FitJointly, EndsWhereAHandHasSetTheNotch) {
  const Vec3 given = bow(95) + Vec3{0, 0, 4};
  std::vector<Course> courses{guess(5, {bow(15), bow(55), given}, given)};
  courses[0].isEndGiven = true;
  fit(cartilages({bow}), courses, 20);
  EXPECT_LT(distance(courses[0].line.back(), given), 0.5);
}

TEST(FitJointly, SeesNothingInMuscleOrAir) {
  Volume ct;
  ct.grid.size = {110, 60, 70};
  for (const int hu : {40, -1000}) {
    ct.hu.assign(ct.grid.voxels(), std::int16_t(hu));
    std::vector<Course> courses{guess(5, {bow(15), bow(95)}, bow(95))};
    fit(ct, courses, 14);
    EXPECT_LT(courses[0].likeness, 0.1) << hu;
  }
}

TEST(FitJointly, ComesOutTheSameWithAnyNumberOfThreads) {
  const Volume ct = cartilages({bow});
  const int before = threads();
  std::vector<std::vector<Vec3>> lines;
  for (const int count : {1, 3}) {
    setThreads(count);
    std::vector<Course> courses{guess(5, {bow(15), bow(95)}, bow(95))};
    fit(ct, courses, 5);
    lines.push_back(courses[0].line);
  }
  setThreads(before);
  EXPECT_EQ(lines[0], lines[1]);
}

TEST(WallNormal, LooksPastTheRidgesOfRibs) {
  // A wall that leans by 20 degrees, with ridges of 3 mm every 25 mm.
  const double lean = 20 * M_PI / 180;
  std::vector<LayerSlice> pleura;
  for (double z = -120; z <= 120; z += 2.5) {
    LayerSlice slice{z, {}, false};
    for (double x = -120; x <= 120; x += 3) slice.points.push_back({x, -80 - z * std::tan(lean) + 3 * std::sin(2 * M_PI * z / 25), z});
    pleura.push_back(slice);
  }
  const WallNormal normal(pleura);
  for (double z : {-20.0, -7.0, 0.0, 11.0}) {
    const double angle = std::acos(dot(normal({0, -90 - z * std::tan(lean), z}), {0, -std::cos(lean), -std::sin(lean)})) * 180 / M_PI;
    // The ridges' own slopes are up to 37 degrees.
    EXPECT_LT(angle, 4) << z;
  }
}

TEST(SectionSize, WidensFromTheRibsSectionToTheCartilages) {
  EXPECT_EQ(sectionSize(0, 1).halfThinMm, 3.5);
  EXPECT_EQ(sectionSize(0.5, 1).halfThinMm, 5);
  EXPECT_EQ(sectionSize(1, 0.8).halfHighMm, 0.8 * 7);
}
