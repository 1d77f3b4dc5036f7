#include "kernel/value/indices.h"

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

std::optional<PlannedIndices> plannedIndices(const Anatomy& anatomy, const RigidMotion& sternum) {
  const LevelMetrics* before = anatomy.deepestLevel();
  if (!before) return {};
  const auto old = backLine(anatomy.sternum, {}), now = backLine(anatomy.sternum, sternum);
  Anatomy moved;
  moved.sternum.manubriosternalJoint = sternum(anatomy.sternum.manubriosternalJoint);
  moved.sternum.xiphisternalJoint = sternum(anatomy.sternum.xiphisternalJoint);
  for (LevelMetrics level : anatomy.metrics) {
    const auto from = at(old, level.z), to = at(now, level.z);
    if (!from || !to) continue;
    level.sternumToVertebra += *from - *to;
    level.deepestInnerWall = std::max(level.deepestInnerWall, level.sternumToVertebra);
    moved.metrics.push_back(level);
  }
  const LevelMetrics* after = moved.deepestLevel();
  if (!after) return {};
  return PlannedIndices{*before, *after};
}

}  // namespace pectora
