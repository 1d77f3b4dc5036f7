// Springs whose stiffness grows with their strain.
#pragma once

#include "plugins/effect/common/pair_term.h"

namespace pectora {

/// What such a spring adds to a linear one of stiffness k and rest length l0, at the strain e = l / l0 - 1 > 0: the force
/// k l0 ((exp(b e) - 1) / b - e), so that both together have the stiffness k exp(b e) (Fung 1967). From the strain on where
/// that is `mostRatio` times k the stiffness grows no further. Below l0: nothing.
struct FungSpring {
  double stiffnessNPerMm = 0, restLength = 0;
};
std::unique_ptr<PairLaw> makeFungLaw(std::vector<FungSpring> springs, double b, double mostRatio);

}  // namespace pectora
