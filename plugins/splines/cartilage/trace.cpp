#include "plugins/splines/cartilage/trace.h"

#include "plugins/common/tube/follow.h"
#include "plugins/splines/cartilage/fit.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr double kHalfHighMm = 7, kHalfThinMm = 5, kUsualWidthMm = 235;   // of a cartilage, and of the chest that has it
constexpr double kRibHalfHighMm = 6.5, kRibHalfThinMm = 3.5, kWidenedAt = 0.3;          // where it begins, and the part of its length to where it is wide
constexpr double kCoreWide = 0.93, kCoreNear = 0.6;   // part of a neighbour's half height that nothing else can be in
constexpr double kMuscleBelow = 45;                                       // HU under cartilage
constexpr double kStepMm = 2;
constexpr int kControls = 7;
constexpr double kUsualJoint = 0.6;    // part of the upper cartilage's length at which a lower one has become one with it

// Trilinear value; air outside.
float valueAt(const Volume& ct, Vec3 p) {
  const Vec3 v = ct.grid.toVoxel(p);
  const int i = int(std::floor(v.x)), j = int(std::floor(v.y)), k = int(std::floor(v.z));
  const auto& n = ct.grid.size;
  if (i < 0 || j < 0 || k < 0 || i + 1 >= n[0] || j + 1 >= n[1] || k + 1 >= n[2]) return -1000;
  const float x = float(v.x - i), y = float(v.y - j), z = float(v.z - k);
  const std::int16_t* at = &ct.hu[ct.grid.index(i, j, k)];
  const std::size_t down = std::size_t(n[0]), up = ct.grid.sliceVoxels();
  const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
  const float low = mix(mix(at[0], at[1], x), mix(at[down], at[down + 1], x), y);
  const float high = mix(mix(at[up], at[up + 1], x), mix(at[up + down], at[up + down + 1], x), y);
  return mix(low, high, z);
}

TubeTissue cartilageTissue(double cartilageHu) {
  const float muscle = float(cartilageHu - kMuscleBelow), span = float(kMuscleBelow);
  const auto ramp = [](float hu, float from, float to) { return std::clamp((hu - from) / (to - from), 0.0f, 1.0f); };
  TubeTissue tissue;
  // Calcified cartilage may lie inside. Bone around it is rib or sternum and says nothing; fat says little more than muscle.
  tissue.inside = [=](float hu) { return std::clamp((hu - muscle) / span, -0.25f, 1.0f) - 0.6f * ramp(hu, 220, 450); };
  tissue.around = [=](float hu) { return std::clamp((hu - muscle) / span, -0.25f, 1.0f) * (1 - ramp(hu, 180, 300)); };
  tissue.airBelow = -385, tissue.airAs = muscle;
  return tissue;
}

// Direction out of the wall: from the middle of the pleura nearby (weights of a Gaussian of 8 mm) to the point.
class WallNormal {
 public:
  explicit WallNormal(const std::vector<LayerSlice>& pleura) : pleura_(pleura) {}
  Vec3 operator()(Vec3 p) const {
    constexpr double reach = 20, sigma = 8;
    const auto below = [](const LayerSlice& s, double z) { return s.z < z; };
    Vec3 sum{};
    double weights = 0;
    for (auto slice = std::lower_bound(pleura_.begin(), pleura_.end(), p.z - reach, below); slice != pleura_.end() && slice->z < p.z + reach; ++slice)
      for (const Vec3& q : slice->points) {
        const double square = dot(p - q, p - q);
        if (square > reach * reach) continue;
        const double weight = std::exp(-square / (2 * sigma * sigma));
        sum += q * weight, weights += weight;
      }
    const Vec3 out = weights > 0 ? p - sum / weights : Vec3{0, -1, 0};
    return norm(out) > 1 ? out : Vec3{0, -1, 0};
  }

 private:
  const std::vector<LayerSlice>& pleura_;
};

double chestScale(const std::vector<LayerSlice>& pleura) {
  double widest = 0;
  for (const LayerSlice& s : pleura)
    if (!s.points.empty() && !s.clipped) {
      const auto [right, left] = std::minmax_element(s.points.begin(), s.points.end(), [](Vec3 a, Vec3 b) { return a.x < b.x; });
      widest = std::max(widest, left->x - right->x);
    }
  return widest > 0 ? std::clamp(widest / kUsualWidthMm, 0.6, 1.3) : 1;
}

std::vector<Vec3> smoothed(const std::vector<Vec3>& line) {
  return fitCurve(line, kControls).sample(std::max(10, int(polylineLength(line) / kStepMm)));
}

}  // namespace

void traceCartilages(const Volume& ct, const Anatomy& anatomy, std::vector<Course>& courses, const TraceSettings& settings,
                     const std::function<void()>& poll) {
  const double scale = chestScale(anatomy.pleura);
  const WallNormal normal(anatomy.pleura);
  const TubeTissue tissue = cartilageTissue(settings.cartilageHu);
  // Lung and bone are held to levels as far from cartilage as its own contrast, or smoothing would eat into it.
  const float lowest = float(settings.cartilageHu - 4 * kMuscleBelow), highest = float(settings.cartilageHu + 6 * kMuscleBelow);
  const auto value = [&](Vec3 p) {
    const float hu = valueAt(ct, p);
    return hu < tissue.airBelow ? hu : std::clamp(hu, lowest, highest);
  };
  const auto upperOf = [&](const Course& c) -> const Course* {
    for (const Course& other : courses)
      if (c.joins > 0 && other.side == c.side && other.rib == c.joins) return &other;
    return nullptr;
  };
  // The other cartilages of that side, but those that it joins or that join it.
  const auto neighboursOf = [&](const Course& c, const std::vector<Course>& all, double part) {
    std::vector<TubeNeighbour> near;
    for (const Course& other : all)
      if (other.side == c.side && other.rib != c.rib && other.joins != c.rib && c.joins != other.rib) near.push_back({other.line, part * kHalfHighMm * scale});
    return near;
  };
  const auto follow = [&](Course& c, double high, double thin, double step, double stiffness, const std::vector<TubeNeighbour>& neighbours, bool joinsUpper) {
    TubeSearch search;
    search.rangeHighMm = high, search.rangeThinMm = thin, search.stepMm = step, search.stiffness = stiffness;
    search.startRangeMm = 1.5, search.endPull = c.isEndGiven || joinsUpper ? 1 : 0.02;
    std::vector<TubeSection> sections = sectionsAlong(c.line, kStepMm, normal);
    for (std::size_t n = 0; n < sections.size(); ++n) {
      const double widened = std::min(1.0, double(n) / double(sections.size() - 1) / kWidenedAt);
      sections[n].halfHighMm = scale * std::lerp(kRibHalfHighMm, kHalfHighMm, widened);
      sections[n].halfThinMm = scale * std::lerp(kRibHalfThinMm, kHalfThinMm, widened);
    }
    const FollowedTube tube = followTube(sections, value, tissue, neighbours, search);
    double sum = 0;
    for (double s : tube.score) sum += s;
    c.likeness = sum / double(tube.score.size());
    c.line = smoothed(tube.line);
  };

  // A lower one's way ends within the upper one.
  const auto endOn = [&](Course& c, const Course& upper) {
    const std::size_t end = std::size_t(kUsualJoint * double(upper.line.size() - 1)), some = std::min<std::size_t>(end, 4);
    while (c.line.size() > 4 && distance(c.line.back(), upper.line[end]) < 12 * scale) c.line.pop_back();
    for (std::size_t i = end - some; i <= end; i += std::max<std::size_t>(1, some)) c.line.push_back(upper.line[i]);
    c.line = smoothed(c.line);
  };
  // Wide, from above downwards; both sides at once.
  parallelFor(2, [&](std::size_t half) {
    for (Course& c : courses) {
      if (c.side != (half ? Side::left : Side::right)) continue;
      const Course* upper = upperOf(c);
      if (upper) endOn(c, *upper);
      const auto neighbours = neighboursOf(c, courses, kCoreWide);
      const double range = 3 * scale + 0.09 * polylineLength(c.line);
      follow(c, range, 0.6 * range, 1, 0.1, neighbours, upper != nullptr);
      follow(c, 8 * scale, 6 * scale, 1, 0.05, neighbours, upper != nullptr);
    }
  });
  poll();
  // Closely, with all the others as neighbours.
  for (int round = 0; round < 2; ++round) {
    for (Course& c : courses)
      if (const Course* upper = upperOf(c)) endOn(c, *upper);
    const std::vector<Course> before = courses;
    parallelFor(courses.size(), [&](std::size_t n) {
      follow(courses[n], 5 * scale, 4 * scale, 0.75, 0.03, neighboursOf(before[n], before, kCoreNear), upperOf(courses[n]) != nullptr);
    });
    poll();
  }
}

}  // namespace pectora
