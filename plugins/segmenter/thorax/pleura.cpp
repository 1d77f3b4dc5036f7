#include "plugins/segmenter/thorax/pleura.h"

#include "plugins/segmenter/thorax/cartilage_wall.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora::thorax {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kRayStepMm = 0.7;
constexpr double kNeckMm = 45;        // of a rib, from the vertebra to where it joins the wall
constexpr double kBonyStiffness = 0.5, kStiffness = 0.02;
constexpr double kBoneWeight = 0.1;   // of a bony sample beside a sample of lung
constexpr double kArcMm = 110 * PolarGrid::kStepDeg * kRadians;   // between rays at a usual radius
constexpr int kCartilageRounds = 3;
constexpr double kAloneMm = 25, kAloneFactor = 4;   // where no bone or cartilage is so near, lung may lie so many times deeper

/// Polar coordinates of a point about a slice's pole: angle index and radius.
std::pair<double, double> polarOf(const PolarGrid& grid, int slice, Point2 p) {
  const double dx = p.x - grid.poleX[slice], dy = grid.poleY - p.y;
  const double index = std::atan2(dx, dy) / kRadians / PolarGrid::kStepDeg + PolarGrid::kAngles / 2;
  return {index, std::hypot(dx, dy)};
}

/// Distance from a point to a polyline.
double distanceTo(const std::vector<Point2>& line, Point2 p) {
  double nearest = 1e300;
  for (std::size_t n = 0; n + 1 < line.size(); ++n) {
    const Point2 a = line[n], d{line[n + 1].x - a.x, line[n + 1].y - a.y};
    const double length = d.x * d.x + d.y * d.y;
    const double t = length > 0 ? std::clamp(((p.x - a.x) * d.x + (p.y - a.y) * d.y) / length, 0.0, 1.0) : 0;
    nearest = std::min(nearest, std::hypot(a.x + t * d.x - p.x, a.y + t * d.y - p.y));
  }
  return nearest;
}

/// Where no sample is within kAloneMm, around the chest and along it: indices as in findPleura.
std::vector<char> farFrom(const std::vector<WallSample>& samples, int firstSlice, int slices, double sliceSpacing) {
  constexpr int angles = PolarGrid::kAngles, reach = int(kAloneMm / kArcMm);
  const int rows = int(kAloneMm / sliceSpacing);
  std::vector<char> isFar(std::size_t(slices) * angles, 1);
  for (const WallSample& sample : samples) {
    const int s = int(std::lround(sample.slice)) - firstSlice, n = int(std::lround(sample.angleIndex));
    for (int t = std::max(0, s - rows); t <= std::min(slices - 1, s + rows); ++t)
      for (int m = std::max(0, n - reach); m <= std::min(angles - 1, n + reach); ++m) isFar[std::size_t(t) * angles + m] = 0;
  }
  return isFar;
}

}  // namespace

Point2 PolarGrid::at(int slice, double angle, double radius) const {
  return {poleX[slice] + radius * std::sin(angle * kRadians), poleY - radius * std::cos(angle * kRadians)};
}

std::vector<double> outlineRadii(const Loop& outline, const PolarGrid& grid, int slice) {
  std::vector<double> radius(PolarGrid::kAngles, -1);
  const Point2 pole{grid.poleX[slice], grid.poleY};
  for (std::size_t n = 0; n < outline.size(); ++n) {
    const Point2 a = outline[n], b = outline[(n + 1) % outline.size()];
    const double ia = polarOf(grid, slice, a).first, ib = polarOf(grid, slice, b).first;
    // An edge that jumps across the back is not looked at.
    if (std::abs(ia - ib) > PolarGrid::kAngles / 2) continue;
    for (int i = std::max(0, int(std::ceil(std::min(ia, ib)))); i <= std::min<double>(PolarGrid::kAngles - 1, std::max(ia, ib)); ++i) {
      const double s = std::sin(PolarGrid::degrees(i) * kRadians), c = -std::cos(PolarGrid::degrees(i) * kRadians);
      const Point2 e{b.x - a.x, b.y - a.y};
      const double denominator = s * e.y - c * e.x;
      if (std::abs(denominator) < 1e-12) continue;
      const double r = ((a.x - pole.x) * e.y - (a.y - pole.y) * e.x) / denominator;
      if (r > 0 && (radius[i] < 0 || r < radius[i])) radius[i] = r;
    }
  }
  return radius;
}

std::vector<double> lungRadii(const Field& field, const Body& body, const PolarGrid& grid, int slice,
                              const std::vector<double>& skinRadius, double levelHu) {
  std::vector<double> radius(PolarGrid::kAngles, -1);
  const double z = slice * body.spacing.z;
  for (int n = 0; n < PolarGrid::kAngles; ++n) {
    float before = 0;
    for (double r = skinRadius[n] - 3; r > 10; r -= kRayStepMm) {
      const Point2 p = grid.at(slice, PolarGrid::degrees(n), r);
      const float value = field.at({p.x, p.y, z});
      if (value < levelHu && before >= levelHu) {
        const Point2 inside = grid.at(slice, PolarGrid::degrees(n), r - 2.5);
        const auto [i, j, k] = body.nearest({inside.x, inside.y, z});
        if (body.isLung(i, j, k)) {
          radius[n] = r + kRayStepMm * (levelHu - value) / (before - value);
          break;
        }
      }
      before = value;
    }
  }
  return radius;
}

std::vector<WallSample> ribWall(const std::vector<FoundRib>& ribs, const Field& field, const PolarGrid& grid, double boneHu, double offsetMm) {
  std::vector<WallSample> samples;
  const double sliceSpacing = field.spacing().z;
  for (const FoundRib& rib : ribs)
    for (const Vec3& p : rib.body.line) {
      const double slice = p.z / sliceSpacing;
      const int k = std::clamp(int(std::lround(slice)), 0, int(grid.poleX.size()) - 1);
      const auto [index, r] = polarOf(grid, k, {p.x, p.y});
      if (index < 0 || index > PolarGrid::kAngles - 1) continue;
      if (rib.body.reachesVertebra && distance(p, rib.body.line.front()) < kNeckMm) continue;
      // Inwards from the centreline to where the bone ends.
      const double angle = (index - PolarGrid::kAngles / 2) * PolarGrid::kStepDeg;
      float before = field.at(p);
      bool wasInBone = before >= boneHu;
      for (double t = 0.4; t < 14; t += 0.4) {
        const Point2 q = grid.at(k, angle, r - t);
        const float value = field.at({q.x, q.y, p.z});
        wasInBone = wasInBone || value >= boneHu;
        // The marrow is not the end: soft tissue must follow for 2 mm.
        const Point2 ahead = grid.at(k, angle, r - t - 2);
        if (wasInBone && value < boneHu && before >= boneHu && field.at({ahead.x, ahead.y, p.z}) < boneHu) {
          const double end = t - 0.4 * (boneHu - value) / (before - value);
          samples.push_back({index, slice, r - end - offsetMm, 1});
          break;
        }
        before = value;
      }
    }
  return samples;
}

std::vector<WallSample> sternumWall(const std::vector<SternumSlice>& sternum, const PolarGrid& grid, double offsetMm) {
  std::vector<WallSample> samples;
  for (const SternumSlice& s : sternum) {
    const std::vector<double> near = outlineRadii(s.contour, grid, s.slice);
    for (int n = 0; n < PolarGrid::kAngles; ++n)
      if (near[n] > 0) samples.push_back({double(n), double(s.slice), near[n] - offsetMm, 1});
  }
  return samples;
}

std::vector<double> lungBehindRibs(const std::vector<WallSample>& ribs, const std::vector<std::vector<double>>& lung, int firstSlice,
                                   double sliceSpacing) {
  constexpr int angles = PolarGrid::kAngles;
  const int slices = int(lung.size());
  // Where both are known: the gap, and that it is known.
  std::vector<float> gap(std::size_t(slices) * angles, 0), known(gap.size(), 0);
  for (const WallSample& sample : ribs) {
    const int s = int(std::lround(sample.slice)) - firstSlice, n = int(std::lround(sample.angleIndex));
    if (s < 0 || s >= slices || n < 0 || n >= angles || lung[s][n] <= 0) continue;
    gap[std::size_t(s) * angles + n] += float(sample.radius - lung[s][n]);
    known[std::size_t(s) * angles + n] += 1;
  }
  const auto blurred = [&](const std::vector<float>& from, double sigmaMm) {
    Plane plane(angles, slices);
    plane.value = from;
    // Nothing lies beyond the border: a frame of zeros as wide as the Gaussian would be repeated outwards.
    const int frame = int(std::ceil(3 * sigmaMm / std::min(kArcMm, sliceSpacing)));
    Plane framed(angles + 2 * frame, slices + 2 * frame);
    for (int s = 0; s < slices; ++s) std::copy_n(&from[std::size_t(s) * angles], angles, &framed.at(frame, s + frame));
    smooth(framed, sigmaMm / kArcMm, sigmaMm / sliceSpacing);
    for (int s = 0; s < slices; ++s) std::copy_n(&framed.at(frame, s + frame), angles, &plane.at(0, s));
    return plane.value;
  };
  std::vector<double> behind(gap.size(), 0);
  for (double sigma : {60.0, 20.0}) {
    const std::vector<float> sum = blurred(gap, sigma), weight = blurred(known, sigma);
    for (std::size_t i = 0; i < behind.size(); ++i)
      if (weight[i] > 1e-4f) behind[i] = double(sum[i]) / double(weight[i]);
  }
  return behind;
}

std::vector<double> findPleura(const Field& field, const Body& body, const PolarGrid& grid,
                               const std::vector<FoundRib>& ribs, const std::vector<SternumSlice>& sternum,
                               const std::vector<SkinSlice>& skin, int firstSlice, double boneHu,
                               const PleuraSettings& settings, const std::function<void(double)>& step) {
  constexpr int angles = PolarGrid::kAngles;
  const int slices = int(skin.size());
  std::vector<std::vector<double>> outside(slices), lung(slices);
  parallelFor(slices, [&](std::size_t s) {
    outside[s] = outlineRadii(skin[s].whole, grid, firstSlice + int(s));
    lung[s] = lungRadii(field, body, grid, firstSlice + int(s), outside[s], settings.lungLevelHu);
  });
  if (step) step(0.3);

  std::vector<WallSample> bony = ribWall(ribs, field, grid, boneHu, settings.offsetMm);
  const std::vector<double> behind = lungBehindRibs(bony, lung, firstSlice, body.spacing.z);
  const std::vector<WallSample> sternal = sternumWall(sternum, grid, settings.offsetMm);
  bony.insert(bony.end(), sternal.begin(), sternal.end());
  std::erase_if(bony, [&](const WallSample& b) { return b.slice < firstSlice - 0.5 || b.slice > firstSlice + slices - 0.5; });
  std::vector<WallSample> all;
  for (int s = 0; s < slices; ++s)
    for (int n = 0; n < angles; ++n)
      if (lung[s][n] > 0) all.push_back({double(n), double(firstSlice + s), lung[s][n], 1});
  // Without any bone the lungs alone must do; without lungs a quarter of the way from the skin to the pole.
  std::vector<WallSample> reference = bony.size() >= 50 ? bony : all;
  if (reference.empty())
    for (int s = 0; s < slices; ++s)
      for (int n = 0; n < angles; ++n)
        if (outside[s][n] > 0) reference.push_back({double(n), double(firstSlice + s), 0.75 * outside[s][n], 1});
  if (reference.empty()) return std::vector<double>(std::size_t(slices) * angles, 0.0);
  // The surface of the bones, and again with the cartilages that it leads to, which lead further into a narrow pit.
  const auto fitReference = [&](const UsualWall& usual) { return fitWall(reference, usual, firstSlice, firstSlice + slices - 1, body.spacing.z, kBonyStiffness); };
  UsualWall usual = usualWall(reference, all, outside, firstSlice, body.spacing.z);
  std::vector<double> radius = fitReference(usual);
  const std::size_t bones = bony.size(), known = reference.size();
  const std::vector<char> isFarFromBone = farFrom(bony, firstSlice, slices, body.spacing.z);
  for (int round = 0; round < kCartilageRounds; ++round) {
    const std::vector<WallSample> cartilages = cartilageWall(field, grid, outside, lung, sternal, radius, isFarFromBone, firstSlice, settings.deepestMm);
    bony.resize(bones), reference.resize(known);
    bony.insert(bony.end(), cartilages.begin(), cartilages.end());
    reference.insert(reference.end(), cartilages.begin(), cartilages.end());
    usual = usualWall(reference, all, outside, firstSlice, body.spacing.z);
    radius = fitReference(usual);
  }
  const std::vector<double> bonySurface = radius;
  const std::vector<char> isAlone = farFrom(bony, firstSlice, slices, body.spacing.z);
  for (int round = 0; round < 5; ++round) {
    if (step) step(0.4 + 0.1 * round);
    std::vector<WallSample> samples;
    std::vector<char> hasLung(std::size_t(slices) * angles, 0);
    for (const WallSample& sample : all) {
      const std::size_t at = std::size_t(sample.slice - firstSlice) * angles + std::size_t(sample.angleIndex);
      // Lung behind an effusion lies ever further in: the rounds may not follow it.
      const double deepest = settings.deepestMm * (isAlone[at] ? kAloneFactor : 1);
      if ((behind[at] > settings.effusionMm && !isAlone[at]) || sample.radius < radius[at] - deepest || sample.radius < bonySurface[at] - 2 * deepest) continue;
      samples.push_back(sample);
      hasLung[at] = 1;
    }
    for (WallSample sample : bony) {
      const int s = std::clamp(int(std::lround(sample.slice)) - firstSlice, 0, slices - 1);
      if (hasLung[std::size_t(s) * angles + std::size_t(std::lround(sample.angleIndex))]) sample.weight = kBoneWeight;
      samples.push_back(sample);
    }
    if (samples.empty()) break;
    radius = fitWall(samples, usual, firstSlice, firstSlice + slices - 1, body.spacing.z, kStiffness);
  }
  if (step) step(0.9);

  // Never nearer to the skin than the least thickness.
  parallelFor(slices, [&](std::size_t s) {
    for (int n = 0; n < angles; ++n) {
      double& r = radius[s * angles + n];
      if (outside[s][n] > 0) r = std::min(r, outside[s][n] - settings.leastThicknessMm);
      r = std::max(r, 1.0);
      for (int round = 0; round < 12 && outside[s][n] > 0 && r > 1; ++round) {
        const double gap = distanceTo(skin[s].whole, grid.at(firstSlice + int(s), PolarGrid::degrees(n), r));
        if (gap >= settings.leastThicknessMm - 0.05) break;
        r = std::max(1.0, r - (settings.leastThicknessMm - gap));
      }
    }
  });
  return radius;
}

}  // namespace pectora::thorax
