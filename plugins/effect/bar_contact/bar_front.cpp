#include "plugins/effect/bar_contact/bar_front.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// Half the length of the bar's middle part, as part of the whole: beyond it the bar comes out between the ribs.
constexpr double kInside = 0.25;

// The y of one bar's front after part t for a point at rest; infinite if the bar does not pass there.
double frontBehind(const Bar& bar, double t, Vec3 p, double margin) {
  const std::vector<Vec3>& line = bar.centerline;
  const std::size_t first = std::size_t((0.5 - kInside) * double(line.size()));
  for (std::size_t i = first; i + 1 + first < line.size(); ++i) {
    const Vec3 a = line[i], b = line[i + 1];
    if (p.x < a.x || p.x >= b.x || !(b.x > a.x)) continue;
    const Vec3 on = lerp(a, b, (p.x - a.x) / (b.x - a.x));
    if (std::abs(dot(p - on, bar.up)) <= 0.5 * bar.width + margin) return on.y + (1 - t) * bar.lift - 0.5 * bar.height;
  }
  return INFINITY;
}

}  // namespace

std::vector<Vec3> barFront(const Plan& plan, double t, const std::vector<Vec3>& points, double margin) {
  std::vector<Vec3> front;
  front.reserve(points.size());
  for (const Vec3& p : points) {
    Vec3 place = farBehind(p);
    // Of two bars, the one that is farther forward there.
    for (const Bar& bar : plan.bars)
      if (const double y = frontBehind(bar, t, p, margin); y < place.y) place = {p.x, y, p.z};
    front.push_back(place);
  }
  return front;
}

}  // namespace pectora
