// The usual section of a costal cartilage, and how it lies in the chest wall.
#pragma once

#include "kernel/value/anatomy.h"

namespace pectora {

constexpr double kHalfHighMm = 7, kHalfThinMm = 5;   ///< half axes of a cartilage in a chest 235 mm wide inside

/// Half axes at a place along a cartilage, mm.
struct SectionSize {
  double halfHighMm = kHalfHighMm, halfThinMm = kHalfThinMm;
};
/// At part `along` (0 at the costochondral junction, 1 at the end): it begins with the rib's section of 13 x 7 mm and is 14 x 10 mm wide
/// from 0.3 on; all times `scale`.
SectionSize sectionSize(double along, double scale);

/// Inner width of the chest over 235 mm, within 0.6 to 1.3; 1 if the pleura is not known.
double chestScale(const std::vector<LayerSlice>& pleura);

/// The direction out of the chest wall: normal of the plane of least squares through the pleura nearby, weighted by a Gaussian of
/// 20 mm around the point, so that it does not see the ridges that ribs and cartilages make. Forwards where there is no pleura.
class WallNormal {
 public:
  explicit WallNormal(const std::vector<LayerSlice>& pleura);
  Vec3 operator()(Vec3 p) const;   ///< unit vector

 private:
  std::vector<std::vector<Vec3>> rows_;   // of the pleura, thinned out; caudal first
};

}  // namespace pectora
