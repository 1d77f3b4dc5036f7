// First guesses of the cartilages' courses: curves between their ends, of the shape that covers the most cartilage.
#pragma once

#include "plugins/splines/cartilage/wall_voxels.h"

#include "kernel/value/anatomy.h"
#include "kernel/value/curve.h"

namespace pectora {

/// Where a cartilage begins and ends, and its direction there (unit vectors, from the rib to the end).
struct Ends {
  Vec3 start, leaving, end, arriving;
};

/// The usual direction in which the cartilage of a true rib reaches the sternum: from the side; the lower it sits, the more steeply
/// it comes up from below.
Vec3 arrivalAtSternum(Side side, int rib);

/// How the cartilages of a side differ from the usual: their handles at either end, over the usual one; a turn of their direction of
/// arrival, seen from the front, positive: more steeply from below; whether their depth follows the skin, not the pleura: on the
/// steep slope of a narrow trench the skin shows it better.
struct SideShape {
  double firstHandle = 1, lastHandle = 1, turnDeg = 0;
  bool followsSkin = false;
};

/// A cartilage's course when nothing shows it: seen from the front the cubic between the ends whose handles are `handle` times their
/// distance, shaped, and in depth along the pleura or the skin, which show the shape of a pit, at the distance that the ends have from it.
/// Where the layer is not known all along, the cubic alone. 40 points.
std::vector<Vec3> guessCourse(const Ends& ends, const SideShape& shape, double handle, const Anatomy& anatomy);

/// The shape with which all cartilages of a side together cover the most cartilage in the CT and the least of what is none: every
/// block counts once, between -1 for muscle or air and 1 for cartilage. In one chest cartilages are alike; if each took its own best
/// shape, it would lie on its neighbour's cartilage. Tried are handles of 0.5 to 2 and turns of -45 to 45 degrees along either layer, the
/// usual shape first.
SideShape bestShape(const std::vector<Ends>& ends, double handle, const Anatomy& anatomy, const WallVoxels& voxels,
                    double cartilageHu, double scale);

}  // namespace pectora
