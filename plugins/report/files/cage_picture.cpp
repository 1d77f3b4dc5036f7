#include "plugins/report/files/cage_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr int kWidth = 1180, kHeight = 680;
constexpr Color kBone{0.80, 0.66, 0.36}, kCartilage{0.30, 0.52, 0.80}, kSternum{0.72, 0.30, 0.26}, kAfter{0.20, 0.62, 0.35}, kBar{0.25, 0.25, 0.30};

// One of the two views: right and up axes on the picture.
struct View {
  double left, scale;
  Vec3 center;
  bool fromSide;

  std::array<double, 2> operator()(Vec3 p) const {
    const double across = fromSide ? p.y - center.y : p.x - center.x;
    return {left + across * scale, kHeight / 2.0 + 20 - (p.z - center.z) * scale};
  }
  std::vector<std::array<double, 2>> line(const std::vector<Vec3>& points) const {
    std::vector<std::array<double, 2>> projected;
    for (const Vec3& p : points) projected.push_back((*this)(p));
    return projected;
  }
};

void drawCage(Canvas& canvas, const View& view, const RibCage& cage, const Plan* plan) {
  // Far things first: the ribs by their depth.
  std::vector<const RibCurve*> ribs;
  for (const RibCurve& rib : cage.ribs) ribs.push_back(&rib);
  if (view.fromSide)
    std::stable_sort(ribs.begin(), ribs.end(), [](const RibCurve* a, const RibCurve* b) { return a->side == Side::right && b->side == Side::left; });
  for (const RibCurve* rib : ribs) {
    const auto line = view.line(rib->curve.sample(80));
    canvas.polyline(line, false, kWhite, 8);
    canvas.polyline(line, false, kBone, 5);
    if (!view.fromSide || rib->side == Side::left) {
      const auto& at = line[line.size() * 6 / 10];
      canvas.text(at[0], at[1] - 5, fmt::format("{}{}", rib->side == Side::right ? "R" : "L", rib->number), 12, kInk, 0.5);
    }
  }
  for (const auto& contour : cage.anatomy->sternum.contours) canvas.polyline(view.line(contour), true, kSternum, 1);
  for (const Cartilage& c : cage.cartilages) canvas.polyline(view.line(c.curve.sample(30)), false, kCartilage, 3.5);
  if (!plan) return;
  for (const MovedCartilage& c : plan->frames.back()) canvas.polyline(view.line(c.curve.sample(30)), false, kAfter, 2);
  for (const auto& contour : cage.anatomy->sternum.contours) {
    std::vector<Vec3> moved;
    for (const Vec3& p : contour) moved.push_back(plan->motion(p));
    canvas.polyline(view.line(moved), true, kAfter, 1);
  }
  canvas.polyline(view.line(plan->bar.centerline), false, kBar, 4);
}

}  // namespace

Canvas cagePicture(const RibCage& cage, const Plan* plan) {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (const RibCurve& rib : cage.ribs)
    for (const Vec3& p : rib.curve.sample(40))
      for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  Canvas canvas(kWidth, kHeight, kWhite);
  if (cage.ribs.empty()) return canvas;
  const double scale = std::min({(kHeight - 150) / std::max(1.0, high.z - low.z), 560 / std::max(1.0, high.x - low.x), 460 / std::max(1.0, high.y - low.y)});
  const Vec3 center = (low + high) / 2;
  drawCage(canvas, {310, scale, center, false}, cage, plan);
  drawCage(canvas, {880, scale, center, true}, cage, plan);
  canvas.text(310, 40, "From the front (patient's right on the left)", 16, kInk, 0.5);
  canvas.text(880, 40, "From the patient's left (front on the left)", 16, kInk, 0.5);
  double at = 60;
  for (const auto& [name, color] : {std::pair<const char*, Color>{"ribs", kBone}, {"cartilages", kCartilage}, {"sternum", kSternum}, {"after the operation", kAfter}, {"bar", kBar}}) {
    canvas.rectangle(at, kHeight - 34, 14, 14, color);
    canvas.text(at + 20, kHeight - 22, name, 13, kInk);
    at += 150;
  }
  return canvas;
}

}  // namespace pectora
