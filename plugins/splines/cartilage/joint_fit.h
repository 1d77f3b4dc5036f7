// Fits the costal cartilages to the CT, all of a side at once.
#pragma once

#include "plugins/splines/cartilage/section.h"
#include "plugins/splines/cartilage/wall_voxels.h"

namespace pectora {

/// The way of one cartilage, from the costochondral junction to where it joins.
struct Course {
  int rib = 0;
  int joins = 0;               ///< 0: the sternum; n: the cartilage of rib n
  bool isEndGiven = false;     ///< its end was set by hand
  std::vector<Vec3> line;      ///< a first guess; then what was fitted
  Vec3 end;                    ///< where at the sternum it is expected to end
  double edgeMm = 6;           ///< width of its edge in the picture that it is fitted by; each step makes it sharper
  double likeness = 0;         ///< about 1 for cartilage in muscle, 0 where there is only muscle
};

/// Brings courses to where a picture of all of them together is most like the CT. Cartilages touch and grow into one another, so
/// that one alone is drawn to its neighbour's side; of all together only the right ones make up the whole.
///
/// The picture: tubes of elliptic section (see sectionSize) along cubic B-splines, 1 where any of them is and 0 elsewhere; their
/// edges are ramps, wide at first and at last as the CT's blur and the slices' thickness make them. The CT: (v - b) / (c - b), of
/// a block's value v, with the cartilage's own median c (within -25 and +40 HU of `cartilageHu`) and the surroundings b, a mean over
/// a ring around the tube for each section and each of 24 directions, in which nothing counts as darker than 20 HU. The sum of
/// squared differences, weighted by the contrast over the noise, is lowered by `steps` steps of Gauss and Newton. Unknown are the splines and, if `isShapeFree`, one size for the side
/// and for each tube a turn of its section against the wall. Bending, ends far from the rib's end, and ends far from the notch
/// or from the cartilage that is joined (anywhere on it), have a price. `scale` is the chest's (see chestScale).
void fitJointly(const WallVoxels& voxels, const WallNormal& wall, std::vector<Course>& courses, double scale, double cartilageHu, int steps,
                bool isShapeFree);

}  // namespace pectora
