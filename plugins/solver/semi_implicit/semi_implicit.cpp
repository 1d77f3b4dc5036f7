#include "plugins/solver/semi_implicit/semi_implicit.h"

namespace pectora {

Vec3 SemiImplicitEuler::advance(Vec3 x, Vec3 before, Vec3 free, double damping, bool isFirst) const {
  const double h = stepLength();
  const Vec3 velocity = isFirst ? Vec3{} : (x - before) / h;
  return x + (velocity + (free - velocity * damping) * h) * h;
}

}  // namespace pectora
