// The vertebral column: the middle of the vertebral body and its front, slice by slice.
#pragma once

#include "plugins/segmenter/thorax/body.h"

namespace pectora::thorax {

/// One entry a slice of the CT; between the slices where bone was seen the line is interpolated, so discs count as
/// vertebra. Local mm.
struct Spine {
  std::vector<Vec3> centre;     ///< middle of the vertebral body
  std::vector<Vec3> front;      ///< the most anterior point of the body in the midline
  int firstSlice = 0, lastSlice = 0;  ///< where it was seen; outside, the line goes straight on
};

/// Follows the column through the slices by dynamic programming (Viterbi): at each slice the score of a position is
/// the bone in a box of 24 x 20 mm there (smoothed 8 mm through the slices), less the bone in front of it, plus some
/// of the arch behind; a sideways step costs its square. The front is the last crossing of `boneHu` seen from the
/// centre, the median of nine lines 1.5 mm apart, with a running median of 15 mm and a light smoothing over the slices.
/// Throws Error if there is no column.
Spine findSpine(const Body& body, const Field& field, double boneHu);

}  // namespace pectora::thorax
