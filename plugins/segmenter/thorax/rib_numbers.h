// Which rib is which.
#pragma once

#include "plugins/segmenter/thorax/rib_march.h"
#include "plugins/segmenter/thorax/sternum.h"

#include <optional>

namespace pectora::thorax {

/// One rib in local mm.
struct FoundRib {
  Side side = Side::right;
  int number = 0;               ///< 0 until numbered
  MarchedRib body;
  double backHeight = 0;        ///< local z in the hindmost plane, or of the back end
  bool beginsAtTop = false;     ///< its back lies above the CT
};

/// Where the second ribs' cartilages join the sternum, right and left, local mm: at the manubriosternal joint (angle of Louis).
using SecondNotches = std::array<Vec3, 2>;
/// Nothing unless 20 mm of manubrium are in view above the joint and are 1.25 times as wide there as 10 mm below it.
std::optional<SecondNotches> findSecondNotches(const std::vector<SternumSlice>& slices, double sliceSpacing);

/// How the ribs were counted.
enum class Counting { fromFirst, fromLast, fromSternum, none };

/// Pairs the sides by height and numbers the ribs. Counts down from 1 if the first rib is in view: none is cut by the
/// upper border and the topmost begins below it by at least the distance to the next. Otherwise up from 12 if the last
/// rib is in view: the lowest begins at least 1.6 rib distances above the lower border. Otherwise from the second rib, as one does
/// by hand: the one of a side whose cartilage runs to the angle of Louis. A cartilage goes on from the rib's end half as steeply as
/// the rib's last 24 mm; one that comes within 12 mm of the notch so, and no other within 20 mm, is the second; both sides must
/// agree if both have one. Otherwise leaves all at 0.
/// Ribs that the counting makes less than 1 or more than 12 keep 0. `bottom` and `top` are the CT's borders, local mm.
Counting numberRibs(std::vector<FoundRib>& ribs, double bottom, double top, const std::optional<SecondNotches>& secondNotches = {});

}  // namespace pectora::thorax
