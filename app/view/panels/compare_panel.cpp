#include "app/view/panels/compare_panel.h"

#include "app/view/panels/widgets.h"

#include "kernel/value/curve.h"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora::view {
namespace {

constexpr const char* kLandmarks[] = {"neck", "navel", "nipple_right", "nipple_left"};
constexpr double kFarLandmark = 10;   // mm after registration: farther than hands place the same point again
constexpr const char* kSides[] = {"Skin before the operation", "Scan after the operation"};

// The whole skin that was found, not only what the model covers.
Surface skinOf(const Anatomy& anatomy) {
  constexpr int kColumns = 161;
  std::vector<Vec3> points;
  for (const LayerSlice& slice : anatomy.skin) {
    const std::vector<Vec3> level = resamplePolyline(slice.points, kColumns);
    points.insert(points.end(), level.begin(), level.end());
  }
  Surface s;
  s.triangles = layerMesh(int(anatomy.skin.size()), kColumns, {}).triangles;
  s.points = std::move(points);
  s.computeNormals();
  return s;
}

AffineMap inverse(const AffineMap& map) {
  Eigen::Matrix3d a;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a(i, j) = map.linear[i][j];
  const Eigen::Matrix3d b = a.inverse();
  AffineMap back;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) back.linear[i][j] = b(i, j);
  back.translation = -back.rotate(map.translation);
  return back;
}

// A trunk's principal axes: the longest goes up, the shortest from front to back. Which end is which the points do not say.
AffineMap upright(const std::vector<Vec3>& points, bool isTurned) {
  Vec3 mean;
  for (const Vec3& p : points) mean += p / double(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) {
    const Eigen::Vector3d d(p.x - mean.x, p.y - mean.y, p.z - mean.z);
    spread += d * d.transpose();
  }
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  const double sign = isTurned ? -1 : 1;
  const Eigen::Vector3d up = sign * axes.col(2), back = axes.col(0), left = back.cross(up);
  AffineMap map;
  const Eigen::Vector3d rows[] = {left, back, up};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) map.linear[i][j] = rows[i][j];
  map.translation = -map.rotate(mean);
  return map;
}

std::pair<Vec3, double> boundsOf(const Surface& s) {
  Vec3 low = s.points.front(), high = low;
  for (const Vec3& p : s.points)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  return {(low + high) * 0.5, 0.5 * std::max(high.z - low.z, high.x - low.x)};
}

// What puts the scan onto the CT, once all landmarks do: with each further pair it would slip from under the mouse.
const Registration* registeredBy(const Results& results, std::size_t landmarks) {
  const auto* registration = Results::as<Registration>(results.byLandmarks);
  return registration && registration->residuals.size() >= landmarks ? registration : nullptr;
}

}  // namespace

Landmarks& ComparePanel::placed(Context& context, int side) { return side == 0 ? context.choices.ctLandmarks : context.choices.scanLandmarks; }

const Landmarks& ComparePanel::landmarks(const Context& context, int side) const {
  const Landmarks& byHand = side == 0 ? context.choices.ctLandmarks : context.choices.scanLandmarks;
  if (!byHand.points.empty() || context.choices.hasScan()) return byHand;
  const auto* own = Results::as<Landmarks>(side == 0 ? context.results->phantomCtLandmarks : context.results->phantomScanLandmarks);
  return own ? *own : none_;
}

void ComparePanel::load(Context& context) {
  const Results& r = *context.results;
  const std::shared_ptr<const Value> values[] = {r.before.value ? r.before.value : r.anatomy.value, r.scan.value};
  for (int side = 0; side < 2; ++side) {
    OneSide& s = sides_[side];
    const std::shared_ptr<const void> map = side == 1 && registeredBy(r, std::size(kLandmarks)) ? r.byLandmarks.value : nullptr;
    if (s.of == values[side] && s.mapOf == map) continue;
    s.isFramed = s.isFramed && s.of == values[side] && bool(s.mapOf) == bool(map);
    s.of = values[side], s.mapOf = map;
    show(context, s, values[side].get());
  }
}

void ComparePanel::show(Context& context, OneSide& s, const Value* value) {
  s.shown = {};
  s.toShown = s.fromShown = {};
  const auto* anatomy = dynamic_cast<const Anatomy*>(value);
  const auto* mesh = dynamic_cast<const Mesh*>(value);
  const auto* cloud = dynamic_cast<const Points*>(value);
  if (anatomy && anatomy->skin.size() > 1) s.shown = skinOf(*anatomy);
  if (mesh) s.shown.points = mesh->points, s.shown.triangles = mesh->triangles;
  if (cloud) s.shown.points = cloud->points, s.shown.normals = cloud->normals;
  // A scan stands as the registration puts it; before that, with its longest way upright.
  if (&s == &sides_[1] && !s.shown.points.empty()) {
    const Registration* registration = registeredBy(*context.results, std::size(kLandmarks));
    s.toShown = registration ? registration->map : upright(s.shown.points, isTurned_);
    s.fromShown = inverse(s.toShown);
    for (Vec3& p : s.shown.points) p = s.toShown(p);
    for (Vec3& n : s.shown.normals) n = normalized(s.toShown.rotate(n));
    s.shown.computeNormals();
  }
  s.gpu.upload(s.shown);
  s.marked.clear();
  ++s.version;
}

void ComparePanel::drawSide(Context& context, int side, ImVec2 size) {
  OneSide& s = sides_[side];
  const Landmarks& marks = landmarks(context, side);
  std::vector<Vec3> at;
  for (const Landmark& l : marks.points) at.push_back(s.toShown(l.position));
  if (at != s.marked) {
    s.marked = at;
    Surface balls;
    for (const Vec3& p : at) balls.append(ball(p, 4));
    s.gpuMarks.upload(balls);
    ++s.version;
  }
  const ViewportInput input = s.viewport.item(kSides[side], size, false);
  mark(side == 0 ? "landmarks.ct" : "landmarks.scan");
  if (!s.isFramed && !s.shown.points.empty()) {
    const auto [center, radius] = boundsOf(s.shown);
    s.viewport.camera.frame(center, radius);
    s.isFramed = true;
  }
  if (input.isClicked)
    if (const auto hit = pick(s.shown, s.viewport.camera.ray(input.at.x, input.at.y))) {
      // A hand is no finer than a hundredth of a millimetre, and the script is to be read.
      Vec3 position = s.fromShown(hit->position);
      for (int a = 0; a < 3; ++a) position[a] = std::round(100 * position[a]) / 100;
      // What was not placed by hand yet begins as the phantom's own.
      for (int both = 0; both < 2; ++both)
        if (placed(context, both).points.empty()) placed(context, both).points = landmarks(context, both).points;
      auto& points = placed(context, side).points;
      const std::string name = kLandmarks[next_];
      const auto known = std::find_if(points.begin(), points.end(), [&](const Landmark& l) { return l.name == name; });
      if (known != points.end()) known->position = position;
      else points.push_back({name, position});
      // On to the next that stands on neither, or the other surface's turn.
      const auto isPlaced = [&](int on) { return landmarks(context, on).find(name) != nullptr; };
      if (isPlaced(0) && isPlaced(1)) next_ = (next_ + 1) % 4;
      context.changed(false);
    }
  s.viewport.draw(renderer_, {{&s.gpu, {.color = {0.87f, 0.72f, 0.62f}}}, {&s.gpuMarks, {.color = {0.98f, 0.62f, 0.25f}}}}, {}, s.version, context.scale);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float em = ImGui::GetFontSize();
  list->AddText({s.viewport.low().x + 0.6f * em, s.viewport.low().y + 0.4f * em}, IM_COL32(225, 230, 235, 255), kSides[side]);
  for (const Landmark& l : marks.points) {
    ImVec2 place;
    if (!s.viewport.screen(s.toShown(l.position), place)) continue;
    const std::string name = readable(l.name);
    const ImVec2 box = ImGui::CalcTextSize(name.c_str()), corner{std::min(place.x + 0.7f * em, s.viewport.low().x + s.viewport.size().x - box.x - 0.4f * em), place.y - 0.5f * em};
    list->AddRectFilled({corner.x - 0.3f * em, corner.y - 0.1f * em}, {corner.x + box.x + 0.3f * em, corner.y + box.y + 0.1f * em}, IM_COL32(24, 28, 33, 210), 3);
    list->AddText(corner, IM_COL32(255, 190, 110, 255), name.c_str());
  }
  if (s.shown.points.empty()) list->AddText({s.viewport.low().x + em, s.viewport.low().y + 3 * em}, IM_COL32(170, 178, 186, 255), "Nothing here yet");
}

void ComparePanel::draw(Context& context, float width, float height) {
  if (!context.results->scan.value) {
    emptyPlace(context.activity.isBusy ? "" : "Open a scan from after the operation at the left, or drop it on the window.", width, height);
    return;
  }
  load(context);
  const float gap = 4 * context.scale, half = std::floor((width - gap) / 2);
  drawSide(context, 0, {half, height});
  ImGui::SameLine(0, gap);
  drawSide(context, 1, {width - gap - half, height});
}

void ComparePanel::controls(Context& context) {
  Choices& c = context.choices;
  std::string& path = context.typedScan;
  heading("Scan after the operation");
  ImGui::SetNextItemWidth(-70 * context.scale);
  const bool isEntered = textField("##scan", "PLY, STL, OBJ or FastSCAN text", path, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  ImGui::SameLine(0, 6 * context.scale);
  if ((button("Open", "scan.open", {-1, 0}) || isEntered) && !path.empty()) context.open(path);
  if (c.hasScan()) parameterControls(context, c.scan, "scan");
  else note(c.source == Source::phantom ? "The phantom brings its own scan." : "None is open.");
  const auto& scan = context.results->scan.value;
  if (!scan) isPlacing_ = false;
  // What nothing brings onto the CT yet is shown beside it, for its landmarks.
  if (scan != met_ && !context.activity.isBusy) {
    met_ = scan;
    if (scan && !context.results->byLandmarks.value) isPlacing_ = isUnasked_ = true, next_ = 0;
  }
  if (isUnasked_ && registeredBy(*context.results, std::size(kLandmarks))) isPlacing_ = isUnasked_ = false;
  if (!scan) return;

  heading("Landmarks");
  if (ImGui::Checkbox("Place them by hand", &isPlacing_)) isUnasked_ = false, next_ = 0;
  mark("landmarks.place");
  const auto* registration = Results::as<Registration>(context.results->byLandmarks);
  for (int i = 0; i < 4; ++i) {
    const std::string name = kLandmarks[i];
    std::string told;
    bool isFar = false;
    const bool onCt = landmarks(context, 0).find(name), onScan = landmarks(context, 1).find(name);
    if (registration)
      for (const LandmarkResidual& residual : registration->residuals)
        if (residual.name == name) told = fmt::format("{:.1f} mm", residual.residual), isFar = residual.residual > kFarLandmark;
    if (told.empty()) told = onCt && onScan ? "" : onCt ? "on the CT" : onScan ? "on the scan" : "–";
    if (isPlacing_) {
      if (ImGui::RadioButton(("##" + name).c_str(), next_ == i)) next_ = i;
      mark("landmark." + name);
      ImGui::SameLine();
    }
    row(readable(name).c_str(), told, isFar ? &kWarm : nullptr);
    hint(isFar ? "The two lie so far apart after registration: is it the same point on both, and the patient's right on the right?"
               : "Distance of the two after registration");
  }
  const bool canTurn = isPlacing_ && !registeredBy(*context.results, std::size(kLandmarks));
  if (canTurn && button("Turn the scan over", "scan.turn", {-1, 0})) isTurned_ = !isTurned_, sides_[1].of = nullptr;
  if (isPlacing_) note("Click " + readable(kLandmarks[next_]) + " on either surface. Undo takes a click back. Or drop a file of landmarks (.csv) on the window.");
  if (!c.ctLandmarks.points.empty() && button("Forget those placed by hand", "landmarks.forget", {-1, 0})) {
    c.ctLandmarks = c.scanLandmarks = {};
    context.changed(false);
  }

  heading("Registration");
  parameterControls(context, c.registration, "registration");
  if (ImGui::Checkbox("Then by the surfaces (ICP)", &c.usesIcp)) context.changed(false);
  mark("icp");
  if (registration) row("Landmarks, RMS", fmt::format("{:.2f} mm", registration->rms));
  if (const auto* icp = Results::as<Registration>(context.results->byIcp)) row("Surfaces, RMS", fmt::format("{:.2f} mm", icp->rms));
  if (const Comparison* comparison = context.results->comparisonValue()) table(*comparison, context.scale);

  // What else can be set of both steps.
  const auto details = [&](const char* label, PluginChoice& plugin, const std::string& name) {
    const bool isOpen = ImGui::TreeNodeEx(label, ImGuiTreeNodeFlags_SpanAvailWidth);
    mark(name + ".open");
    if (!isOpen) return;
    parameterControls(context, plugin, name, {"name"});
    ImGui::TreePop();
  };
  if (c.usesIcp) details("How surfaces are brought together", c.icp, "icp");
  details("How distances are measured", c.comparer, "comparer");
}

void ComparePanel::table(const Comparison& c, float scale) {
  heading("Scan minus prediction, mm");
  if (ImGui::BeginTable("distances", 4, ImGuiTableFlags_SizingStretchProp)) {
    for (const char* head : {"", "mean", "SD", "RMS"}) {
      ImGui::TableNextColumn();
      ImGui::TextColored(kMuted, "%s", head);
    }
    const auto line = [](const char* name, const DistanceStatistics& s, const ImVec4* color) {
      if (s.count == 0) return;
      ImGui::TableNextColumn();
      if (color) ImGui::PushStyleColor(ImGuiCol_Text, *color);
      ImGui::TextUnformatted(name);
      for (const std::string& text : {fmt::format("{:+.2f}", s.mean), fmt::format("{:.2f}", s.sd), fmt::format("{:.2f}", s.rms)}) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(text.c_str());
      }
      if (color) ImGui::PopStyleColor();
    };
    // Each region, and below it what the prediction must beat there.
    const auto region = [&](const std::string& name, const DistanceStatistics& s, const DistanceStatistics& unchanged, const DistanceStatistics& copied) {
      line(name.c_str(), s, nullptr);
      line("  unchanged", unchanged, &kMuted);
      line("  bone's copy", copied, &kMuted);
    };
    region("Overlap", c.overlap, c.baselineOverlap, c.copiedOverlap);
    region("Pit", c.pit, c.baselinePit, c.copiedPit);
    for (const ComparedRegion& r : c.regions) region(readable(r.name), r.distances, r.unchanged, r.copied);
    ImGui::EndTable();
  }
  for (const ComparedRegion& r : c.regions) {
    if (r.distances.count == 0 || !std::isfinite(r.skill())) continue;
    row(("Skill, " + r.name).c_str(), fmt::format("{:.2f}", r.skill()));
    hint("1: as the scan; 0: no better than the unchanged chest");
    if (!std::isfinite(r.skillAgainstCopy())) continue;
    row(("Against bone's copy, " + r.name).c_str(), fmt::format("{:.2f}", r.skillAgainstCopy()));
    hint("0: no better than skin that is moved as the bones behind it");
  }
  // The histogram, with zero marked and each bar in the colour of the map.
  const Histogram& h = c.histogram;
  if (h.counts.empty()) return;
  const ImVec2 low = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, 90 * scale};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(low, {low.x + size.x, low.y + size.y}, IM_COL32(24, 28, 33, 255), 4);
  // What holds 99.8 % of the points.
  std::size_t total = 0, most = 1;
  for (std::size_t n : h.counts) total += n, most = std::max(most, n);
  std::size_t first = 0, last = h.counts.size() - 1, cut = 0;
  while (first < last && (cut += h.counts[first]) < total / 1000) ++first;
  cut = 0;
  while (last > first && (cut += h.counts[last]) < total / 1000) --last;
  const double from = h.low + double(first) * h.binWidth, to = h.low + double(last + 1) * h.binWidth, limit = std::max(std::abs(from), std::abs(to));
  const float em = ImGui::GetFontSize();
  const auto x = [&](double mm) { return low.x + 6 + (size.x - 12) * float((mm - from) / (to - from)); };
  for (std::size_t i = first; i <= last; ++i) {
    const double mm = h.low + double(i) * h.binWidth;
    const Rgb color = colorAt(ColorMap::diverging, 0.5 + 0.5 * (mm + 0.5 * h.binWidth) / limit);
    const float height = (size.y - 1.7f * em) * float(h.counts[i]) / float(most);
    list->AddRectFilled({x(mm), low.y + size.y - 1.3f * em - height}, {std::max(x(mm) + 1, x(mm + h.binWidth) - 1), low.y + size.y - 1.3f * em}, ImGui::ColorConvertFloat4ToU32({color[0], color[1], color[2], 1}));
  }
  for (double mm : {from, 0.0, to}) {
    if (mm < from || mm > to) continue;
    const std::string text = fmt::format("{:+.0f}", mm);
    const float wide = ImGui::CalcTextSize(text.c_str()).x;
    list->AddText({std::clamp(x(mm) - wide / 2, low.x + 3, low.x + size.x - wide - 3), low.y + size.y - 1.25f * em}, IM_COL32(190, 198, 206, 255), mm == 0 ? "0" : text.c_str());
  }
  ImGui::Dummy(size);
}

}  // namespace pectora::view
