// Corrections of the anatomy by hand: which rib is meant, and what is to be done with it. Slices and the scene in 3-D work it alike.
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

/// From a joint's middle to a press that takes it, units of the layout.
inline constexpr float kJointReach = 10;
/// Draws one at its place on the screen, and marks that as `picture`.NAME.
void drawJoint(const JointHandle& joint, ImVec2 at, float scale, const std::string& picture);

class CorrectionsPanel {
 public:
  /// The controls of the left column. Returns a place that is to be shown, if there is a new one, LPS mm.
  std::optional<Vec3> controls(Context& context);
  /// Whether the mouse chooses ribs and moves joints, rather than the planes.
  bool isOn() const { return isOn_; }
  /// Whether it holds a joint.
  bool isHolding() const { return held_.has_value(); }
  /// The rib that is chosen, or null.
  const Rib* chosen(const Context& context) const;
  /// The joints of the chosen rib.
  std::vector<JointHandle> handles(const Context& context) const;
  bool isChosen(Side side, int number) const { return isOn_ && rib_ && number > 0 && rib_->side == side && rib_->number == number; }
  void choose(const RibName& rib) { rib_ = rib; }
  /// Chooses the rib that passes a place, if one does.
  void chooseAt(const Context& context, Vec3 at);
  /// The mouse takes a joint at a place beside its middle, moves it, and lets go.
  void take(const JointHandle& joint, Vec3 at);
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
