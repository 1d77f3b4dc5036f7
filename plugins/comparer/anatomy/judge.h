// How far a segmented anatomy is from the truth of a phantom.
#pragma once

#include "kernel/value/rib_cage.h"
#include "kernel/value/truth.h"

namespace pectora {

/// Distance from a point to a polyline, mm; infinity for an empty one.
double distanceToPolyline(Vec3 p, const std::vector<Vec3>& line);

/// Figures of the found anatomy against the truth: ribs rightly numbered (of the 20 of ribs 1-10), RMS distances from the truth's
/// rib and cartilage centrelines to the found ones (all, and the worst one; cartilages up to where they enter the sternum's bone), mean distance of the sternum's outline, mean absolute
/// distances of skin and pleura, errors of torsion, Haller and correction index (found minus true). Distances in mm run from truth
/// points to what was found, so that what is missing counts; layers are measured in the plane of each level,
/// the pleura from the jugular notch to the sternal body's end. `cage` may be null: no cartilages then.
std::vector<Fact> judgeAnatomy(const Anatomy& found, const RibCage* cage, const Truth& truth);

}  // namespace pectora
