// Corrections of the anatomy by hand: which rib is meant, and what is to be done with it.
#pragma once

#include "app/view/context.h"
#include "app/view/session/corrections.h"

#include <imgui.h>

namespace pectora::view {

/// A joint of the chosen rib, to be taken with the mouse.
struct JointHandle {
  std::string name;       ///< "junction", "notch"
  Joint joint = Joint::junction;
  Vec3 at;                ///< LPS mm; where the mouse holds it, or where it is
  bool isHeld = false;
};

class CorrectionsPanel {
 public:
  /// The controls of the left column. Returns a place that the slices shall go to, if there is a new one, LPS mm.
  std::optional<Vec3> controls(Context& context);
  /// Whether the mouse chooses ribs and moves joints, rather than the planes.
  bool isOn() const { return isOn_; }
  /// The joints of the chosen rib.
  std::vector<JointHandle> handles(const Context& context) const;
  bool isChosen(Side side, int number) const { return isOn_ && rib_ && number > 0 && rib_->side == side && rib_->number == number; }
  /// The mouse went down over a plane: takes the joint within `reach` mm, or chooses the rib that passes there.
  void press(const Context& context, Vec3 at, double reach);
  /// It moved, or went up, with the button that was pressed.
  void hold(Vec3 at);
  void release(Context& context);

 private:
  bool isOn_ = false;
  std::optional<RibName> rib_;
  std::optional<Joint> held_;
  bool isMoved_ = false;      // the held joint has left its place
  Vec3 heldAt_, grabbedBy_;   // where the held joint is; how far the mouse took it from its middle
};

}  // namespace pectora::view
