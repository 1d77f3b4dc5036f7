// A picture of a scene within a panel, turned and moved by the mouse.
#pragma once

#include "app/view/render/renderer.h"

#include <imgui.h>

namespace pectora::view {

/// What the mouse did over the picture in this frame. Places are parts of the picture, 0 to 1.
struct ViewportInput {
  bool isHovered = false;
  bool isPressed = false;     ///< the left button went down
  bool isHeld = false;        ///< and is still down
  bool isClicked = false;     ///< it went up where it had gone down
  ImVec2 at{}, movedBy{};     ///< movedBy in parts of the picture's height
};

/// Draws only what changed: plainly while it moves, and once more with fine edges when it has come to rest.
class Viewport {
 public:
  Camera camera;

  /// The panel's item, `size` pixels large; also turns (left button, unless `isLocked`), moves (right or middle) and zooms (wheel).
  ViewportInput item(const char* id, ImVec2 size, bool isLocked);
  /// Draws the scene if `version`, the camera or the size is new. Call it after item().
  void draw(const Renderer& renderer, const std::vector<Item>& items, const ClipPlane& clip, std::uint64_t version, float scale);
  /// Whether the next frame would be finer.
  bool isCoarse() const { return isCoarse_; }
  /// Where a point of the scene stands on the screen; false behind the eye or outside.
  bool screen(Vec3 point, ImVec2& at) const;
  /// A place of the picture on the screen.
  ImVec2 place(ImVec2 part) const { return {low_.x + part.x * size_.x, low_.y + part.y * size_.y}; }
  ImVec2 low() const { return low_; }
  ImVec2 size() const { return size_; }

 private:
  Frame frame_;
  ImVec2 low_{}, size_{};
  Matrix4 drawnMatrix_{};
  std::uint64_t drawnVersion_ = ~std::uint64_t(0);
  ImVec2 drawnSize_{};
  bool isCoarse_ = false;
};

}  // namespace pectora::view
