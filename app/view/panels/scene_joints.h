// Joints of ribs in the scene in 3-D: what the mouse does with them, and how they are drawn.
#pragma once

#include "app/view/panels/corrections_panel.h"
#include "app/view/render/viewport.h"

namespace pectora::view {

/// A joint of the chosen rib follows the mouse in the plane of the picture; a click on a rib chooses it. Call it with every frame's
/// input while corrections are on.
void moveJoints(Context& context, CorrectionsPanel& corrections, const Viewport& viewport, const ViewportInput& input);
/// The chosen rib and its joints, over the picture.
void drawJoints(const Context& context, const CorrectionsPanel& corrections, const Viewport& viewport);

}  // namespace pectora::view
