// What was found in the CT, in slices or in 3-D, with what is corrected by hand.
#pragma once

#include "app/view/panels/slices_panel.h"

namespace pectora::view {

class AnatomyPanel {
 public:
  /// The controls of the left column. Returns a place that the scene in 3-D is to turn about, if there is a new one, LPS mm.
  std::optional<Vec3> controls(Context& context);
  void drawSlices(Context& context, float width, float height) { slices_.draw(context, width, height); }
  /// Whether the scene in 3-D is shown instead of the slices.
  bool isSolid() const { return isSolid_; }
  CorrectionsPanel& corrections() { return corrections_; }

 private:
  CorrectionsPanel corrections_;
  SlicesPanel slices_{corrections_};
  bool isSolid_ = false;
};

}  // namespace pectora::view
