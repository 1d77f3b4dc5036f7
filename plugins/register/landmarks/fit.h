// Maps between paired landmarks.
#pragma once

#include "kernel/value/comparison.h"

namespace pectora {

enum class MapKind { rigid, similarity, affine };

struct LandmarkPair {
  std::string name;
  Vec3 moving, fixed;
};

/// Pairs by name, in the order of `fixed`. Landmarks of one side only are left out.
std::vector<LandmarkPair> pairLandmarks(const Landmarks& moving, const Landmarks& fixed);

/// The least-squares map from moving to fixed: rigid and similarity by Umeyama (1991), affine by normal equations.
/// Residuals per landmark, and leave-one-out errors where enough landmarks remain.
/// Throws Error if there are fewer than 3 pairs (affine: 4), or they lie on one line (affine: in one plane).
Registration fitLandmarks(const std::vector<LandmarkPair>& pairs, MapKind kind);

}  // namespace pectora
