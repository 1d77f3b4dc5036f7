// How a rib's brightness goes on towards its front end.
#pragma once

#include <vector>

namespace pectora::thorax {

/// Tells a rib that fades towards its end, as those of patients do, from calcified cartilage behind the end: that is a step down
/// (it has no cortex), or brighter again. Brightness is the mean of a cut, in HU; cuts follow one another 2 mm apart.
class RibFade {
 public:
  /// From the cuts so far, from behind; `usualHu` is the rib's usual brightness.
  RibFade(std::vector<double> soFar, double usualHu);
  /// Whether the next cut may be that rib: at least 0.83 of what a straight line through the last 24 mm predicts (which is
  /// not above the usual), at least 0.55 of the usual, and, where the rib has faded to less than 0.83 of the usual, not brighter
  /// by a tenth of the usual than its faintest cut since.
  bool goesOn(double meanHu) const;
  void add(double meanHu);

 private:
  std::vector<double> cuts_;
  double usualHu_, faintest_;
};

}  // namespace pectora::thorax
