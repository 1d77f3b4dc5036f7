// Follows a tube of known section, such as a rib or a costal cartilage, along a line that runs near it.
//
// Sections across the line are laid on top of each other ("straightened"), so the tube is a column in them. In every section
// each place gets the score of an elliptic template: what lies inside must look like the tube, what lies around it must not.
// Viterbi's algorithm then finds the way through all sections with the greatest sum of scores.
#pragma once

#include "kernel/value/vec3.h"

#include <functional>
#include <span>
#include <vector>

namespace pectora {

/// A plane across a line; `high` and `thin` are the directions of the longer and the shorter axis of the tube's section there.
struct TubeSection {
  Vec3 centre, along, high, thin;   ///< mm; unit vectors, normal to each other
  double halfHighMm = 7, halfThinMm = 5;   ///< half axes
};

/// Sections about every `stepMm` of a line (two points or more). `thinAt` gives the direction of the tube's shorter axis near a
/// point; it is made normal to the line, and must not be parallel to it.
std::vector<TubeSection> sectionsAlong(std::span<const Vec3> line, double stepMm, const std::function<Vec3(Vec3)>& thinAt);

/// What the tube is made of: how much a value looks like it (about 1), like its usual surroundings (0), or cannot be it
/// (negative). Inside and around the tube the same value may mean different things.
struct TubeTissue {
  std::function<float(float)> inside, around;
  float airBelow = -1e9f;     ///< what is below this is air: it counts as `airAs`, and next to it the partial volume is undone
  float airAs = 0;
};

/// Another tube nearby: what lies within `radiusMm` of its line speaks neither for nor against a place.
struct TubeNeighbour {
  std::vector<Vec3> line;    ///< points at most a radius apart
  double radiusMm = 0;
};

struct TubeSearch {
  double rangeHighMm = 6, rangeThinMm = 4;    ///< how far from the line it is looked for
  double stepMm = 1;                          ///< between the places tried
  double stiffness = 0.02;                    ///< price of a sideways step between sections, score for each mm^2
  double startRangeMm = 0;                    ///< how far from the line it may begin
  double endPull = 0;                         ///< price of ending beside the line, score for each mm^2
};

struct FollowedTube {
  std::vector<Vec3> line;        ///< one point a section
  std::vector<double> inside;    ///< mean of TubeTissue::inside there
  std::vector<double> score;
};

/// `valueAt` is the CT (HU) at a position. Along the thin axis, values within 1.5 mm of air are replaced by those just before that.
/// Then it is averaged along the line (Gaussian of 2.5 mm) and across it (0.8 mm) before the tissue is asked, for that asks for a
/// mean and not for noise. At least two sections.
FollowedTube followTube(std::span<const TubeSection> sections, const std::function<float(Vec3)>& valueAt,
                        const TubeTissue& tissue, std::span<const TubeNeighbour> neighbours, const TubeSearch& search);

}  // namespace pectora
