// Follows the costal cartilages through the CT.
#pragma once

#include "kernel/value/anatomy.h"
#include "kernel/value/volume.h"

#include <functional>

namespace pectora {

/// The way of one cartilage, from the costochondral junction to where it joins.
struct Course {
  Side side = Side::right;
  int rib = 0;
  int joins = 0;               ///< 0: the sternum; n: the cartilage of rib n, which stands before it in the list
  bool isEndGiven = false;     ///< its end was set by hand
  std::vector<Vec3> line;      ///< a first guess; then what was followed
  double likeness = 0;         ///< mean score along it: about 1 for cartilage in muscle, 0 where there is only muscle
};

struct TraceSettings {
  double cartilageHu = 100;    ///< mean of unossified cartilage
};

/// Moves the courses to where the CT shows cartilage (calcified cartilage counts as such), wide at first and one after the
/// other from above, then closely with all the others as neighbours. Muscle is taken to be 45 HU darker. Sections are ellipses
/// of 14 x 10 mm in a chest 235 mm wide inside, and in proportion in others; their shorter axis is normal to the pleura.
/// The cartilages that join another one nestle to it long before nobody can tell them apart; they end 0.6 of the way along it.
/// The others begin within 1.5 mm of their guess's start and end near to their guess's end. `poll` is called now and then.
void traceCartilages(const Volume& ct, const Anatomy& anatomy, std::vector<Course>& courses, const TraceSettings& settings,
                     const std::function<void()>& poll);

}  // namespace pectora
