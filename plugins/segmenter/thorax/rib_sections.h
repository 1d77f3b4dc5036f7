// Cross-sections of the ribs in half-planes that turn about the chest's long axis.
//
// In an axial slice a rib is cut lengthwise wherever it runs level (rib 1, the posterior angles, the anterior tips).
// In a half-plane through an axis that follows the spine, 30 mm before it, every rib is cut crosswise nearly all the
// way from the transverse process to its tip, and ribs lie above each other in their order. So contours are tracked
// from half-plane to half-plane instead of from slice to slice.
#pragma once

#include "plugins/segmenter/thorax/outline.h"
#include "plugins/segmenter/thorax/spine.h"

#include "kernel/value/anatomy.h"

namespace pectora::thorax {

/// The turning half-planes of one side: plane n makes n degrees with the direction to the front (0 front, 90 the
/// patient's side, 180 back). Coordinates in a plane: x = distance from the axis, y = local z, both mm.
struct Fan {
  Side side = Side::right;
  std::vector<Vec3> axis;    ///< one point a slice, local mm
  double sliceSpacing = 1;

  static constexpr int kFirst = 4, kLast = 158;   ///< planes that are looked at, degrees

  /// Local mm of a point of a plane.
  Vec3 position(double degrees, Point2 p) const;
  /// The axis point at a height.
  Vec3 axisAt(double z) const;
};
Fan makeFan(Side side, const Spine& spine, Vec3 spacing);

/// One closed bone contour of one plane that may be a rib.
struct Section {
  Loop contour;          ///< mm, in the plane's coordinates
  Shape shape;
};

/// What passes for a rib's cross-section.
struct SectionLimits {
  double boneHu = 160;
  double leastAreaMm2 = 12, mostAreaMm2 = 320;
  double mostSpreadMm = 9.5;    ///< of the longer axis (standard deviation): a scapula's blade is longer
};

/// The sections of every plane from kFirst to kLast; sections[n - kFirst] for plane n. A long contour that comes apart at
/// a higher level (up to 3.5 times boneHu) into parts one above the other counts as those parts: ribs that touch.
std::vector<std::vector<Section>> findSections(const Fan& fan, const Field& field, const SectionLimits& limits);

}  // namespace pectora::thorax
