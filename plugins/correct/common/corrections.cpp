#include "plugins/correct/common/corrections.h"

#include "kernel/stage/error.h"
#include "kernel/value/curve.h"
#include "kernel/value/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr double kFarthestJunctionMm = 60;
constexpr double kStepMm = 2;   // of centrelines

// The point of a line that is nearest, and its distance.
std::pair<std::size_t, double> nearestOn(const std::vector<Vec3>& line, Vec3 p) {
  std::size_t best = 0;
  for (std::size_t n = 1; n < line.size(); ++n)
    if (distance(line[n], p) < distance(line[best], p)) best = n;
  return {best, line.empty() ? INFINITY : distance(line[best], p)};
}

// Index of the chosen rib.
std::size_t find(const Anatomy& anatomy, const RibChoice& choice) {
  std::size_t best = anatomy.ribs.size();
  double least = INFINITY;
  for (std::size_t n = 0; n < anatomy.ribs.size(); ++n) {
    const Rib& rib = anatomy.ribs[n];
    if (rib.side != choice.side) continue;
    if (!choice.near && rib.number == choice.number && choice.number > 0) return n;
    if (!choice.near) continue;
    if (const double d = nearestOn(rib.centerline, *choice.near).second; d < least) least = d, best = n;
  }
  if (best == anatomy.ribs.size())
    throw Error("there is no such rib")
        .of("number")
        .given(fmt::format("{} {}", sideName(choice.side), choice.number))
        .allowed(ribsThereAre(anatomy))
        .advise("A rib without a number is named by a point near to it: near = { x, y, z }");
  return best;
}

// The level nearest to z in a list of slices.
template <class List, class Height>
auto levelAt(List& list, double z, Height height) {
  return std::min_element(list.begin(), list.end(), [&](const auto& a, const auto& b) { return std::abs(height(a) - z) < std::abs(height(b) - z); });
}

}  // namespace

Side sideOf(const std::string& word) {
  if (word == "right") return Side::right;
  if (word == "left") return Side::left;
  throw Error("there is no such side").of("side").given(word).allowed("right, left");
}

std::string ribsThereAre(const Anatomy& anatomy) {
  std::string text;
  for (Side side : {Side::right, Side::left}) {
    std::string numbers;
    int without = 0;
    for (const Rib& rib : anatomy.ribs) {
      if (rib.side != side) continue;
      if (rib.number == 0) ++without;
      else numbers += fmt::format("{}{}", numbers.empty() ? " " : ", ", rib.number);
    }
    if (numbers.empty() && without == 0) continue;
    text += fmt::format("{}{}{}", text.empty() ? "" : "; ", sideName(side), numbers);
    if (without > 0) text += fmt::format("{}{} without a number", numbers.empty() ? " " : " and ", without);
  }
  return text.empty() ? "the anatomy holds no ribs" : text;
}

Anatomy dropRib(const Anatomy& anatomy, const RibChoice& rib) {
  Anatomy changed = anatomy;
  const auto dropped = changed.ribs.begin() + std::ptrdiff_t(find(anatomy, rib));
  // Its outlines in the slices, too; those of ribs without a number cannot be told from each other.
  std::erase_if(changed.contours, [&](const SliceContour& c) { return c.structure == "rib" && c.side == dropped->side && c.number == dropped->number && c.number > 0; });
  changed.ribs.erase(dropped);
  return changed;
}

Anatomy renumberRib(const Anatomy& anatomy, const RibChoice& rib, int number) {
  const std::size_t index = find(anatomy, rib);
  const Rib* taken = anatomy.rib(rib.side, number);
  if (number < 1 || number > 12) throw Error("a rib's number is 1 to 12").of("as").given(std::to_string(number)).allowed("1 to 12");
  if (taken && taken != &anatomy.ribs[index])
    throw Error("that number is taken").of("as").given(fmt::format("{} {}", sideName(rib.side), number)).advise("Drop or renumber that rib first");
  Anatomy changed = anatomy;
  const int old = changed.ribs[index].number;
  changed.ribs[index].number = number;
  for (SliceContour& contour : changed.contours)
    if (old > 0 && contour.structure == "rib" && contour.side == rib.side && contour.number == old) contour.number = number;
  std::stable_sort(changed.ribs.begin(), changed.ribs.end(), [](const Rib& a, const Rib& b) {
    const auto place = [](const Rib& r) { return r.number ? r.number : 99; };
    return place(a) != place(b) ? place(a) < place(b) : a.side < b.side;
  });
  return changed;
}

Anatomy moveJunction(const Anatomy& anatomy, const RibChoice& choice, Vec3 to) {
  Anatomy changed = anatomy;
  Rib& rib = changed.ribs[find(anatomy, choice)];
  const auto [nearest, off] = nearestOn(rib.centerline, to);
  if (off > kFarthestJunctionMm)
    throw Error("the point does not lie on that rib")
        .of("at")
        .given(fmt::format("{:.0f} mm from it", off))
        .allowed(fmt::format("up to {:.0f} mm", kFarthestJunctionMm))
        .advise("Positions are LPS mm; is it the right rib and the right side?");
  rib.centerline.resize(nearest + 1);
  if (rib.centerline.size() > 1 && off < kStepMm) rib.centerline.pop_back();
  for (double done = kStepMm; done < off; done += kStepMm) rib.centerline.push_back(rib.centerline[nearest] + normalized(to - rib.centerline[nearest]) * done);
  rib.centerline.push_back(to);
  rib.reachesJunction = true;
  return changed;
}

Anatomy moveNotch(const Anatomy& anatomy, Side side, int rib, Vec3 to) {
  if (rib < 1 || rib > 7) throw Error("only the cartilages of ribs 1 to 7 join the sternum").of("number").given(std::to_string(rib)).allowed("1 to 7");
  Anatomy changed = anatomy;
  for (Notch& notch : changed.sternum.notches)
    if (notch.side == side && notch.rib == rib) {
      notch.position = to, notch.isGiven = true;
      return changed;
    }
  changed.sternum.notches.push_back({side, rib, to, true});
  return changed;
}

Anatomy giveContour(const Anatomy& anatomy, const std::string& structure, double z, const std::vector<Vec3>& points) {
  if (points.size() < 3) throw Error("a contour needs three points or more").of("points").given(std::to_string(points.size()) + " points");
  Anatomy changed = anatomy;
  std::vector<LayerSlice>* layer = structure == "skin" ? &changed.skin : structure == "pleura" ? &changed.pleura : nullptr;
  if (!layer && structure != "sternum") throw Error("a contour can be given for three structures").of("structure").given(structure).allowed("skin, pleura, sternum");
  const double spacing = anatomy.skin.size() > 1 ? std::abs(anatomy.skin[1].z - anatomy.skin[0].z) : 5;
  const auto refuse = [&](double nearest) {
    throw Error("the anatomy has no " + structure + " at that level")
        .of("z").given(fmt::format("{:.1f} mm", z)).allowed(fmt::format("within {:.1f} mm of a level; the nearest is at {:.1f} mm", 1.5 * spacing, nearest));
  };

  // Into the layer, or the stack of the sternum's contours with its axis.
  double level = z;
  std::vector<Vec3> placed = points;
  const auto onLevel = [&] {
    for (Vec3& p : placed) p.z = level;
  };
  if (layer) {
    const auto slice = levelAt(*layer, z, [](const LayerSlice& s) { return s.z; });
    if (slice == layer->end() || std::abs(slice->z - z) > 1.5 * spacing) refuse(slice == layer->end() ? NAN : slice->z);
    level = slice->z;
    onLevel();
    slice->points = placed, slice->clipped = false;
  } else {
    auto& contours = changed.sternum.contours;
    std::erase_if(contours, [](const auto& c) { return c.empty(); });
    const auto contour = levelAt(contours, z, [](const std::vector<Vec3>& c) { return c.front().z; });
    if (contour == contours.end() || std::abs(contour->front().z - z) > 1.5 * spacing) refuse(contour == contours.end() ? NAN : contour->front().z);
    level = contour->front().z;
    onLevel();
    *contour = placed;
    const auto axis = levelAt(changed.sternum.axis, level, [](Vec3 p) { return p.z; });
    Vec3 middle{};
    for (const Vec3& p : placed) middle += p / double(placed.size());
    if (axis != changed.sternum.axis.end() && std::abs(axis->z - level) < spacing) *axis = middle;
  }

  // Into the outlines for pictures, and the lengths of that level.
  const auto isThere = [&](const SliceContour& c) { return c.structure == structure && !c.points.empty() && std::abs(c.points.front().z - level) < 0.5 * spacing; };
  for (SliceContour& c : changed.contours)
    if (isThere(c)) c.points = placed;
  const auto metrics = levelAt(changed.metrics, level, [](const LevelMetrics& m) { return m.z; });
  const auto vertebra = levelAt(changed.vertebralFront, level, [](Vec3 p) { return p.z; });
  if (metrics == changed.metrics.end() || std::abs(metrics->z - level) > 0.5 * spacing || vertebra == changed.vertebralFront.end()) return changed;
  if (structure == "sternum") {
    const LevelMetrics now = measureLevel(level, placed, *vertebra, {}, changed.turnDeg);
    metrics->sternumToVertebra = now.sternumToVertebra, metrics->eccentricity = now.eccentricity, metrics->torsionDeg = now.torsionDeg;
  } else if (structure == "pleura") {
    const LevelMetrics now = measureLevel(level, {}, *vertebra, placed, changed.turnDeg);
    metrics->transverse = now.transverse, metrics->deepestInnerWall = now.deepestInnerWall;
    metrics->rightDepth = now.rightDepth, metrics->leftDepth = now.leftDepth;
  } else {
    LevelMetrics before = *metrics;
    const auto old = levelAt(anatomy.skin, level, [](const LayerSlice& s) { return s.z; });
    measureSkin(before, old->points, *vertebra, changed.turnDeg, metrics->externalWidth, 0);
    const double backDepth = metrics->externalFront - before.externalFront;
    measureSkin(*metrics, placed, *vertebra, changed.turnDeg, metrics->externalWidth, backDepth);
  }
  return changed;
}

}  // namespace pectora
