#include "plugins/effect/bar_contact/bar_front.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// Half the length of the bar's middle part, as part of the whole: beyond it the bar comes out between the ribs.
constexpr double kInside = 0.25;

}  // namespace

std::vector<Vec3> barFront(const Plan& plan, double t, const std::vector<Vec3>& points, double margin) {
  std::vector<Vec3> front;
  front.reserve(points.size());
  const std::vector<Vec3>& line = plan.bar.centerline;
  const double reach = 0.5 * plan.bar.width + margin;
  // Ends of the middle part, from right to left.
  const std::size_t first = std::size_t((0.5 - kInside) * double(line.size())), last = line.size() - 1 - std::min(line.size() - 1, first);
  for (const Vec3& p : points) {
    Vec3 place = farBehind(p);
    for (std::size_t i = first; i + 1 <= last && i + 1 < line.size(); ++i) {
      const Vec3 a = line[i], b = line[i + 1];
      if (p.x < a.x || p.x >= b.x || !(b.x > a.x)) continue;
      const Vec3 on = lerp(a, b, (p.x - a.x) / (b.x - a.x));
      if (std::abs(p.z - on.z) <= reach) place = {p.x, on.y + (1 - t) * plan.lift - 0.5 * plan.bar.height, p.z};
    }
    front.push_back(place);
  }
  return front;
}

}  // namespace pectora
