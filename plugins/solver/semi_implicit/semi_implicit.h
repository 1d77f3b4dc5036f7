// Semi-implicit (symplectic) Euler: v_{n+1} = v_n + h (F(x_n) / m - c v_n),   x_{n+1} = x_n + h v_{n+1}. Of order 1.
#pragma once

#include "plugins/solver/common/relaxation.h"

namespace pectora {

/// Starts with no velocity. The velocity is (x_n - x_{n-1}) / h, so that it is not stored.
class SemiImplicitEuler final : public ExplicitScheme {
 public:
  using ExplicitScheme::ExplicitScheme;

 private:
  Vec3 advance(Vec3 x, Vec3 before, Vec3 free, double damping, bool isFirst) const override;
};

}  // namespace pectora
