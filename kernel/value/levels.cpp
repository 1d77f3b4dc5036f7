#include "kernel/value/levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace pectora {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// A point in the patient's own axes about an origin: x to his left, y to his back.
Vec3 turnedBack(Vec3 p, Vec3 origin, double turnDeg) {
  const double c = std::cos(turnDeg / kDegrees), s = std::sin(turnDeg / kDegrees), x = p.x - origin.x, y = p.y - origin.y;
  return {c * x + s * y, c * y - s * x, p.z};
}

// Front and back of a closed contour where it crosses the column x; front > back if it does not.
std::pair<double, double> columnAt(std::span<const Vec3> contour, double x) {
  double front = 1e300, back = -1e300;
  for (std::size_t n = 0; n < contour.size(); ++n) {
    const Vec3 a = contour[n], b = contour[(n + 1) % contour.size()];
    if ((a.x > x) == (b.x > x)) continue;
    const double y = a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
    front = std::min(front, y), back = std::max(back, y);
  }
  return {front, back};
}

}  // namespace

double sectionTorsion(std::span<const Vec3> contour) {
  constexpr int kColumns = 24;
  if (contour.empty()) return 0;
  const auto [right, left] = std::minmax_element(contour.begin(), contour.end(), [](Vec3 a, Vec3 b) { return a.x < b.x; });
  const double middle = 0.5 * (right->x + left->x), half = 0.4 * (left->x - right->x);
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (int c = 0; c < kColumns; ++c) {
    const double at = half * (2 * (c + 0.5) / kColumns - 1);
    const auto [front, back] = columnAt(contour, middle + at);
    if (front > back) continue;
    const double depth = 0.5 * (front + back);
    n += 1, x += at, y += depth, xx += at * at, xy += at * depth;
  }
  const double square = n * xx - x * x;
  return square > 0 ? std::atan((n * xy - x * y) / square) * kDegrees : 0;
}

LevelMetrics measureLevel(double z, std::span<const Vec3> sternum, Vec3 vertebralFront, std::span<const Vec3> innerWall, double turnDeg) {
  LevelMetrics level;
  level.z = z;
  // The wall: its width, and its front as a whole and on either side.
  double least = 1e300, greatest = -1e300, right = 0, left = 0;
  for (const Vec3& point : innerWall) {
    const Vec3 p = turnedBack(point, vertebralFront, turnDeg);
    least = std::min(least, p.x), greatest = std::max(greatest, p.x);
    (p.x < 0 ? right : left) = std::max(p.x < 0 ? right : left, -p.y);
  }
  if (!innerWall.empty()) level.transverse = greatest - least;
  level.rightDepth = right, level.leftDepth = left;
  level.deepestInnerWall = std::max(right, left);
  // The sternum's most posterior point, and its torsion.
  Vec3 back{0, -1e300, 0};
  for (const Vec3& point : sternum)
    if (const Vec3 p = turnedBack(point, vertebralFront, turnDeg); p.y > back.y) back = p;
  if (!sternum.empty() && back.y < 0) level.sternumToVertebra = -back.y, level.eccentricity = back.x;
  if (!sternum.empty()) level.torsionDeg = sectionTorsion(sternum) - turnDeg;
  return level;
}

void measureSkin(LevelMetrics& level, std::span<const Vec3> front, Vec3 vertebralFront, double turnDeg, double width, double backDepth) {
  if (front.size() < 3) return;
  std::vector<Vec3> line;
  for (const Vec3& p : front) line.push_back(turnedBack(p, vertebralFront, turnDeg));
  std::stable_sort(line.begin(), line.end(), [](Vec3 a, Vec3 b) { return a.x < b.x; });
  // The summits right and left, and the pit between them.
  const auto middle = std::find_if(line.begin(), line.end(), [](Vec3 p) { return p.x >= 0; });
  if (middle == line.begin() || middle == line.end()) return;
  const auto forward = [](Vec3 a, Vec3 b) { return a.y < b.y; };
  const auto right = std::min_element(line.begin(), middle, forward), left = std::min_element(middle, line.end(), forward);
  const auto pit = std::max_element(right, left + 1, forward);
  level.externalWidth = width;
  level.externalPit = backDepth - pit->y;
  level.externalFront = backDepth - std::min(right->y, left->y);
  // The hull's front from summit to summit: only points that it passes before (Andrew's monotone chain).
  std::vector<Vec3> hull;
  for (auto p = right; p != left + 1; ++p) {
    const auto turn = [&] {
      const Vec3 a = hull[hull.size() - 2], b = hull.back();
      return (b.x - a.x) * (p->y - a.y) - (b.y - a.y) * (p->x - a.x);
    };
    while (hull.size() >= 2 && turn() <= 0) hull.pop_back();
    hull.push_back(*p);
  }
  const auto under = [](auto first, auto last) {
    double area = 0;
    for (auto p = first; p + 1 != last; ++p) area += ((p + 1)->x - p->x) * 0.5 * ((p + 1)->y + p->y);
    return area;
  };
  level.concavityArea = hull.size() >= 2 ? std::max(0.0, under(right, left + 1) - under(hull.begin(), hull.end())) : 0;
}

std::vector<Vec3> frontAt(const Mesh& mesh, double z, Vec3 vertebralFront, double halfWidth) {
  std::vector<Vec3> line;
  for (const auto& triangle : mesh.triangles)
    for (int e = 0; e < 3; ++e) {
      const Vec3 a = mesh.points[triangle[e]], b = mesh.points[triangle[(e + 1) % 3]];
      if ((a.z > z) == (b.z > z)) continue;
      const Vec3 p = lerp(a, b, (z - a.z) / (b.z - a.z));
      if (p.y < vertebralFront.y && std::abs(p.x - vertebralFront.x) < halfWidth) line.push_back(p);
    }
  std::sort(line.begin(), line.end(), [](Vec3 a, Vec3 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  // The two triangles at an edge give the same point.
  line.erase(std::unique(line.begin(), line.end(), [](Vec3 a, Vec3 b) { return distance(a, b) < 1e-9; }), line.end());
  return line;
}

std::vector<Vec3> frontAt(const Points& points, double z, Vec3 vertebralFront, double halfWidth) {
  constexpr double kReachMm = 2.5, kBinMm = 4;
  std::map<int, std::pair<Vec3, int>> bins;
  for (const Vec3& p : points.points) {
    if (std::abs(p.z - z) > kReachMm || p.y >= vertebralFront.y || std::abs(p.x - vertebralFront.x) >= halfWidth) continue;
    auto& [sum, count] = bins[int(std::floor(p.x / kBinMm))];
    sum += p, ++count;
  }
  std::vector<Vec3> line;
  for (const auto& [bin, content] : bins) {
    line.push_back(content.first / content.second);
    line.back().z = z;
  }
  return line;
}

double concavityVolume(std::span<const LevelMetrics> levels) {
  double volume = 0;
  for (std::size_t n = 0; n + 1 < levels.size(); ++n)
    volume += 0.5 * (levels[n].concavityArea + levels[n + 1].concavityArea) * std::abs(levels[n + 1].z - levels[n].z);
  return volume / 1000;
}

std::vector<Fact> levelFacts(const LevelMetrics& level) {
  const auto known = [](double length, double value) { return length > 0 ? value : std::numeric_limits<double>::quiet_NaN(); };
  const double depths = std::min(level.rightDepth, level.leftDepth);
  return {{"depression", known(level.deepestInnerWall, level.depression()), "mm"},
          {"depression_index", known(level.sternumToVertebra, level.depressionIndex()), ""},
          {"asymmetry", known(depths, level.asymmetry()), ""},
          {"eccentricity", known(level.sternumToVertebra, level.eccentricity), "mm"},
          {"torsion", known(level.sternumToVertebra, level.torsionDeg), "deg"},
          {"flatness", known(depths, level.flatness()), ""},
          {"external_haller_index", known(level.externalPit, level.externalHaller()), ""},
          {"external_correction_index", known(level.externalFront, level.externalCorrectionIndex()), "%"}};
}

}  // namespace pectora
