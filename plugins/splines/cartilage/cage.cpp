#include "plugins/splines/cartilage/cage.h"

#include "plugins/splines/cartilage/fit.h"
#include "plugins/splines/cartilage/joint_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pectora {
namespace {

constexpr int kControls = 8, kSamples = 40;   // of a cartilage
constexpr double kGuessedJoin = 0.6;             // where a false rib's cartilage joins the one above, if it cannot be seen
constexpr double kLeastLikeness = 0.25;          // of a fitted cartilage: halfway to muscle, with some room for noise
constexpr double kMostGrowth = 1.3;              // of a fitted cartilage over the guess: more is a loop
constexpr int kFirstSteps = 12, kStepsForEach = 6, kLastSteps = 8;   // of fitting: those of the sternum, one more, all
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

// y of the front of a layer's slice at x: the most forward crossing; NaN beyond its ends.
double frontAt(const LayerSlice& slice, double x) {
  double front = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 1; i < slice.points.size(); ++i) {
    const Vec3 a = slice.points[i - 1], b = slice.points[i];
    if ((a.x <= x) == (b.x <= x)) continue;
    const double y = std::lerp(a.y, b.y, (x - a.x) / (b.x - a.x));
    if (!(front <= y)) front = y;
  }
  return front;
}

// y of the pleura's front at x and z; NaN outside of the layer.
double pleuraFront(const std::vector<LayerSlice>& pleura, double x, double z) {
  const auto above = std::lower_bound(pleura.begin(), pleura.end(), z, [](const LayerSlice& s, double level) { return s.z < level; });
  if (above == pleura.begin() || above == pleura.end()) return std::numeric_limits<double>::quiet_NaN();
  const LayerSlice &high = *above, &low = *(above - 1);
  return std::lerp(frontAt(low, x), frontAt(high, x), (z - low.z) / (high.z - low.z));
}

// The cubic's course seen from the front, with the depth of the pleura where that is known all along.
Curve alongPleura(const Curve& cubic, const std::vector<LayerSlice>& pleura) {
  std::vector<Vec3> points = cubic.sample(kSamples);
  std::vector<double> depth;
  for (const Vec3& p : points) depth.push_back(pleuraFront(pleura, p.x, p.z));
  const bool isKnown = std::all_of(depth.begin(), depth.end(), [](double d) { return std::isfinite(d); });
  if (isKnown) {
    const double first = points.front().y - depth.front(), last = points.back().y - depth.back();
    for (int i = 0; i < kSamples; ++i) points[i].y = depth[i] + std::lerp(first, last, double(i) / (kSamples - 1));
  }
  return fitCurve(points, kControls);
}

}  // namespace

RibCage buildCage(std::shared_ptr<const Anatomy> anatomy, const Volume* ct, const CageSettings& settings,
                  std::vector<std::string>& warnings, const std::function<void()>& poll) {
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

  // Every cartilage is guessed from its junction to its notch, or to the one above, and fitted where the CT shows it.
  std::string missing, guessed;
  const auto note = [](std::string& list, Side side, int number) { list += fmt::format("{}{} {}", list.empty() ? "" : ", ", sideName(side), number); };
  std::vector<Course> courses;
  std::vector<Curve> guesses;
  const auto isSeen = [&](std::size_t n) {
    return ct && courses[n].likeness > kLeastLikeness && polylineLength(courses[n].line) < kMostGrowth * guesses[n].length();
  };
  const auto fit = [&](int steps, bool isShapeFree) {
    poll();
    if (ct) fitJointly(*ct, *anatomy, courses, settings.cartilageHu, steps, isShapeFree);
  };
  const auto curveOf = [&](std::size_t n) { return isSeen(n) ? fitCurve(resamplePolyline(courses[n].line, kSamples), kControls) : guesses[n]; };
  for (int number = 1; number <= kLastFalseRib; ++number) {
    for (Side side : {Side::right, Side::left}) {
      const Rib* rib = anatomy->rib(side, number);
      const Notch* notch = number <= kLastTrueRib ? findNotch(anatomy->sternum, side, number) : nullptr;
      const auto above = std::find_if(courses.begin(), courses.end(), [&](const Course& c) { return number > kLastTrueRib && c.side == side && c.rib == number - 1; });
      if (!rib || !rib->reachesJunction || rib->centerline.size() < 4 || (!notch && above == courses.end())) {
        note(missing, side, number);
        continue;
      }
      const auto ribCurve = std::find_if(cage.ribs.begin(), cage.ribs.end(), [&](const RibCurve& r) { return r.side == side && r.number == number; });
      const Vec3 start = ribCurve->curve.at(1), along = normalized(ribCurve->curve.derivative(1));
      const Curve upper = notch ? Curve{} : curveOf(std::size_t(above - courses.begin()));
      const Vec3 end = notch ? notch->position : upper.at(kGuessedJoin);
      const Vec3 arrival = normalized(notch ? arrivalDirection(side, number) : upper.derivative(kGuessedJoin));
      guesses.push_back(alongPleura(hermiteCurve(start, along, end, arrival, settings.handle), anatomy->pleura));
      courses.push_back({.side = side, .rib = number, .joins = notch ? 0 : number - 1, .isEndGiven = notch && notch->isGiven,
                         .line = guesses.back().sample(kSamples), .end = end});
    }
    if (number == kLastTrueRib) fit(kFirstSteps, false);
    if (number > kLastTrueRib) fit(kStepsForEach, false);
  }
  fit(kLastSteps, true);
  for (std::size_t n = 0; n < courses.size(); ++n) {
    Course& c = courses[n];
    if (c.isEndGiven) c.line.back() = c.end;
    if (ct && !isSeen(n)) note(guessed, c.side, c.rib);
    Cartilage cartilage{c.side, c.rib, curveOf(n), c.joins, 0};
    if (c.joins > 0) {
      const Cartilage* upper = findCartilage(cage, c.side, c.joins);
      cartilage.joinsAt = upper->curve.closest(cartilage.curve.at(1));
    }
    cage.cartilages.push_back(std::move(cartilage));
  }
  if (!guessed.empty()) warnings.push_back("the cartilage cannot be seen in the CT, its course is a guess: " + guessed);
  if (!missing.empty())
    warnings.push_back("no cartilage was built for rib " + missing + ": its junction, or what it joins, was not found");
  return cage;
}

}  // namespace pectora
