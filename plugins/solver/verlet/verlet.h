// Position Verlet with velocity damping (Moreira et al., SPIE 2012, equations 1-3):
//   F = k (|d| - l0) d / |d|,   a = F / m - c (x_n - x_{n-1}) / h,   x_{n+1} = 2 x_n - x_{n-1} + h^2 a.
#pragma once

#include "plugins/solver/common/relaxation.h"

namespace pectora {

/// The first step starts from rest with the order of the scheme: x(-h) = x0 + h^2 a0 / 2.
class Verlet final : public ExplicitScheme {
 public:
  using ExplicitScheme::ExplicitScheme;

 private:
  Vec3 advance(Vec3 x, Vec3 before, Vec3 free, double damping, bool isFirst) const override;
};

}  // namespace pectora
