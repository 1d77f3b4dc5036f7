#include "plugins/common/tube/follow.h"

#include "kernel/value/curve.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace pectora;

namespace {

// The likeness is the value itself.
TubeTissue plain() {
  const auto same = [](float v) { return v; };
  return {same, same};
}
const std::function<Vec3(Vec3)> thinAlongY = [](Vec3) { return Vec3{0, 1, 0}; };

// A tube of half axes 7 (z) and 5 (y) about z = 6 sin(x / 20), y = 0.
double middle(double x) { return 6 * std::sin(x / 20); }
float tube(Vec3 p) { return std::hypot(p.y / 5, (p.z - middle(p.x)) / 7) < 1 ? 1.0f : 0.0f; }

double rms(const std::vector<Vec3>& line) {
  double sum = 0;
  for (const Vec3& p : line) sum += p.y * p.y + std::pow(p.z - middle(p.x), 2);
  return std::sqrt(sum / double(line.size()));
}

}  // namespace

TEST(SectionsAlong, AreNormalToTheLineAndRightHanded) {
  const std::vector<Vec3> line{{0, 0, 0}, {30, 0, 10}, {60, 5, 0}};
  const auto sections = sectionsAlong(line, 2, thinAlongY);
  EXPECT_NEAR(double(sections.size()), polylineLength(line) / 2 + 1, 1);
  for (const TubeSection& s : sections) {
    EXPECT_NEAR(dot(s.along, s.thin), 0, 1e-12);
    EXPECT_LT(distance(cross(s.along, s.thin), s.high), 1e-12);
    EXPECT_GT(s.thin.y, 0.9);
  }
}

TEST(FollowTube, FindsACurvedTubeFromAStraightLine) {
  const std::vector<Vec3> line{{0, 0, 0}, {100, 0, 0}};
  TubeSearch search;
  search.rangeHighMm = 8;
  const FollowedTube found = followTube(sectionsAlong(line, 2, thinAlongY), tube, plain(), {}, search);
  // Sections are smoothed by 2.5 mm along, over which the curve of radius 67 mm departs from its chord by 0.1 mm, and places lie 1 mm apart.
  EXPECT_LT(rms(found.line), 0.5);
  EXPECT_GT(found.inside[25], 0.8);
}

TEST(FollowTube, EndsOnTheLineWhereThatIsDemanded) {
  const std::vector<Vec3> line{{0, 0, 0}, {60, 0, 0}};
  TubeSearch search;
  search.rangeHighMm = 8;
  const auto sections = sectionsAlong(line, 2, thinAlongY);
  EXPECT_LT(std::abs(followTube(sections, tube, plain(), {}, search).line.back().z - middle(60)), 1);
  search.endPull = 10;
  EXPECT_LT(std::abs(followTube(sections, tube, plain(), {}, search).line.back().z), 0.6);
}

TEST(FollowTube, IsNotDrawnToANeighbourThatIsTwiceAsBright) {
  // A second, brighter tube 12 mm above overlaps the ring around the first one.
  const auto both = [](Vec3 p) { return std::hypot(p.y / 5, (p.z - 13) / 7) < 1 ? 2.0f : std::hypot(p.y / 5, p.z / 7) < 1 ? 1.0f : 0.0f; };
  const std::vector<Vec3> line{{0, 0, 2}, {60, 0, 2}};
  TubeSearch search;
  search.rangeHighMm = 10, search.startRangeMm = 10;
  const auto sections = sectionsAlong(line, 2, thinAlongY);
  std::vector<Vec3> above;
  for (double x = -10; x <= 70; x += 2) above.push_back({x, 0, 13});
  EXPECT_GT(followTube(sections, both, plain(), {}, search).line[15].z, 4) << "alone it would go there";
  const std::vector<TubeNeighbour> neighbours{{above, 7}};
  EXPECT_NEAR(followTube(sections, both, plain(), neighbours, search).line[15].z, 0, 1);
}

TEST(FollowTube, UndoesThePartialVolumeNextToAir) {
  // Right behind the tube (value 100) lies air (-1000), blurred by 0.8 mm into it; before it muscle (0). Careless, the tube's back
  // looks like muscle, and it seems to lie further forward (less y).
  const auto besideAir = [](Vec3 p) {
    const float tissue = std::hypot(p.y / 5, p.z / 7) < 1 || (p.y > 0 && std::abs(p.z) < 7) ? 100.0f : 0.0f;
    return float(-1000 + (tissue + 1000) * 0.5 * std::erfc((p.y - 5) / (0.8 * std::sqrt(2.0))));
  };
  const auto likeness = [](float v) { return std::clamp(v / 100, 0.0f, 1.0f); };
  TubeTissue careless{likeness, likeness}, careful = careless;
  careful.airBelow = -450;
  const std::vector<Vec3> line{{0, 0, 0}, {60, 0, 0}};
  TubeSearch search;
  search.stepMm = 0.5;
  const auto sections = sectionsAlong(line, 2, thinAlongY);
  EXPECT_LT(followTube(sections, besideAir, careless, {}, search).line[15].y, -0.5);
  EXPECT_NEAR(followTube(sections, besideAir, careful, {}, search).line[15].y, 0, 0.3);
}
