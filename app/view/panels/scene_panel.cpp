#include "app/view/panels/scene_panel.h"

#include "app/view/panels/scene_joints.h"
#include "app/view/panels/widgets.h"
#include "app/view/platform/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace pectora::view {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMiddleOfBar = 60;   // beyond it to either side the mouse tilts the bar, mm

double plannerSetting(Context& context, const std::string& name) {
  return context.catalog.number(context.choices.planner.id, context.choices.planner.settings, name);
}

}  // namespace

void ScenePanel::toolbar(Context& context) {
  SceneOptions& o = context.scene;
  const auto view = [&](const char* label, const char* name, double yaw, double pitch) {
    if (button(label, name)) viewport_.camera.yaw = yaw, viewport_.camera.pitch = pitch;
    ImGui::SameLine(0, 4 * context.scale);
  };
  view("Front", "view.front", 0, 0);
  view("Right", "view.right", -kPi / 2, 0);
  view("Left", "view.left", kPi / 2, 0);
  view("Above", "view.above", 0, 1.2);
  if (button("Fit", "view.fit")) framed_ = nullptr;
  hint("Show all of it. Drag turns, right drag moves, the wheel zooms, a click tells about a point.");

  ImGui::SameLine(0, 16 * context.scale);
  ImGui::SetNextItemWidth(134 * context.scale);
  static constexpr const char* kLooks[] = {"Skin", "Glass skin", "Displacement", "Distance", "No skin"};
  if (ImGui::BeginCombo("##skin", kLooks[int(o.skin)])) {
    for (int i = 0; i < int(std::size(kLooks)); ++i) {
      const bool isThere = SkinLook(i) != SkinLook::distance || context.results->scanDistances;
      if (ImGui::Selectable(kLooks[i], int(o.skin) == i, isThere ? 0 : ImGuiSelectableFlags_Disabled)) o.skin = SkinLook(i);
      mark(std::string("skin.") + kLooks[i]);
      if (SkinLook(i) == SkinLook::distance) hint(isThere ? "How far the scan lies outside the predicted skin" : "Needs a scan that is registered");
    }
    ImGui::EndCombo();
  } else {
    mark("skin");
  }
  ImGui::SameLine(0, 6 * context.scale);
  if (button("Show…", "show")) ImGui::OpenPopup("show");
  if (ImGui::BeginPopup("show")) {
    ImGui::Checkbox("Ribs, cartilages, sternum", &o.hasBones);
    ImGui::Checkbox("Bar", &o.hasBar);
    ImGui::Checkbox("Scan after the operation", &o.hasScan);
    mark("show.scan");
    ImGui::Checkbox("Springs of the picked point", &o.hasSprings);
    ImGui::Separator();
    ImGui::Checkbox("Cut open", &o.clip.isOn);
    mark("show.clip");
    if (o.clip.isOn) {
      ImGui::SameLine();
      ImGui::SetNextItemWidth(110 * context.scale);
      ImGui::Combo("##axis", &o.clipAxis, "sagittal\0coronal\0axial\0");
      ImGui::SliderFloat("##at", &o.clipAt, -200, 200, "%.0f mm");
      mark("clip.at");
    }
    ImGui::EndPopup();
  }
}

void ScenePanel::beforeAndAfter(Context& context) {
  SceneOptions& o = context.scene;
  const float need = 250 * context.scale;
  if (ImGui::GetContentRegionAvail().x > 0) ImGui::SameLine(0, 16 * context.scale);
  if (ImGui::GetContentRegionAvail().x < need) ImGui::NewLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(kMuted, "Before");
  ImGui::SameLine(0, 6 * context.scale);
  ImGui::SetNextItemWidth(std::max(60.f, ImGui::GetContentRegionAvail().x - 50 * context.scale));
  ImGui::SliderFloat("##part", &o.part, 0, 1, "");
  mark("part");
  ImGui::SameLine(0, 6 * context.scale);
  ImGui::TextColored(kMuted, "After");
}

void ScenePanel::setClip(Context& context) {
  SceneOptions& o = context.scene;
  const Vec3 axes[3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  o.clip.normal = axes[o.clipAxis];
  o.clip.offset = dot(o.clip.normal, parts_.bounds().first) + o.clipAt;
}

void ScenePanel::draw(Context& context, float width, float height, CorrectionsPanel* corrections) {
  ImGui::BeginGroup();
  toolbar(context);
  if (!corrections) beforeAndAfter(context);
  setClip(context);
  parts_.update(context);
  // A new patient is shown whole, from the front and a little from above and the left.
  const std::shared_ptr<const void> patient = context.results->after.value ? context.results->after.value : context.results->ct.value;
  if (patient && framed_ != patient && !parts_.skin().points.empty()) {
    if (!framed_) viewport_.camera.yaw = 0.45, viewport_.camera.pitch = 0.18;
    const auto [center, radius] = parts_.bounds();
    viewport_.camera.frame(center, radius);
    framed_ = patient;
  }
  const float left = ImGui::GetContentRegionAvail().x, below = height - (ImGui::GetCursorPosY());
  const ViewportInput input = viewport_.item("scene", {std::min(left, width), below}, held_ || (corrections && corrections->isHolding()));
  mark("scene");
  if (corrections && corrections->isOn()) {
    context.picked.reset();   // the mouse is for ribs
    moveJoints(context, *corrections, viewport_, input);
  } else if (held_ || !ImGui::IsMouseHoveringRect(barLow_, barHigh_)) {
    mouse(context, input);   // a click on the colour bar means no point behind it
  }
  viewport_.draw(renderer_, parts_.items(context), context.scene.clip, parts_.version(), context.scale);
  overlays(context);
  if (corrections) drawJoints(context, *corrections, viewport_);
  ImGui::EndGroup();
}

void ScenePanel::mouse(Context& context, const ViewportInput& input) {
  if (input.isPressed && context.scene.hasBar) {
    // The bar can be taken where nothing opaque lies before it.
    const Ray ray = viewport_.camera.ray(input.at.x, input.at.y);
    const auto skin = isOpaque(context.scene.skin) ? pick(parts_.skin(), ray) : std::nullopt;
    double nearest = skin ? skin->distance : INFINITY;
    for (std::size_t i = 0; i < parts_.barHandles().size(); ++i)
      if (const auto hit = pick(parts_.barHandles()[i], ray); hit && hit->distance < nearest) {
        nearest = hit->distance;
        held_ = int(i);
        grabbedAt_ = hit->position;
      }
    if (held_) {
      const std::string which = *held_ == 0 ? "" : "second_";
      atGrab_ = {plannerSetting(context, which + "lift"), plannerSetting(context, which + "level"), plannerSetting(context, which + "tilt")};
    }
  }
  if (held_) dragBar(context, input);
  else if (input.isClicked) {
    if (const auto hit = pick(parts_.skin(), viewport_.camera.ray(input.at.x, input.at.y)); hit && context.scene.skin != SkinLook::hidden) context.pickPoint(hit->point);
    else context.picked.reset();
  }
}

// A bar follows the mouse in the plane of the picture. Its middle: up and down is its level, forwards its lift; beyond, its tilt.
void ScenePanel::dragBar(Context& context, const ViewportInput& input) {
  const Camera& camera = viewport_.camera;
  const Vec3 moved = camera.onPlane(grabbedAt_, input.at.x, input.at.y) - grabbedAt_;
  const Plan* plan = context.results->planValue();
  const double aside = plan && std::size_t(*held_) < plan->bars.size() ? grabbedAt_.x - plan->bars[*held_].point.x : 0;
  const bool isEnd = std::abs(aside) > kMiddleOfBar && std::abs(camera.right().x) > 0.7;   // from the side one end hides all the bar
  const std::string which = *held_ == 0 ? "" : "second_";
  bool isChanged = false;
  for (const Parameter& p : context.catalog.parameters(context.choices.planner.id)) {
    double wanted = 0;
    if (!isEnd && p.name == which + "lift") wanted = atGrab_.lift - moved.y;
    else if (!isEnd && p.name == which + "level") wanted = atGrab_.level + moved.z;
    else if (isEnd && p.name == which + "tilt") wanted = atGrab_.tilt + std::atan(moved.z / aside) * 180 / kPi;
    else continue;
    const double value = std::round(10 * std::clamp(wanted, p.usual.low, p.usual.high)) / 10;
    if (plannerSetting(context, p.name) == value) continue;
    assign(context.choices.planner.settings, p.name, value);
    isChanged = true;
  }
  if (!input.isHeld) held_.reset();
  if (isChanged || !held_) context.changed(held_.has_value());
}

void ScenePanel::overlays(Context& context) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 low = viewport_.low(), size = viewport_.size();
  const float em = ImGui::GetFontSize();
  list->PushClipRect(low, {low.x + size.x, low.y + size.y}, true);

  // Numbers of the ribs at their front ends.
  if (context.scene.hasBones && !isOpaque(context.scene.skin))
    if (const RibCage* cage = context.results->cageValue()) {
      std::vector<ImVec2> taken;
      for (const RibCurve& rib : cage->ribs) {
        ImVec2 at;
        if (rib.number == 0 || !viewport_.screen(rib.curve.at(1), at)) continue;
        // Below those that stand there already.
        for (const ImVec2& other : taken)
          if (std::abs(other.x - at.x) < 2 * em && std::abs(other.y - at.y) < 0.9f * em) at.y = other.y + 0.9f * em;
        taken.push_back(at);
        const std::string label = fmt::format("{}{}", rib.side == Side::right ? "R" : "L", rib.number);
        list->AddText({at.x + 1, at.y + 1}, IM_COL32(0, 0, 0, 170), label.c_str());
        list->AddText(at, IM_COL32(235, 225, 195, 255), label.c_str());
      }
    }

  // Which way the patient lies.
  if (!parts_.skin().points.empty()) {
    const double side = std::cos(viewport_.camera.yaw);
    if (std::abs(side) > 0.3) {
      list->AddText({low.x + 0.7f * em, low.y + size.y / 2}, IM_COL32(170, 180, 190, 255), side > 0 ? "R" : "L");
      list->AddText({low.x + size.x - 1.4f * em, low.y + size.y / 2}, IM_COL32(170, 180, 190, 255), side > 0 ? "L" : "R");
    }
  }

  // What the picked point tells.
  if (context.picked && context.scene.skin != SkinLook::hidden && std::size_t(context.picked->point) < parts_.skin().points.size()) {
    const int point = context.picked->point;
    const Scene* scene = context.results->sceneValue();
    ImVec2 at;
    if (viewport_.screen(parts_.skin().points[point], at)) {
      const Vec3 d = parts_.displacement(point);
      std::string text = scene ? fmt::format("row {}, column {}", point / scene->columns, point % scene->columns) : fmt::format("point {}", point);
      text += fmt::format("\nmoved {:.1f} mm: {:.1f} forward, {:+.1f} up", norm(d), -d.y, d.z);
      const auto& distances = context.results->scanDistances;
      if (distances && std::size_t(point) < distances->size() && std::isfinite((*distances)[point]) && !context.results->isLive)
        text += fmt::format("\nthe scan lies {:.1f} mm {} of it", std::abs((*distances)[point]), (*distances)[point] < 0 ? "inside" : "outside");
      if (context.picked->isKnown && !context.picked->springs.empty()) {
        double most = 0, sum = 0;
        for (const PickedSpring& s : context.picked->springs) most = std::max(most, std::abs(s.force)), sum += s.stiffness;
        text += fmt::format("\n{} springs, {:.3f} N/mm in all, at most {:.3f} N", context.picked->springs.size(), sum, most);
      }
      const ImVec2 box = ImGui::CalcTextSize(text.c_str());
      ImVec2 corner{at.x + em, at.y + em};
      corner.x = std::min(corner.x, low.x + size.x - box.x - em);
      corner.y = std::min(corner.y, low.y + size.y - box.y - em);
      list->AddRectFilled({corner.x - em / 2, corner.y - em / 2}, {corner.x + box.x + em / 2, corner.y + box.y + em / 2}, IM_COL32(24, 28, 33, 230), 4);
      list->AddText(corner, IM_COL32(230, 235, 240, 255), text.c_str());
    }
  }
  if (held_ || (context.results->isPreview && context.activity.isBusy)) {
    const std::string text = context.results->isPreview ? "solving…" : fmt::format("{:.0f} ms", context.results->liveMs);
    list->AddText({low.x + em, low.y + size.y - 1.8f * em}, IM_COL32(170, 180, 190, 255), text.c_str());
  }
  list->PopClipRect();
  colorBar(context);
}

void ScenePanel::colorBar(Context& context) {
  const char* title = parts_.coloring(context);
  barLow_ = barHigh_ = {};
  if (!title) return;
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 low = viewport_.low();
  const float em = ImGui::GetFontSize(), width = 15 * em, height = 0.8f * em;
  const ImVec2 at{low.x + em, low.y + 2.1f * em};
  const ColorMap map = parts_.map(context);
  list->AddRectFilled({low.x + 0.5f * em, low.y + 0.4f * em}, {at.x + width + 1.2f * em, at.y + height + 1.7f * em}, IM_COL32(24, 28, 33, 190), 4);
  list->AddText({at.x, low.y + 0.7f * em}, IM_COL32(225, 230, 235, 255), title);
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i) {
    const auto color = [&](int k) {
      const Rgb c = colorAt(map, double(k) / kSteps);
      return ImGui::ColorConvertFloat4ToU32({c[0], c[1], c[2], 1});
    };
    const ImU32 a = color(i), b = color(i + 1);
    list->AddRectFilledMultiColor({at.x + width * float(i) / kSteps, at.y}, {at.x + width * float(i + 1) / kSteps, at.y + height}, a, b, b, a);
  }
  for (int i = 0; i <= 4; ++i) {
    const double value = parts_.low(context) + (parts_.high(context) - parts_.low(context)) * i / 4;
    const std::string text = map == ColorMap::diverging && value != 0 ? fmt::format("{:+.3g}", value) : fmt::format("{:.3g}", value);
    const float x = at.x + width * float(i) / 4 - (i == 0 ? 0 : i == 4 ? ImGui::CalcTextSize(text.c_str()).x : ImGui::CalcTextSize(text.c_str()).x / 2);
    list->AddText({x, at.y + height + 0.2f * em}, IM_COL32(200, 205, 212, 255), text.c_str());
  }
  // A click on it offers to fix its end, or to free it.
  barLow_ = at, barHigh_ = {at.x + width, at.y + height};
  markPlace("colorbar", at, {width, height});
  if (ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem) && ImGui::IsMouseHoveringRect(barLow_, barHigh_)) {
    ImGui::SetTooltip("Click to fix the range");
    if (ImGui::IsMouseClicked(0)) {
      context.scene.range = float(parts_.high(context));
      ImGui::OpenPopup("range");
    }
  }
  if (ImGui::BeginPopup("range")) {
    ImGui::Checkbox("Fix the range", &context.scene.isRangeFixed);
    mark("range.fix");
    ImGui::SetNextItemWidth(150 * context.scale);
    if (ImGui::SliderFloat("##range", &context.scene.range, 0.5f, 60, "%.1f mm")) context.scene.isRangeFixed = true;
    mark("range");
    ImGui::EndPopup();
  }
}

void ScenePanel::turntable(const Context& context, const std::string& folder, int index, int pictures, int width, int height) {
  if (index == 0) turning_ = viewport_.camera;
  turning_.aspect = double(width) / height;
  turning_.pitch = 0.12;
  turning_.yaw = 2 * kPi * index / pictures;
  parts_.update(context);
  std::filesystem::create_directories(folder);
  Frame frame;
  frame.resize(width, height, true);
  renderer_.draw(frame, turning_, parts_.items(context), context.scene.clip, 3.2f);
  writePng(fmt::format("{}/turn_{:03}.png", folder, index), width, height, readPixels(frame.framebuffer(), width, height));
}

}  // namespace pectora::view
