#include "app/view/panels/scene_joints.h"

#include "app/view/panels/scene_parts.h"

#include <cmath>

namespace pectora::view {
namespace {

// The rib whose tube a ray meets first, or null.
const Rib* ribUnder(const Anatomy& anatomy, const Ray& ray) {
  const Rib* first = nullptr;
  double nearest = INFINITY;
  for (const Rib& rib : anatomy.ribs) {
    if (rib.centerline.size() < 2) continue;
    if (const auto hit = pick(tube(rib.centerline, kRibRadius), ray); hit && hit->distance < nearest) nearest = hit->distance, first = &rib;
  }
  return first;
}

}  // namespace

void moveJoints(Context& context, CorrectionsPanel& corrections, const Viewport& viewport, const ViewportInput& input) {
  // The joint that is nearest on the screen is taken.
  if (input.isPressed) {
    const ImVec2 mouse = viewport.place(input.at);
    std::optional<JointHandle> nearest;
    float least = kJointReach * context.scale;
    for (const JointHandle& joint : corrections.handles(context)) {
      ImVec2 at;
      if (!viewport.screen(joint.at, at)) continue;
      const float away = std::hypot(at.x - mouse.x, at.y - mouse.y);
      if (away < least) least = away, nearest = joint;
    }
    if (nearest) corrections.take(*nearest, viewport.camera.onPlane(nearest->at, input.at.x, input.at.y));
  }

  // The plane goes through where it now is: its depth stays as it was taken.
  if (corrections.isHolding()) {
    for (const JointHandle& joint : corrections.handles(context))
      if (joint.isHeld && (input.movedBy.x != 0 || input.movedBy.y != 0)) corrections.hold(viewport.camera.onPlane(joint.at, input.at.x, input.at.y));
    if (!input.isHeld) corrections.release(context);
  } else if (input.isClicked && context.results->anatomyValue()) {
    if (const Rib* rib = ribUnder(*context.results->anatomyValue(), viewport.camera.ray(input.at.x, input.at.y))) corrections.choose(nameOf(*rib));
  }
}

void drawJoints(const Context& context, const CorrectionsPanel& corrections, const Viewport& viewport) {
  const Rib* rib = corrections.chosen(context);
  if (!rib) return;
  // Its line, piece by piece where the picture's edge cuts it.
  std::vector<ImVec2> piece;
  const auto drawPiece = [&] {
    ImGui::GetWindowDrawList()->AddPolyline(piece.data(), int(piece.size()), IM_COL32(250, 160, 70, 200), 0, 2.5f * context.scale);
    piece.clear();
  };
  for (const Vec3& p : rib->centerline)
    if (ImVec2 at; viewport.screen(p, at)) piece.push_back(at);
    else drawPiece();
  drawPiece();
  for (const JointHandle& joint : corrections.handles(context))
    if (ImVec2 at; viewport.screen(joint.at, at)) drawJoint(joint, at, context.scale, "scene");
}

}  // namespace pectora::view
