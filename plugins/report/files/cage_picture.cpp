#include "plugins/report/files/cage_picture.h"

#include "plugins/report/files/solid_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr int kWidth = 1240, kHeight = 720, kTop = 56, kBottom = 44, kFrontWidth = 680;
constexpr Color kBone{0.93, 0.87, 0.72}, kCartilage{0.52, 0.72, 0.93}, kSternum{0.90, 0.55, 0.48}, kBar{0.45, 0.47, 0.52}, kBefore{0.15, 0.45, 0.25};
constexpr double kRibHigh = 6, kRibThin = 3.5, kCartilageHigh = 6, kCartilageThin = 4.5;   // half axes of what is drawn, mm

void drawView(Canvas& canvas, SolidView view, Seen from, const RibCage& cage, const Plan* plan, Vec3 middle) {
  // Solids: bone as it is, what the operation moves where it comes to lie.
  for (const RibCurve& rib : cage.ribs) view.draw(tubeMesh(rib.curve.sample(90), kRibHigh, kRibThin, middle), kBone);
  for (std::size_t n = 0; n < cage.cartilages.size(); ++n)
    view.draw(tubeMesh((plan ? plan->frames.back()[n].curve : cage.cartilages[n].curve).sample(40), kCartilageHigh, kCartilageThin, middle), kCartilage);
  std::vector<std::vector<Vec3>> outlines = cage.anatomy->sternum.contours;
  if (plan)
    for (auto& outline : outlines)
      for (Vec3& p : outline) p = plan->motion(p);
  view.draw(stackMesh(outlines), kSternum);
  if (plan)
    for (const Bar& bar : plan->bars) view.draw(tubeMesh(bar.centerline, bar.width / 2, std::max(2.0, bar.height / 2), middle), kBar);
  view.paint(canvas);

  // Where that was before, as lines; the ribs' numbers.
  const auto line = [&](const std::vector<Vec3>& points) {
    std::vector<std::array<double, 2>> projected;
    for (const Vec3& p : points) projected.push_back(view.at(p));
    return projected;
  };
  if (plan) {
    for (const Cartilage& c : cage.cartilages) canvas.polyline(line(c.curve.sample(30)), false, kBefore, 1.2);
    canvas.polyline(line(cage.anatomy->sternum.axis), false, kBefore, 1.6);
  }
  for (const RibCurve& rib : cage.ribs) {
    if (rib.number == 0 || (from == Seen::fromLeft && rib.side == Side::right)) continue;
    // Where the rib is farthest to its side, or in the middle of its visible course.
    const std::vector<Vec3> points = rib.curve.sample(60);
    const auto place = from == Seen::fromLeft ? points.begin() + 34
                                              : std::max_element(points.begin(), points.end(), [](Vec3 a, Vec3 b) { return std::abs(a.x) < std::abs(b.x); });
    const auto at = view.at(*place);
    const double aside = from == Seen::fromLeft ? 0 : rib.side == Side::right ? -16 : 16;
    canvas.text(at[0] + aside, at[1] + 4, fmt::format("{}", rib.number), 12, kInk, 0.5);
  }
}

}  // namespace

Canvas cagePicture(const RibCage& cage, const Plan* plan) {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  const auto hold = [&](const std::vector<Vec3>& points) {
    for (const Vec3& p : points)
      for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  };
  for (const RibCurve& rib : cage.ribs) hold(rib.curve.sample(40));
  for (const Cartilage& c : cage.cartilages) hold(c.curve.sample(20));
  for (const auto& outline : cage.anatomy->sternum.contours) hold(outline);
  Canvas canvas(kWidth, kHeight, kWhite);
  if (cage.ribs.empty()) return canvas;
  const int tall = kHeight - kTop - kBottom;
  const double scale = std::min({(tall - 30) / std::max(1.0, high.z - low.z), (kFrontWidth - 70) / std::max(1.0, high.x - low.x),
                                 (kWidth - kFrontWidth - 40) / std::max(1.0, high.y - low.y)});
  const Vec3 center = (low + high) / 2;
  drawView(canvas, {Seen::fromFront, 0, kTop, kFrontWidth, tall, center, scale}, Seen::fromFront, cage, plan, center);
  drawView(canvas, {Seen::fromLeft, kFrontWidth, kTop, kWidth - kFrontWidth, tall, center, scale}, Seen::fromLeft, cage, plan, center);
  canvas.text(kFrontWidth / 2.0, 34, "From the front (patient's right on the left)", 16, kInk, 0.5);
  canvas.text((kFrontWidth + kWidth) / 2.0, 34, "From the patient's left (front on the left)", 16, kInk, 0.5);

  struct Entry {
    const char* name;
    Color color;
    bool isShown;
  };
  double at = 40;
  for (const Entry& entry : {Entry{"ribs", kBone, true}, {"costal cartilages", kCartilage, true}, {"sternum", kSternum, true}, {"bar", kBar, plan != nullptr},
                             {"before the operation (cartilages, sternal axis)", kBefore, plan != nullptr}}) {
    if (!entry.isShown) continue;
    canvas.rectangle(at, kHeight - 32, 14, 14, entry.color);
    canvas.text(at + 20, kHeight - 20, entry.name, 13, kInk);
    at += 60 + 7.2 * double(std::string(entry.name).size());
  }
  return canvas;
}

}  // namespace pectora
