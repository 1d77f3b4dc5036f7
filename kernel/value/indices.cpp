#include "kernel/value/indices.h"

#include "kernel/value/levels.h"

#include <algorithm>

namespace pectora {
namespace {

// The most posterior point of every contour after a motion, caudal first: z and y.
std::vector<std::pair<double, double>> backLine(const Sternum& sternum, const RigidMotion& motion) {
  std::vector<std::pair<double, double>> line;
  for (const auto& contour : sternum.contours) {
    if (contour.empty()) continue;
    Vec3 back = motion(contour.front());
    for (const Vec3& p : contour)
      if (const Vec3 moved = motion(p); moved.y > back.y) back = moved;
    line.emplace_back(back.z, back.y);
  }
  std::sort(line.begin(), line.end());
  return line;
}

std::optional<double> at(const std::vector<std::pair<double, double>>& line, double z) {
  const auto above = std::lower_bound(line.begin(), line.end(), std::pair{z, -1e300});
  if (above == line.end() || (above == line.begin() && above->first > z)) return {};
  if (above == line.begin() || above->first == z) return above->second;
  const auto below = above - 1;
  return below->second + (above->second - below->second) * (z - below->first) / (above->first - below->first);
}

}  // namespace

std::vector<LevelMetrics> plannedLevels(const Anatomy& anatomy, const RigidMotion& sternum) {
  const auto old = backLine(anatomy.sternum, {}), now = backLine(anatomy.sternum, sternum);
  std::vector<LevelMetrics> levels;
  for (LevelMetrics level : anatomy.metrics) {
    const auto from = at(old, level.z), to = at(now, level.z);
    if (!from || !to) continue;
    level.sternumToVertebra += *from - *to;
    level.deepestInnerWall = std::max(level.deepestInnerWall, level.sternumToVertebra);
    double& side = level.eccentricity < 0 ? level.rightDepth : level.leftDepth;
    side = std::max(side, level.sternumToVertebra);
    level.externalWidth = level.externalPit = level.externalFront = level.concavityArea = 0;
    levels.push_back(level);
  }
  return levels;
}

std::optional<PlannedIndices> plannedIndices(const Anatomy& anatomy, const RigidMotion& sternum) {
  const LevelMetrics* before = anatomy.deepestLevel();
  if (!before) return {};
  Anatomy moved;
  moved.sternum.manubriosternalJoint = sternum(anatomy.sternum.manubriosternalJoint);
  moved.sternum.xiphisternalJoint = sternum(anatomy.sternum.xiphisternalJoint);
  moved.metrics = plannedLevels(anatomy, sternum);
  const LevelMetrics* after = moved.deepestLevel();
  if (!after) return {};
  return PlannedIndices{*before, *after};
}

std::vector<LevelMetrics> withSkin(std::vector<LevelMetrics> levels, const Anatomy& anatomy,
                                   const std::function<std::vector<Vec3>(double, Vec3, double)>& frontOf) {
  const auto nearest = [](const auto& list, double z, auto height) {
    return std::min_element(list.begin(), list.end(), [&](const auto& a, const auto& b) { return std::abs(height(a) - z) < std::abs(height(b) - z); });
  };
  for (LevelMetrics& level : levels) {
    level.externalWidth = level.externalPit = level.externalFront = level.concavityArea = 0;
    const auto before = nearest(anatomy.metrics, level.z, [](const LevelMetrics& m) { return m.z; });
    const auto skin = nearest(anatomy.skin, level.z, [](const LayerSlice& s) { return s.z; });
    const auto vertebra = nearest(anatomy.vertebralFront, level.z, [](Vec3 p) { return p.z; });
    if (before == anatomy.metrics.end() || before->externalWidth <= 0 || skin == anatomy.skin.end() || vertebra == anatomy.vertebralFront.end()) continue;
    // How far back the skin reaches follows from its depth at the front, which both know.
    LevelMetrics own;
    measureSkin(own, skin->points, *vertebra, anatomy.turnDeg, before->externalWidth, 0);
    const double backDepth = before->externalFront - own.externalFront;
    measureSkin(level, frontOf(level.z, *vertebra, 0.5 * before->externalWidth), *vertebra, anatomy.turnDeg, before->externalWidth, backDepth);
  }
  return levels;
}

}  // namespace pectora
