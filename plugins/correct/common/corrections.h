// What a hand may change in a segmented anatomy. Every function returns a changed copy; positions are LPS mm.
#pragma once

#include "kernel/value/anatomy.h"

#include <optional>

namespace pectora {

/// Which rib is meant: that of a number, or, for ribs without a number, the one of that side that passes nearest to a point.
struct RibChoice {
  Side side = Side::right;
  int number = 0;              ///< 0: by `near`
  std::optional<Vec3> near;
};

/// "right", "left". Throws Error for anything else.
Side sideOf(const std::string& word);
/// "right 1, 2, 3; left 1, 2 and one without a number": for errors.
std::string ribsThereAre(const Anatomy& anatomy);

/// Takes the rib out, with its outlines if it has a number. Throws Error that names the ribs there are if it is not one of them.
Anatomy dropRib(const Anatomy& anatomy, const RibChoice& rib);
/// Gives the rib another number, 1 to 12. Throws Error as dropRib, and if that number is taken on its side.
Anatomy renumberRib(const Anatomy& anatomy, const RibChoice& rib, int number);
/// Moves the rib's costochondral junction: the centreline ends at the point, cut there or carried on to it in a straight line.
/// Throws Error as dropRib, and if the point lies more than 60 mm from the rib.
Anatomy moveJunction(const Anatomy& anatomy, const RibChoice& rib, Vec3 to);
/// Moves the notch where the cartilage of rib 1 to 7 joins the sternum, or makes it; the cartilage then ends there whatever the CT
/// shows. Throws Error for another rib.
Anatomy moveNotch(const Anatomy& anatomy, Side side, int rib, Vec3 to);
/// Replaces the outline of "skin", "pleura" (open, from the patient's right to his left) or "sternum" (closed) at the level nearest
/// to z by these points, and measures the level again from it. Throws Error for another structure, fewer than three points, and
/// where the anatomy has no such level within one and a half slice distances.
Anatomy giveContour(const Anatomy& anatomy, const std::string& structure, double z, const std::vector<Vec3>& points);

}  // namespace pectora
