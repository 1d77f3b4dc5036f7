#include "plugins/splines/cartilage/cage.h"

#include "plugins/splines/cartilage/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr int kLastTrueRib = 7, kLastFalseRib = 10;

const Notch* findNotch(const Sternum& sternum, Side side, int rib) {
  for (const Notch& notch : sternum.notches)
    if (notch.side == side && notch.rib == rib) return &notch;
  return nullptr;
}

const Cartilage* findCartilage(const RibCage& cage, Side side, int rib) {
  for (const Cartilage& c : cage.cartilages)
    if (c.side == side && c.rib == rib) return &c;
  return nullptr;
}

// A cartilage reaches the sternum from the side; the lower it sits, the more steeply it comes up from below.
Vec3 arrivalDirection(Side side, int rib) {
  const double steep = std::clamp((rib - 2) * 14.0, 0.0, 70.0) * M_PI / 180;
  const double medial = side == Side::right ? 1 : -1;
  return {medial * std::cos(steep), -0.1, std::sin(steep)};
}

}  // namespace

RibCage buildCage(std::shared_ptr<const Anatomy> anatomy, const CageSettings& settings, std::vector<std::string>& warnings) {
  RibCage cage;
  cage.anatomy = anatomy;
  for (const Rib& rib : anatomy->ribs) {
    if (rib.centerline.size() < 4) continue;
    RibCurve curve{rib.side, rib.number, {}, 0};
    const int controls = int(std::lround(polylineLength(rib.centerline) / settings.controlSpacing)) + 3;
    curve.curve = fitCurve(rib.centerline, std::max(4, controls));
    curve.rmsError = rmsDistance(curve.curve, rib.centerline);
    cage.ribs.push_back(std::move(curve));
  }

  std::string missing;
  for (int number = 1; number <= kLastFalseRib; ++number) {
    for (Side side : {Side::right, Side::left}) {
      const Rib* rib = anatomy->rib(side, number);
      const auto leaveOut = [&] { missing += fmt::format("{}{} {}", missing.empty() ? "" : ", ", sideName(side), number); };
      if (!rib || !rib->reachesJunction || rib->centerline.size() < 4) {
        leaveOut();
        continue;
      }
      const RibCurve* ribCurve = nullptr;
      for (const RibCurve& r : cage.ribs)
        if (r.side == side && r.number == number) ribCurve = &r;
      const Vec3 start = ribCurve->curve.at(1), along = normalized(ribCurve->curve.derivative(1));

      Cartilage cartilage{side, number, {}, 0, 0};
      if (number <= kLastTrueRib) {
        const Notch* notch = findNotch(anatomy->sternum, side, number);
        if (!notch) {
          leaveOut();
          continue;
        }
        const Vec3 arrival = normalized(arrivalDirection(side, number));
        cartilage.curve = hermiteCurve(start, along, notch->position, arrival, settings.handle);
      } else {
        const Cartilage* above = findCartilage(cage, side, number - 1);
        if (!above) {
          leaveOut();
          continue;
        }
        cartilage.joins = number - 1;
        cartilage.joinsAt = 0.5;
        const Vec3 end = above->curve.at(cartilage.joinsAt);
        cartilage.curve = hermiteCurve(start, along, end, normalized(above->curve.derivative(cartilage.joinsAt)),
                                       settings.handle);
      }
      cage.cartilages.push_back(std::move(cartilage));
    }
  }
  if (!missing.empty())
    warnings.push_back("no cartilage was built for rib " + missing + ": its junction, or what it joins, was not found");
  return cage;
}

}  // namespace pectora
