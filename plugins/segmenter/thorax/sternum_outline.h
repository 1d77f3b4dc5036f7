// The sternum's outline in one slice.
#pragma once

#include "plugins/segmenter/thorax/sternum.h"

namespace pectora::thorax {

/// Where in a slice the sternum is looked for, local mm.
struct SternumWindow {
  Vec3 centre;                        ///< on the midline
  double halfWidth = 0, halfDepth = 0;
  double touchMm = 0;                 ///< nearer to the border than this, clavicles and first ribs may touch an outline; 0: none do
  double right = -1e300, left = 1e300;   ///< x beyond which nothing is looked at
};

/// Whether an outline comes within a margin of the window's right or left border.
struct CutSides {
  bool right = false, left = false;
};
CutSides cutSides(const SternumSlice& slice, const SternumWindow& window, double marginMm);

/// The hull of the bone in the window whose middle is at most 18 mm aside and 12 mm before or behind (not calcified cartilage, nor a
/// clavicle's head); not seen if none crosses the midline. Bone is what is above `boneHu`. Where it comes near the window's border
/// (touchMm) and does not fill its hull by 0.92, something touches the sternum there: then the lowest of some levels up to twice as high
/// counts at which a tenth of the hull and more comes off and the rest is filled better, but the other side, and front and back on the
/// midline, stay where they are; if there is none, the hull of all.
SternumSlice outlineIn(const Field& field, int slice, const SternumWindow& window, double boneHu);

}  // namespace pectora::thorax
