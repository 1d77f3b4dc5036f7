// Ribs and costal cartilages as B-splines, with the sternum that they hold. LPS mm.
#pragma once

#include "kernel/value/anatomy.h"
#include "kernel/value/curve.h"

namespace pectora {

struct RibCurve {
  Side side = Side::right;
  int number = 0;
  Curve curve;             ///< from the vertebra to the costochondral junction
  double rmsError = 0;     ///< of the tracked centroids against the curve, mm
};

/// A costal cartilage, from the costochondral junction (u = 0) to where it joins (u = 1).
struct Cartilage {
  Side side = Side::right;
  int rib = 0;
  Curve curve;
  int joins = 0;              ///< 0: the sternum; n: the cartilage of rib n on the same side (the costal arch)
  double joinsAt = 0;         ///< parameter on the cartilage that it joins, if joins > 0
};

struct RibCage : Value {
  static constexpr const char* kName = "RibCage";
  std::shared_ptr<const Anatomy> anatomy;
  std::vector<RibCurve> ribs;
  std::vector<Cartilage> cartilages;   ///< rib 1 first, right before left; a cartilage comes after the one it joins

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
};

}  // namespace pectora
