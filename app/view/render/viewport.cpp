#include "app/view/render/viewport.h"

#include <cmath>

namespace pectora::view {
namespace {

constexpr float kPointSize = 4;   // of a cloud's points, units of the layout: scans are dense enough to close

}  // namespace

ViewportInput Viewport::item(const char* id, ImVec2 size, bool isLocked) {
  size = {std::max(16.f, std::floor(size.x)), std::max(16.f, std::floor(size.y))};
  low_ = ImGui::GetCursorScreenPos();
  size_ = size;
  camera.aspect = double(size.x) / size.y;
  ImGui::InvisibleButton(id, size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);

  const ImGuiIO& io = ImGui::GetIO();
  ViewportInput input;
  input.isHovered = ImGui::IsItemHovered();
  input.at = {(io.MousePos.x - low_.x) / size.x, (io.MousePos.y - low_.y) / size.y};
  input.movedBy = {io.MouseDelta.x / size.y, io.MouseDelta.y / size.y};
  input.isPressed = ImGui::IsItemClicked(0);
  input.isHeld = ImGui::IsItemActive() && ImGui::IsMouseDown(0);
  input.isClicked = ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(0) && io.MouseDragMaxDistanceSqr[0] < 16;
  if (ImGui::IsItemActive()) {
    if (ImGui::IsMouseDown(0) && !isLocked && !io.KeyShift) camera.orbit(input.movedBy.x, input.movedBy.y);
    else if (ImGui::IsMouseDown(1) || ImGui::IsMouseDown(2) || (ImGui::IsMouseDown(0) && io.KeyShift)) camera.pan(input.movedBy.x, input.movedBy.y);
  }
  if (input.isHovered && io.MouseWheel != 0) camera.zoom(std::pow(0.88, io.MouseWheel));
  return input;
}

void Viewport::draw(const Renderer& renderer, const std::vector<Item>& items, const ClipPlane& clip, std::uint64_t version, float scale) {
  const Matrix4 matrix = camera.matrix();
  const bool isNew = version != drawnVersion_ || matrix != drawnMatrix_ || size_.x != drawnSize_.x || size_.y != drawnSize_.y;
  if (isNew || isCoarse_) {
    frame_.resize(int(size_.x), int(size_.y), !isNew);
    renderer.draw(frame_, camera, items, clip, kPointSize * scale);
    drawnVersion_ = version, drawnMatrix_ = matrix, drawnSize_ = size_;
    isCoarse_ = isNew;
  }
  ImGui::GetWindowDrawList()->AddImage(ImTextureID(std::intptr_t(frame_.texture())), low_, {low_.x + size_.x, low_.y + size_.y}, {0, 1}, {1, 0});
}

bool Viewport::screen(Vec3 point, ImVec2& at) const {
  const Vec3 p = camera.project(point);
  at = place({float(p.x), float(p.y)});
  return p.z > 0 && p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1;
}

}  // namespace pectora::view
