// What is wrong with a CT, slice by slice.
#pragma once

#include "plugins/segmenter/thorax/body.h"

#include "kernel/value/anatomy.h"

namespace pectora::thorax {

/// Slices thicker than this are said to be so; up to kThickestMm they are still segmented.
inline constexpr double kThickMm = 3, kThickestMm = 10;

/// Runs of slices of which the user must know, in the order of `what` and from below: "clipped skin" (isClipped, one entry for each
/// slice from body.firstSlice on), "metal" (eight voxels or more of the torso above 2500 HU), "missing slices" (next to no body
/// within the body), "thick slices" (all of them, above kThickMm). `heightOf` gives a slice's LPS z. Runs that are at most two
/// slices apart count as one.
std::vector<SliceRange> findDoubts(const Volume& ct, const Body& body, const std::vector<char>& isClipped,
                                   const std::function<double(int)>& heightOf);

/// "metal at z -120 to -80 mm: ...", for a warning.
std::string sentence(const SliceRange& range);

}  // namespace pectora::thorax
