// A rib's centreline from cross-sections normal to it.
#pragma once

#include "plugins/segmenter/thorax/outline.h"
#include "plugins/segmenter/thorax/spine.h"

namespace pectora::thorax {

/// A rib's cross-section at one place.
struct Cut {
  bool isFound = false;
  bool isMerged = false;  ///< not found because p lies in a contour too large for a rib: something touches it
  Vec3 centre;            ///< centroid of the bone contour, local mm
  double areaMm2 = 0;
  double meanHu = 0;      ///< within the contour
};

/// Cuts the bone by the plane through `p` normal to `direction`: of the outer contours at `boneHu` within 12 mm the one
/// around p, or else the nearest within 5 mm. If p lies in a contour too large for a rib, or 1.3 times (in slices of more
/// than 3 mm: 2.2 times) larger than the rib usually is (`usualAreaMm2`, 0: not known), higher levels up to 5 times boneHu
/// are tried, at which bones that touch come apart. Not found if its area is outside 12 to 300 mm^2 or it is longer than a rib.
Cut cutAcross(const Field& field, Vec3 p, Vec3 direction, double boneHu, double usualAreaMm2 = 0);

/// A centreline with the section area at every point.
struct MarchedRib {
  std::vector<Vec3> line;       ///< local mm, about 2 mm apart, from the vertebra to the front
  bool reachesVertebra = false; ///< its back end lies beside the vertebral body
  bool reachesJunction = false; ///< its front end lies within the CT
};

/// Straightens out a rough line (from back to front). Its inner part is centred on cuts normal to it; then the line is
/// carried on from both ends, 2 mm a step along its own course and centred on each new cut. In front it ends where the
/// bone ends: three steps without a cut, with a cut below 0.35 of the usual area or that does not go on as the rib fades (RibFade:
/// calcified cartilage), or a turn by 37 degrees (its specks lie off the line); where another rib touches it, it goes
/// straight on for at most 30 mm. Behind it goes on to 20 mm from the middle of the vertebral body; where rib and transverse
/// process cannot be told apart it goes straight on, bending gently towards the body. An empty line if fewer than five cuts
/// were found.
MarchedRib marchRib(const std::vector<Vec3>& rough, const Field& field, const Spine& spine, double boneHu);

}  // namespace pectora::thorax
