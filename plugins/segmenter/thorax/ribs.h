// The ribs of a chest: tracked, centred and numbered.
#pragma once

#include "plugins/segmenter/thorax/rib_numbers.h"
#include "plugins/segmenter/thorax/rib_tracks.h"

#include <functional>
#include <string>

namespace pectora::thorax {

/// Which tracks are ribs: those that begin behind (plane 140 or more) and reach plane 138 or the CT's lower border, and
/// those that begin at the CT's upper border; not those that have lung outside them, nor those that begin at the upper
/// border and lie more than 14 mm outside the next rib below (scapula), nor what lies 22 mm inside the rib above
/// (organs with contrast agent). Fragments of calcified cartilage in front of a rib are cut off.
std::vector<Track> chooseRibs(std::vector<Track> tracks, const Fan& fan, const Body& body);

/// Parts ribs of a side that thick slices have merged in front. Two ribs' lines never come within 8 mm of each other; where
/// the front end of one does (not counting what lies within 60 mm of either's back), its line has strayed over, and its front, from
/// 16 mm before it is 11 mm away, is replaced by a piece of the same length that goes on with the direction and the bend of the
/// 40 mm before.
void partMergedFronts(std::vector<FoundRib>& ribs);

/// Both sides' ribs, cranial first, right before left; `secondNotches` as for numberRibs. `warnings` receives what the user must know.
std::vector<FoundRib> findRibs(const Body& body, const Field& field, const Spine& spine, const std::optional<SecondNotches>& secondNotches,
                               double boneHu, std::vector<std::string>& warnings, const std::function<void(double)>& step = {});

/// How far the patient is turned about z, degrees: the median angle of the lines from right to left between points of the two
/// ribs of a number that are equally far along them, against x. 0 if fewer than three ribs were found on both sides.
double patientTurn(const std::vector<FoundRib>& ribs);

}  // namespace pectora::thorax
