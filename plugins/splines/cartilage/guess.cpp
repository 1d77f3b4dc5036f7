#include "plugins/splines/cartilage/guess.h"

#include "plugins/splines/cartilage/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pectora {
namespace {

constexpr int kSamples = 40;                            // of a course
constexpr double kHandles[] = {1, 0.5, 0.75, 1.25, 1.5, 2};
constexpr double kTurnsDeg[] = {0, -45, -30, -15, 15, 30, 45};
constexpr double kCoreMm = 7;                           // around a course, what it covers in a chest of usual size
constexpr double kStepMm = 4;                           // along a course
constexpr double kMuscleBelowHu = 45;                   // what cartilage is brighter than muscle

// y of the front of a layer's slice at x: the most forward crossing; NaN beyond its ends.
double frontAt(const LayerSlice& slice, double x) {
  double front = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 1; i < slice.points.size(); ++i) {
    const Vec3 a = slice.points[i - 1], b = slice.points[i];
    if ((a.x <= x) == (b.x <= x)) continue;
    const double y = std::lerp(a.y, b.y, (x - a.x) / (b.x - a.x));
    if (!(front <= y)) front = y;
  }
  return front;
}

// y of the layer's front at x and z; NaN outside of it.
double layerFront(const std::vector<LayerSlice>& layer, double x, double z) {
  const auto above = std::lower_bound(layer.begin(), layer.end(), z, [](const LayerSlice& s, double level) { return s.z < level; });
  if (above == layer.begin() || above == layer.end()) return std::numeric_limits<double>::quiet_NaN();
  const LayerSlice &high = *above, &low = *(above - 1);
  return std::lerp(frontAt(low, x), frontAt(high, x), (z - low.z) / (high.z - low.z));
}

// The cubic's course seen from the front, with the depth of the layer where that is known all along.
std::vector<Vec3> alongLayer(const Curve& cubic, const std::vector<LayerSlice>& layer) {
  std::vector<Vec3> points = cubic.sample(kSamples);
  std::vector<double> depth;
  for (const Vec3& p : points) depth.push_back(layerFront(layer, p.x, p.z));
  const bool isKnown = std::all_of(depth.begin(), depth.end(), [](double d) { return std::isfinite(d); });
  if (isKnown) {
    const double first = points.front().y - depth.front(), last = points.back().y - depth.back();
    for (int i = 0; i < kSamples; ++i) points[i].y = depth[i] + std::lerp(first, last, double(i) / (kSamples - 1));
  }
  return points;
}

}  // namespace

Vec3 arrivalAtSternum(Side side, int rib) {
  const double steep = std::clamp((rib - 2) * 14.0, 0.0, 70.0) * M_PI / 180;
  const double medial = side == Side::right ? 1 : -1;
  return normalized(Vec3{medial * std::cos(steep), -0.1, std::sin(steep)});
}

std::vector<Vec3> guessCourse(const Ends& ends, const SideShape& shape, double handle, const Anatomy& anatomy) {
  // Steeper, whichever side it comes from.
  const Vec3 a = ends.arriving;
  const double turn = (a.x < 0 ? -1 : 1) * shape.turnDeg * M_PI / 180, c = std::cos(turn), s = std::sin(turn);
  const Vec3 arriving{c * a.x - s * a.z, a.y, s * a.x + c * a.z};
  return alongLayer(hermiteCurve(ends.start, ends.leaving, ends.end, arriving, shape.firstHandle * handle, shape.lastHandle * handle),
                    shape.followsSkin ? anatomy.skin : anatomy.pleura);
}

SideShape bestShape(const std::vector<Ends>& ends, double handle, const Anatomy& anatomy, const WallVoxels& voxels,
                    double cartilageHu, double scale) {
  const auto worthOf = [&](int block) {
    if (!voxels.isKnown(block)) return 0.0;
    return std::clamp((voxels.hu(block) - cartilageHu) / (kMuscleBelowHu / 2) + 1, -1.0, 1.0);
  };
  SideShape best;
  double most = -std::numeric_limits<double>::infinity();
  std::vector<char> isCovered(voxels.count(), 0);
  std::vector<int> blocks;
  const auto tryShape = [&](const SideShape& shape) {
    blocks.clear();
    for (const Ends& one : ends) {
      const std::vector<Vec3> line = guessCourse(one, shape, handle, anatomy);
      for (const Vec3& p : resamplePolyline(line, std::max(2, int(polylineLength(line) / kStepMm))))
        voxels.around(p, kCoreMm * scale, [&](int block, double) {
          if (!isCovered[block]) isCovered[block] = 1, blocks.push_back(block);
        });
    }
    double worth = 0;
    for (int block : blocks) worth += worthOf(block), isCovered[block] = 0;
    if (worth > most) most = worth, best = shape;
  };
  for (const bool followsSkin : {false, true})
    for (const double turn : kTurnsDeg)
      for (const double first : kHandles)
        for (const double last : kHandles) tryShape({first, last, turn, followsSkin});
  return best;
}

}  // namespace pectora
