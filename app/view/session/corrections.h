// Corrections of the anatomy by hand, as calls of the stages that make them.
#pragma once

#include "app/view/session/choices.h"

#include "kernel/value/anatomy.h"

namespace pectora::view {

/// Which rib is meant: by its number or, if it has none, by a point of it.
struct RibName {
  Side side = Side::right;
  int number = 0;
  Vec3 near{};   ///< of a rib without a number, LPS mm
  bool operator==(const RibName&) const = default;
};
RibName nameOf(const Rib& rib);
/// The rib of that name, or null.
const Rib* findRib(const Anatomy& anatomy, const RibName& name);
/// "Left rib 5", "Right rib ?".
std::string ribText(const RibName& name);

enum class Joint {
  junction,   ///< where the rib ends and its cartilage begins
  notch,      ///< where the cartilage joins the sternum
};

PluginChoice ribDropped(const RibName& rib);
PluginChoice ribRenumbered(const RibName& rib, int number);
/// `to` is rounded to a tenth of a millimetre.
PluginChoice jointMoved(Joint joint, const RibName& rib, Vec3 to);

/// Makes a correction after those there are. One of the same joint as the last takes its place.
void addCorrection(Choices& choices, PluginChoice correction);
/// "Left rib 12 left out", "Right notch 3 moved".
std::string correctionText(const PluginChoice& correction);

}  // namespace pectora::view
