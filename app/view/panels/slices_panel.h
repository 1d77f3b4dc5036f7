// The CT in three planes, with what was found in it.
#pragma once

#include "app/view/panels/corrections_panel.h"

#include <imgui.h>

namespace pectora::view {

class SlicesPanel {
 public:
  /// Ribs and joints are taken with the mouse by way of `corrections`, which outlives the panel.
  explicit SlicesPanel(CorrectionsPanel& corrections) : corrections_(corrections) {}
  void draw(Context& context, float width, float height);
  /// The controls of the left column: grey scale and positions.
  void controls(const Volume& volume, float scale);
  /// What is drawn over the slices, and in which colours.
  void legend();
  /// Leafs to a place, LPS mm.
  void goTo(const Volume& volume, Vec3 place);

 private:
  enum Plane { axial, sagittal, coronal };
  /// A line over one plane's picture, in mm across and down.
  struct Outline {
    ImU32 color;
    std::vector<ImVec2> points;
    bool isClosed = false, isDots = false;
    std::string label;
    Side side = Side::right;
    int number = 0;                // of a rib
  };
  struct PlaneState {
    Picture picture;
    int columns = 0, rows = 0;       // pixels of the picture
    double mmAcross = 1, mmDown = 1; // of one pixel
    int shown = -1;                  // voxel index across the plane
    std::vector<Outline> outlines;
    float zoom = 1;
    ImVec2 pan{0, 0};
  };
  void open(const Volume& volume, const Anatomy* anatomy);
  void fill(const Volume& volume, Plane plane);
  void outline(const Volume& volume, const Anatomy* anatomy, Plane plane);
  void drawPlane(Context& context, const Volume& volume, Plane plane, ImVec2 size);
  void press(const Context& context, Vec3 at, double reach);
  void drawJoints(Context& context, const Volume& volume, Plane plane, ImVec2 corner, float scale);
  ImVec2 onPlane(Vec3 voxel, Plane plane) const;
  /// Voxel coordinates under a place of the picture, in the plane that is shown.
  Vec3 underPlace(ImVec2 mm, Plane plane) const;

  PlaneState planes_[3];
  std::shared_ptr<const void> volume_, anatomy_;
  std::array<int, 3> at_{};          // voxel that the planes go through
  float center_ = 40, width_ = 400;  // of the grey scale, HU
  float shownCenter_ = 0, shownWidth_ = 0;
  bool hasOutlines_ = true, hasLabels_ = true;
  std::string underCursor_;
  CorrectionsPanel& corrections_;
};

}  // namespace pectora::view
