// The scene in 3-D, with its tools.
#pragma once

#include "app/view/panels/corrections_panel.h"
#include "app/view/panels/scene_parts.h"
#include "app/view/render/viewport.h"

namespace pectora::view {

class ScenePanel {
 public:
  explicit ScenePanel(const Renderer& renderer) : renderer_(renderer) {}
  /// With `corrections` it shows the chest as it was found, whose joints can be taken with the mouse.
  void draw(Context& context, float width, float height, CorrectionsPanel* corrections);
  /// Whether a further frame would show more.
  bool isCoarse() const { return viewport_.isCoarse(); }
  /// One picture of a turn about the patient, as a PNG file of the folder: `index` of `pictures`, begun with 0.
  void turntable(const Context& context, const std::string& folder, int index, int pictures, int width, int height);
  Camera& camera() { return viewport_.camera; }

 private:
  void toolbar(Context& context);
  void beforeAndAfter(Context& context);
  void mouse(Context& context, const ViewportInput& input);
  void dragBar(Context& context, const ViewportInput& input);
  void overlays(Context& context);
  void colorBar(Context& context);
  void setClip(Context& context);

  const Renderer& renderer_;
  SceneParts parts_;
  Viewport viewport_;
  std::shared_ptr<const void> framed_;   // the patient that the camera was set for
  std::optional<int> held_;              // index of the bar that the mouse holds
  Vec3 grabbedAt_;                       // where it was taken, LPS
  struct {
    double lift = 0, level = 0, tilt = 0;
  } atGrab_;                             // its settings then
  ImVec2 barLow_{}, barHigh_{};          // the colour bar on the screen; empty if there is none
  Camera turning_;                       // of the turntable: as it stood at the first picture
};

}  // namespace pectora::view
