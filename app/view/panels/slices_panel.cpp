#include "app/view/panels/slices_panel.h"

#include "app/view/panels/widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora::view {
namespace {

constexpr double kJointDepth = 4;   // joints are shown so near to a plane, mm
constexpr const char* kNames[] = {"Axial", "Sagittal", "Coronal"};
// Axis of the volume that goes through each plane, and those across and down its picture.
constexpr int kThrough[] = {2, 0, 1}, kAcross[] = {0, 1, 0}, kDown[] = {1, 2, 2};

// A rib's number beside it, outwards, where the wall is dark.
void drawLabel(const std::string& text, const std::vector<ImVec2>& outline, Side side, ImU32 color) {
  const float sign = side == Side::right ? -1.f : 1.f;   // the patient's right is on the left
  const ImVec2 outermost = *std::max_element(outline.begin(), outline.end(), [&](ImVec2 a, ImVec2 b) { return sign * a.x < sign * b.x; });
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float gap = 0.3f * size.y;
  const ImVec2 at{outermost.x + (side == Side::right ? -size.x - gap : gap), outermost.y - size.y / 2};
  ImDrawList* list = ImGui::GetWindowDrawList();
  for (const ImVec2 aside : {ImVec2{-1, 0}, ImVec2{1, 0}, ImVec2{0, -1}, ImVec2{0, 1}})
    list->AddText({at.x + aside.x, at.y + aside.y}, IM_COL32(0, 0, 0, 220), text.c_str());
  list->AddText(at, color, text.c_str());
}

double spacingOf(const Volume& volume, int axis) { return volume.grid.spacing[axis]; }

}  // namespace

void SlicesPanel::open(const Volume& volume, const Anatomy* anatomy) {
  // Begin at the deepest point of the sternum, where there is one.
  for (int a = 0; a < 3; ++a) at_[a] = volume.grid.size[a] / 2;
  if (anatomy && !anatomy->sternum.contours.empty()) goTo(volume, anatomy->sternum.deepest);
  for (PlaneState& p : planes_) p.shown = -1;
}

void SlicesPanel::goTo(const Volume& volume, Vec3 place) {
  const Vec3 v = volume.grid.toVoxel(place);
  for (int a = 0; a < 3; ++a) at_[a] = std::clamp(int(std::lround(v[a])), 0, volume.grid.size[a] - 1);
}

// Voxel coordinates to mm across and down a plane's picture. The head is up in the sagittal and coronal planes.
ImVec2 SlicesPanel::onPlane(Vec3 voxel, Plane plane) const {
  const PlaneState& p = planes_[plane];
  const double across = voxel[kAcross[plane]], down = voxel[kDown[plane]];
  return {float((across + 0.5) * p.mmAcross), float((plane == axial ? down + 0.5 : p.rows - 0.5 - down) * p.mmDown)};
}

Vec3 SlicesPanel::underPlace(ImVec2 mm, Plane plane) const {
  const PlaneState& p = planes_[plane];
  Vec3 voxel{double(at_[0]), double(at_[1]), double(at_[2])};
  voxel[kAcross[plane]] = mm.x / p.mmAcross - 0.5;
  voxel[kDown[plane]] = plane == axial ? mm.y / p.mmDown - 0.5 : p.rows - 0.5 - mm.y / p.mmDown;
  return voxel;
}

void SlicesPanel::fill(const Volume& volume, Plane plane) {
  PlaneState& p = planes_[plane];
  p.columns = volume.grid.size[kAcross[plane]];
  p.rows = volume.grid.size[kDown[plane]];
  p.mmAcross = spacingOf(volume, kAcross[plane]);
  p.mmDown = spacingOf(volume, kDown[plane]);
  std::vector<unsigned char> rgba(std::size_t(p.columns) * p.rows * 4, 255);
  const float low = center_ - width_ / 2, scale = 255 / std::max(1.f, width_);
  std::array<int, 3> voxel = at_;
  for (int y = 0; y < p.rows; ++y)
    for (int x = 0; x < p.columns; ++x) {
      voxel[kAcross[plane]] = x;
      voxel[kDown[plane]] = plane == axial ? y : p.rows - 1 - y;
      const float grey = std::clamp((float(volume.at(voxel[0], voxel[1], voxel[2])) - low) * scale, 0.f, 255.f);
      unsigned char* pixel = &rgba[(std::size_t(y) * p.columns + x) * 4];
      pixel[0] = pixel[1] = pixel[2] = static_cast<unsigned char>(grey);
    }
  p.picture.upload(p.columns, p.rows, rgba.data(), true);
  p.shown = at_[kThrough[plane]];
}

void SlicesPanel::outline(const Volume& volume, const Anatomy* anatomy, Plane plane) {
  PlaneState& p = planes_[plane];
  p.outlines.clear();
  if (!anatomy) return;
  const Grid& grid = volume.grid;
  const int through = kThrough[plane], here = at_[through];
  const auto toPlane = [&](Vec3 patient) { return onPlane(grid.toVoxel(patient), plane); };
  for (const SliceContour& c : anatomy->contours) {
    if (c.points.empty()) continue;
    Outline line{structureColor(c.structure), {}, c.closed, false, "", c.side, c.structure == "rib" ? c.number : 0};
    if (plane == axial) {
      if (c.slice != here) continue;
      for (const Vec3& point : c.points) line.points.push_back(toPlane(point));
      if (line.number > 0) line.label = fmt::format("{}{}", c.side == Side::right ? "R" : "L", c.number);
    } else {
      // Where the outline of its slice passes the plane.
      line.isDots = true;
      for (std::size_t i = 0; i + (c.closed ? 0 : 1) < c.points.size(); ++i) {
        const Vec3 a = grid.toVoxel(c.points[i]), b = grid.toVoxel(c.points[(i + 1) % c.points.size()]);
        const double da = a[through] - here, db = b[through] - here;
        if ((da < 0) == (db < 0)) continue;
        line.points.push_back(onPlane(lerp(a, b, da / (da - db)), plane));
      }
    }
    if (!line.points.empty()) p.outlines.push_back(std::move(line));
  }
}

void SlicesPanel::drawPlane(Context& context, const Volume& volume, Plane plane, ImVec2 size) {
  PlaneState& p = planes_[plane];
  const int through = kThrough[plane];
  if (p.shown != at_[through]) {
    fill(volume, plane);
    outline(volume, context.results->anatomyValue(), plane);
  }
  const ImVec2 low = ImGui::GetCursorScreenPos();
  ImGui::PushID(plane);
  ImGui::InvisibleButton("plane", size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
  ImGui::PopID();
  mark(std::string("slice.") + kNames[plane]);

  // As large as it fits, times the zoom; pixels keep their shape.
  const float mmWide = float(p.columns * p.mmAcross), mmHigh = float(p.rows * p.mmDown);
  const float scale = std::min(size.x / mmWide, size.y / mmHigh) * p.zoom;
  const ImVec2 corner{low.x + (size.x - mmWide * scale) / 2 + p.pan.x, low.y + (size.y - mmHigh * scale) / 2 + p.pan.y};
  const auto toScreen = [&](ImVec2 mm) { return ImVec2{corner.x + mm.x * scale, corner.y + mm.y * scale}; };

  const ImGuiIO& io = ImGui::GetIO();
  const Vec3 under = underPlace({(io.MousePos.x - corner.x) / scale, (io.MousePos.y - corner.y) / scale}, plane);
  const std::array<int, 3> v{int(std::lround(under.x)), int(std::lround(under.y)), int(std::lround(under.z))};
  if (ImGui::IsItemHovered()) {
    bool isInside = true;
    for (int a = 0; a < 3; ++a) isInside = isInside && v[a] >= 0 && v[a] < volume.grid.size[a];
    if (isInside) {
      const Vec3 mm = volume.grid.toPatient({double(v[0]), double(v[1]), double(v[2])});
      underCursor_ = fmt::format("{} HU at ({:.1f}, {:.1f}, {:.1f}) mm", volume.at(v[0], v[1], v[2]), mm.x, mm.y, mm.z);
    }
    // The wheel leafs; with Ctrl it zooms.
    if (io.MouseWheel != 0 && io.KeyCtrl) p.zoom = std::clamp(p.zoom * std::pow(1.15f, io.MouseWheel), 1.f, 12.f);
    else if (io.MouseWheel != 0) at_[through] = std::clamp(at_[through] + int(io.MouseWheel), 0, volume.grid.size[through] - 1);
  }
  if (ImGui::IsItemActive()) {
    if (ImGui::IsMouseDown(0) && corrections_.isOn()) {
      const Vec3 at = volume.grid.toPatient(under);
      if (ImGui::IsItemActivated()) press(context, at, kJointReach * context.scale / scale);
      else if (io.MouseDelta.x != 0 || io.MouseDelta.y != 0) corrections_.hold(at);
    } else if (ImGui::IsMouseDown(0)) {
      for (int a : {kAcross[plane], kDown[plane]}) at_[a] = std::clamp(v[a], 0, volume.grid.size[a] - 1);
    } else if (ImGui::IsMouseDown(1)) {
      width_ = std::clamp(width_ + 4 * io.MouseDelta.x, 20.f, 4000.f);
      center_ = std::clamp(center_ - 2 * io.MouseDelta.y, -1000.f, 2000.f);
    } else {
      p.pan = {p.pan.x + io.MouseDelta.x, p.pan.y + io.MouseDelta.y};
    }
  }
  if (ImGui::IsItemDeactivated()) corrections_.release(context);
  if (p.zoom == 1) p.pan = {0, 0};

  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect(low, {low.x + size.x, low.y + size.y}, true);
  list->AddRectFilled(low, {low.x + size.x, low.y + size.y}, IM_COL32(0, 0, 0, 255));
  list->AddImage(ImTextureID(std::intptr_t(p.picture.texture())), corner, toScreen({mmWide, mmHigh}));
  if (hasOutlines_)
    for (const Outline& o : p.outlines) {
      std::vector<ImVec2> points;
      for (ImVec2 mm : o.points) points.push_back(toScreen(mm));
      if (o.isDots)
        for (ImVec2 at : points) list->AddRectFilled({at.x - context.scale, at.y - context.scale}, {at.x + context.scale, at.y + context.scale}, o.color);
      else list->AddPolyline(points.data(), int(points.size()), o.color, o.isClosed ? ImDrawFlags_Closed : 0, (corrections_.isChosen(o.side, o.number) ? 2.8f : 1.4f) * context.scale);
      if (hasLabels_ && !o.label.empty()) drawLabel(o.label, points, o.side, o.color);
    }

  drawJoints(context, volume, plane, corner, scale);

  // The other two planes, and which side is which.
  const ImVec2 cross = toScreen(onPlane({double(at_[0]), double(at_[1]), double(at_[2])}, plane));
  const ImU32 thin = IM_COL32(90, 180, 190, 90);
  list->AddLine({low.x, cross.y}, {low.x + size.x, cross.y}, thin);
  list->AddLine({cross.x, low.y}, {cross.x, low.y + size.y}, thin);
  const float em = ImGui::GetFontSize();
  const Vec3 mm = volume.grid.toPatient({double(at_[0]), double(at_[1]), double(at_[2])});
  static constexpr const char* kAxes = "xyz";
  list->AddText({low.x + 0.5f * em, low.y + 0.3f * em}, IM_COL32(225, 230, 235, 255), fmt::format("{}  {} = {:.1f} mm", kNames[plane], kAxes[through], mm[through]).c_str());
  static constexpr const char* kSides[][2] = {{"R", "L"}, {"A", "P"}, {"R", "L"}};
  list->AddText({low.x + 0.5f * em, low.y + size.y / 2}, IM_COL32(190, 200, 210, 255), kSides[plane][0]);
  list->AddText({low.x + size.x - 1.2f * em, low.y + size.y / 2}, IM_COL32(190, 200, 210, 255), kSides[plane][1]);
  list->PopClipRect();
}

// Takes the joint within `reach` mm, or chooses the rib that passes there.
void SlicesPanel::press(const Context& context, Vec3 at, double reach) {
  for (const JointHandle& joint : corrections_.handles(context))
    if (distance(joint.at, at) < reach) return corrections_.take(joint, at);
  corrections_.chooseAt(context, at);
}

// The joints of the rib that is being corrected, where they lie near the plane.
void SlicesPanel::drawJoints(Context& context, const Volume& volume, Plane plane, ImVec2 corner, float scale) {
  const int through = kThrough[plane];
  for (const JointHandle& handle : corrections_.handles(context)) {
    const Vec3 voxel = volume.grid.toVoxel(handle.at);
    if (std::abs(voxel[through] - at_[through]) * spacingOf(volume, through) > kJointDepth) continue;
    const ImVec2 mm = onPlane(voxel, plane);
    drawJoint(handle, {corner.x + mm.x * scale, corner.y + mm.y * scale}, context.scale, std::string("slice.") + kNames[plane]);
  }
}

void SlicesPanel::draw(Context& context, float width, float height) {
  const Volume* volume = context.results->volume();
  if (!volume) return;
  // Another patient, or another anatomy of the same.
  if (volume_ != context.results->ct.value) {
    volume_ = context.results->ct.value;
    anatomy_ = nullptr;
    open(*volume, nullptr);
  }
  if (anatomy_ != context.results->anatomy.value) {
    if (!anatomy_) open(*volume, context.results->anatomyValue());
    anatomy_ = context.results->anatomy.value;
    for (PlaneState& p : planes_) p.shown = -1;
  }
  if (shownCenter_ != center_ || shownWidth_ != width_) {
    for (PlaneState& p : planes_) p.shown = -1;
    shownCenter_ = center_, shownWidth_ = width_;
  }
  underCursor_.clear();
  const float gap = 4 * context.scale, first = std::floor((width - gap) * 0.58f), second = width - gap - first, half = std::floor((height - gap) / 2);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  drawPlane(context, *volume, axial, {first, height});
  ImGui::SetCursorScreenPos({corner.x + first + gap, corner.y});
  drawPlane(context, *volume, sagittal, {second, half});
  ImGui::SetCursorScreenPos({corner.x + first + gap, corner.y + half + gap});
  drawPlane(context, *volume, coronal, {second, height - half - gap});
  if (!underCursor_.empty()) {
    const float em = ImGui::GetFontSize();
    ImGui::GetWindowDrawList()->AddText({corner.x + 0.5f * em, corner.y + height - 1.5f * em}, IM_COL32(225, 230, 235, 255), underCursor_.c_str());
  }
}

void SlicesPanel::controls(const Volume& volume, float scale) {
  heading("Grey scale");
  const auto window = [&](const char* label, float center, float wide) {
    if (button(label, std::string("window.") + label)) center_ = center, width_ = wide;
    ImGui::SameLine(0, 4 * scale);
  };
  window("Soft tissue", 40, 400);
  window("Bone", 400, 1600);
  window("Lung", -500, 1500);
  ImGui::NewLine();
  ImGui::SetNextItemWidth(-80 * scale);
  ImGui::SliderFloat("Level", &center_, -1000, 1500, "%.0f HU");
  ImGui::SetNextItemWidth(-80 * scale);
  ImGui::SliderFloat("Window", &width_, 20, 4000, "%.0f HU", ImGuiSliderFlags_Logarithmic);

  heading("Planes");
  static constexpr const char* kLabels[] = {"Sagittal", "Coronal", "Axial"};
  for (int a = 0; a < 3; ++a) {
    ImGui::SetNextItemWidth(-80 * scale);
    ImGui::SliderInt(kLabels[a], &at_[a], 0, volume.grid.size[a] - 1);
    mark(std::string("slice.at.") + kLabels[a]);
  }
  note("The wheel leafs, Ctrl with the wheel zooms, a click moves the planes (but for corrections), a right drag sets the grey scale.");
}

void SlicesPanel::legend() {
  ImGui::Checkbox("Outlines", &hasOutlines_);
  mark("outlines");
  ImGui::SameLine();
  ImGui::Checkbox("Rib numbers", &hasLabels_);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float em = ImGui::GetFontSize();
  for (const char* structure : {"rib", "sternum", "skin", "pleura", "vertebra"}) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    list->AddRectFilled({at.x, at.y + 0.2f * em}, {at.x + 0.8f * em, at.y + em}, structureColor(structure), 2);
    ImGui::Dummy({em, em});
    ImGui::SameLine();
    ImGui::TextUnformatted(readable(structure).c_str());
  }
}

}  // namespace pectora::view
