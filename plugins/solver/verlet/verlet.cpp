#include "plugins/solver/verlet/verlet.h"

namespace pectora {

Vec3 Verlet::advance(Vec3 x, Vec3 before, Vec3 free, double damping, bool isFirst) const {
  const double h = stepLength();
  const Vec3 previous = isFirst ? x + free * (0.5 * h * h) : before;
  const Vec3 velocity = (x - previous) / h;
  return x + (x - previous) + (free - velocity * damping) * (h * h);
}

}  // namespace pectora
