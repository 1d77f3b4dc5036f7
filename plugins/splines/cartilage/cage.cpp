#include "plugins/splines/cartilage/cage.h"

#include "plugins/splines/cartilage/courses.h"
#include "plugins/splines/cartilage/fit.h"

#include "kernel/physics/workers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

const Cartilage* findCartilage(const RibCage& cage, Side side, int rib) {
  for (const Cartilage& c : cage.cartilages)
    if (c.side == side && c.rib == rib) return &c;
  return nullptr;
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

  // Each side's cartilages by themselves.
  constexpr Side kSides[] = {Side::right, Side::left};
  const WallNormal wall(anatomy->pleura);
  SideCourses found[2];
  parallelFor(2, [&](std::size_t half) { found[half] = findCourses(kSides[half], cage.ribs, *anatomy, ct, wall, settings, poll); });

  // Rib by rib, right before left.
  std::string missing, cut, guessed;
  const auto note = [](std::string& list, Side side, int number) { list += fmt::format("{}{} {}", list.empty() ? "" : ", ", sideName(side), number); };
  for (int number = 1; number <= 10; ++number)
    for (int half = 0; half < 2; ++half) {
      const Side side = kSides[half];
      if (std::count(found[half].missing.begin(), found[half].missing.end(), number)) {
        const Rib* rib = anatomy->rib(side, number);
        note(rib && !rib->reachesJunction ? cut : missing, side, number);
      }
      for (const CartilageCourse& course : found[half].courses) {
        if (course.rib != number) continue;
        if (ct && !course.isSeen) note(guessed, side, number);
        Cartilage cartilage{side, number, course.curve, course.joins, 0};
        if (course.joins > 0) cartilage.joinsAt = findCartilage(cage, side, course.joins)->curve.closest(course.curve.at(1));
        cage.cartilages.push_back(std::move(cartilage));
      }
    }
  if (!guessed.empty()) warnings.push_back("the cartilage cannot be seen in the CT, its course is a guess: " + guessed);
  if (!cut.empty()) warnings.push_back("no cartilage was built for rib " + cut + ": its front end lies outside the CT");
  if (!missing.empty())
    warnings.push_back("no cartilage was built for rib " + missing + ": its junction, or what it joins, was not found");
  return cage;
}

}  // namespace pectora
