// Ribs, cartilages and lung vessels as tubes of elliptic section, ready to be cut by slices.
#pragma once

#include "body.h"
#include "tissue.h"

#include <vector>

namespace pectora::phantom {

/// A straight piece of a tube in the CT frame.
struct TubePiece {
  Vec3 start, along;         ///< from start to start + along
  Vec3 thin, high;           ///< unit axes of the section: through the wall, and up
  double halfThin = 0, halfHigh = 0;  ///< mm
  std::uint8_t label = 0;
  bool isCalcified = false;

  double reach() const { return halfThin > halfHigh ? halfThin : halfHigh; }
  double lowest() const { return std::min(start.z, start.z + along.z) - reach(); }
  double highest() const { return std::max(start.z, start.z + along.z) + reach(); }
  /// Signed distance to the tube's surface, mm, first order; negative inside. A piece's ends are rounded.
  double distanceTo(Vec3 p) const;
};

/// Ribs of the body.
std::vector<TubePiece> ribTubes(const Body& body);
/// Cartilages; `calcifiedShare` of them, chosen by the seed in patches of 6 mm, is calcified.
std::vector<TubePiece> cartilageTubes(const Body& body, double calcifiedShare, std::uint64_t seed);
/// Vessels from the hila into the lungs, chosen by the seed.
std::vector<TubePiece> lungVessels(const Body& body, std::uint64_t seed);

}  // namespace pectora::phantom
