#include "plugins/comparer/anatomy/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pectora {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kStep = 2;          // mm between the points that a truth line is measured at
constexpr double kSameRib = 12;      // RMS, mm, up to which a rib of that number is the same rib
constexpr int kJudgedRibs = 10;

std::vector<Vec3> stepped(const std::vector<Vec3>& line) {
  return resamplePolyline(line, std::max(2, int(polylineLength(line) / kStep)));
}

// Mean of squares from a truth line to a found one.
double meanSquare(const std::vector<Vec3>& truth, const std::vector<Vec3>& found) {
  const std::vector<Vec3> points = stepped(truth);
  double sum = 0;
  for (const Vec3& p : points) {
    const double d = distanceToPolyline(p, found);
    sum += d * d;
  }
  return sum / double(points.size());
}

// Whether p lies within the sternum: in the closed contour of the nearest level, at most half a slice of 5 mm away.
bool isInSternum(const Sternum& sternum, Vec3 p) {
  const std::vector<Vec3>* nearest = nullptr;
  for (const std::vector<Vec3>& contour : sternum.contours)
    if (contour.size() > 2 && std::abs(contour.front().z - p.z) < (nearest ? std::abs(nearest->front().z - p.z) : 2.6)) nearest = &contour;
  return nearest && isInContour(*nearest, p);
}

// The part of a cartilage before it enters the sternum: what lies within is bone.
std::vector<Vec3> beforeSternum(const std::vector<Vec3>& line, const Sternum& sternum) {
  std::vector<Vec3> part = stepped(line);
  while (part.size() > 2 && isInSternum(sternum, part.back())) part.pop_back();
  return part;
}

// RMS over several lines, each counted by its length, and the worst single one.
struct LineErrors {
  double sum = 0, weight = 0, worst = 0;
  void add(double square, double length) {
    sum += square * length;
    weight += length;
    worst = std::max(worst, std::sqrt(square));
  }
  double rms() const { return weight > 0 ? std::sqrt(sum / weight) : kNone; }
};

// Mean absolute distance from the truth's lines to the found ones of the same level.
double layerError(const std::vector<LayerSlice>& truth, const std::vector<LayerSlice>& found, double low, double high) {
  if (found.size() < 2) return kNone;
  const double spacing = std::abs(found[1].z - found[0].z);
  double sum = 0;
  std::size_t count = 0;
  for (const LayerSlice& t : truth) {
    if (t.z < low || t.z > high || t.points.size() < 2) continue;
    const auto nearest = std::min_element(found.begin(), found.end(), [&](const LayerSlice& a, const LayerSlice& b) { return std::abs(a.z - t.z) < std::abs(b.z - t.z); });
    if (std::abs(nearest->z - t.z) > 0.51 * spacing || nearest->clipped || nearest->points.size() < 2) continue;
    // The ends lie on each one's own coronal plane: the outer tenth of the truth is left out.
    const std::vector<Vec3> points = stepped(t.points);
    for (std::size_t i = points.size() / 10; i < points.size() * 9 / 10; ++i) {
      Vec3 p = points[i];
      p.z = nearest->points.front().z;
      sum += distanceToPolyline(p, nearest->points);
      ++count;
    }
  }
  return count > 0 ? sum / double(count) : kNone;
}

double sternumError(const Sternum& truth, const Sternum& found) {
  double sum = 0;
  std::size_t count = 0;
  for (const auto& contour : truth.contours) {
    if (contour.empty()) continue;
    // The found contour of the nearest level, closed.
    const std::vector<Vec3>* nearest = nullptr;
    for (const auto& other : found.contours)
      if (!other.empty() && (!nearest || std::abs(other.front().z - contour.front().z) < std::abs(nearest->front().z - contour.front().z))) nearest = &other;
    if (!nearest || std::abs(nearest->front().z - contour.front().z) > 5) continue;
    std::vector<Vec3> closed = *nearest;
    closed.push_back(closed.front());
    for (Vec3 p : contour) {
      p.z = closed.front().z;
      sum += distanceToPolyline(p, closed);
      ++count;
    }
  }
  return count > 0 ? sum / double(count) : kNone;
}

}  // namespace

double distanceToPolyline(Vec3 p, const std::vector<Vec3>& line) {
  double best = line.size() == 1 ? distance(p, line[0]) : std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec3 d = line[i] - line[i - 1];
    const double squared = dot(d, d);
    const double t = squared > 0 ? std::clamp(dot(p - line[i - 1], d) / squared, 0.0, 1.0) : 0;
    best = std::min(best, distance(p, line[i - 1] + d * t));
  }
  return best;
}

std::vector<Fact> judgeAnatomy(const Anatomy& found, const RibCage* cage, const Truth& truth) {
  const Anatomy& exact = *truth.anatomy;
  int numbered = 0;
  LineErrors ribs;
  for (const Rib& rib : exact.ribs) {
    if (rib.number > kJudgedRibs || rib.centerline.size() < 2) continue;
    const Rib* match = found.rib(rib.side, rib.number);
    if (!match || match->centerline.size() < 2) continue;
    const double square = meanSquare(rib.centerline, match->centerline);
    if (std::sqrt(square) > kSameRib) continue;
    ++numbered;
    ribs.add(square, polylineLength(rib.centerline));
  }

  int cartilagesFound = 0;
  LineErrors cartilages;
  for (const CartilageLine& line : truth.cartilages) {
    if (!cage || line.centerline.size() < 2) continue;
    for (const Cartilage& c : cage->cartilages) {
      if (c.side != line.side || c.rib != line.rib) continue;
      ++cartilagesFound;
      const std::vector<Vec3> visible = beforeSternum(line.centerline, exact.sternum);
      cartilages.add(meanSquare(visible, c.curve.sample(60)), polylineLength(visible));
    }
  }

  const LevelMetrics* level = found.deepestLevel();
  const double low = exact.sternum.xiphisternalJoint.z, high = exact.sternum.jugularNotch.z, all = std::numeric_limits<double>::infinity();
  return {{"ribs_rightly_numbered", double(numbered), ""},
          {"rib_rms", ribs.rms(), "mm"},
          {"rib_rms_worst", ribs.worst, "mm"},
          {"cartilages_found", double(cartilagesFound), ""},
          {"cartilage_rms", cartilages.rms(), "mm"},
          {"cartilage_rms_worst", cartilages.worst, "mm"},
          {"sternum_mean", sternumError(exact.sternum, found.sternum), "mm"},
          {"torsion_error", found.sternum.torsionDeg - exact.sternum.torsionDeg, "deg"},
          {"skin_mean_absolute", layerError(exact.skin, found.skin, -all, all), "mm"},
          {"pleura_mean_absolute", layerError(exact.pleura, found.pleura, low, high), "mm"},
          {"haller_error", level ? level->haller() - truth.hallerIndex : kNone, ""},
          {"correction_index_error", level ? level->correctionIndex() - truth.correctionIndex : kNone, "%"}};
}

}  // namespace pectora
