// The surfaces of the scene, made anew only where what they show has changed.
#pragma once

#include "app/view/context.h"

namespace pectora::view {

inline constexpr double kRibRadius = 4.5;   ///< as ribs are drawn, mm

class SceneParts {
 public:
  /// Brings all parts up to the results and options.
  void update(const Context& context);
  /// What is to be drawn.
  std::vector<Item> items(const Context& context) const;
  /// Grows with every change that is seen.
  std::uint64_t version() const { return version_; }

  const Surface& skin() const { return skin_; }
  /// How the operation moves a point of the skin, mm.
  Vec3 displacement(int point) const { return (*skinAfter_)[std::size_t(point)] - skinAtRest_[std::size_t(point)]; }
  /// The bars, thick enough to be taken with the mouse.
  const std::vector<Surface>& barHandles() const { return barHandles_; }
  /// The figure that colours the scene, with the ends of its range: null if nothing is coloured.
  const char* coloring(const Context& context) const;
  ColorMap map(const Context& context) const;
  double low(const Context& context) const;
  double high(const Context& context) const;
  /// Middle and radius of all that there is to see.
  std::pair<Vec3, double> bounds() const;

 private:
  void updateSkin(const Context& context);
  void updateBones(const Context& context);
  void updateScan(const Context& context);
  void updatePicked(const Context& context);

  Surface skin_, sternumAtRest_;
  std::vector<Surface> barHandles_;
  GpuSurface gpuSkin_, gpuRibs_, gpuCartilages_, gpuSternum_, gpuBar_, gpuScan_, gpuSprings_, gpuPicked_;
  std::vector<Vec3> skinAtRest_;
  std::shared_ptr<const std::vector<Vec3>> skinAfter_;
  double displacementLimit_ = 1, distanceLimit_ = 1;
  bool hasDistance_ = false;
  std::uint64_t version_ = 0;
  // What each part was made of; the patient of the scene's skin.
  std::shared_ptr<const void> patientOf_, skinOf_, sceneOf_, distancesOf_, ribsOf_, movedOf_, scanOf_;
  float skinPart_ = -1, movedPart_ = -1;
  const void* pickedSprings_ = nullptr;
  int pickedPoint_ = -1;
  std::uint64_t pickedVersion_ = ~std::uint64_t(0);
  SceneOptions lastOptions_;
};

}  // namespace pectora::view
