// The ways of one side's costal cartilages: guessed, and fitted to the CT where it shows them.
#pragma once

#include "plugins/splines/cartilage/cage.h"
#include "plugins/splines/cartilage/section.h"

namespace pectora {

/// A cartilage's curve, from the costochondral junction to where it joins.
struct CartilageCourse {
  int rib = 0;
  int joins = 0;          ///< 0: the sternum; n: the cartilage of rib n
  Curve curve;
  bool isSeen = false;    ///< fitted to the CT; else guessed
};

/// What is known of one side, cranial first.
struct SideCourses {
  std::vector<CartilageCourse> courses;
  std::vector<int> missing;   ///< ribs whose junction, or what their cartilage joins, was not found
};

/// The cartilages of ribs 1 to 10 of a side; see buildCage. `ribs` are the curves of both sides' ribs. `poll` is called now and then.
SideCourses findCourses(Side side, const std::vector<RibCurve>& ribs, const Anatomy& anatomy, const Volume* ct, const WallNormal& wall,
                        const CageSettings& settings, const std::function<void()>& poll);

}  // namespace pectora
