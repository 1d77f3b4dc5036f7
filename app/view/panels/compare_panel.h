// A scan after the operation against the prediction: landmarks on both surfaces, registration, distances.
#pragma once

#include "app/view/context.h"
#include "app/view/render/viewport.h"

namespace pectora::view {

class ComparePanel {
 public:
  explicit ComparePanel(const Renderer& renderer) : renderer_(renderer) {}
  void controls(Context& context);
  /// The two surfaces side by side, to place landmarks on, while isPlacing(); without a scan, what to do.
  void draw(Context& context, float width, float height);
  bool isPlacing() const { return isPlacing_; }
  bool isCoarse() const { return isPlacing_ && (sides_[0].viewport.isCoarse() || sides_[1].viewport.isCoarse()); }

 private:
  /// One of the surfaces: the skin in the CT, or the scan.
  struct OneSide {
    Surface shown;                       // upright, wherever its own coordinates lie
    AffineMap toShown, fromShown;
    GpuSurface gpu, gpuMarks;
    Viewport viewport;
    std::shared_ptr<const void> of, mapOf;
    std::uint64_t version = 0;
    bool isFramed = false;               // the camera was set for it
    std::vector<Vec3> marked;
  };
  void load(Context& context);
  void show(Context& context, OneSide& side, const Value* value);
  void drawSide(Context& context, int side, ImVec2 size);
  /// The landmarks in use on a side: those placed by hand, or the phantom's own.
  const Landmarks& landmarks(const Context& context, int side) const;
  Landmarks& placed(Context& context, int side);
  void table(const Comparison& comparison, float scale);

  const Renderer& renderer_;
  OneSide sides_[2];
  std::shared_ptr<const void> met_;   // the scan that was last looked at
  bool isPlacing_ = false;
  bool isUnasked_ = false;  // placing began by itself, and ends so
  bool isTurned_ = false;   // a scan without registration is shown upside down
  int next_ = 0;   // index of the landmark that a click places
  Landmarks none_;
};

}  // namespace pectora::view
