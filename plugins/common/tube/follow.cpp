#include "plugins/common/tube/follow.h"

#include "kernel/value/curve.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pectora {
namespace {

constexpr double kRingMm = 3;                          // around the section, what must not look like it
constexpr double kHoldMm = 1.5;                          // of partial volume before air
constexpr double kAlongMm = 2.5, kAcrossMm = 0.8;      // smoothing of the values
constexpr int kMostHighSteps = 2, kMostThinSteps = 2;  // sideways, from section to section

std::vector<float> gaussian(double sigma) {
  const int radius = int(std::ceil(2.5 * sigma));
  std::vector<float> kernel;
  float sum = 0;
  for (int i = -radius; i <= radius; ++i) sum += kernel.emplace_back(float(std::exp(-0.5 * i * i / std::max(1e-9, sigma * sigma))));
  for (float& k : kernel) k /= sum;
  return kernel;
}

// The sections' values, `high` fastest.
struct Stack {
  int wide = 0, tall = 0, count = 0;
  std::vector<float> value;
  float* row(int section, int j) { return &value[(std::size_t(section) * tall + j) * wide]; }
  const float* row(int section, int j) const { return &value[(std::size_t(section) * tall + j) * wide]; }
};

// One pass of a Gaussian along one axis of the stack; the ends are repeated.
void smooth(Stack& stack, int axis, double sigma) {
  const std::vector<float> kernel = gaussian(sigma);
  const int radius = int(kernel.size()) / 2, size[3] = {stack.wide, stack.tall, stack.count};
  if (radius == 0) return;
  const std::size_t stride[3] = {1, std::size_t(stack.wide), std::size_t(stack.wide) * stack.tall};
  const int other[2] = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
  std::vector<float> line(size[axis]);
  for (int b = 0; b < size[other[1]]; ++b)
    for (int a = 0; a < size[other[0]]; ++a) {
      float* first = &stack.value[a * stride[other[0]] + b * stride[other[1]]];
      for (int n = 0; n < size[axis]; ++n) line[n] = first[n * stride[axis]];
      for (int n = 0; n < size[axis]; ++n) {
        float sum = 0;
        for (int t = -radius; t <= radius; ++t) sum += kernel[t + radius] * line[std::clamp(n + t, 0, size[axis] - 1)];
        first[n * stride[axis]] = sum;
      }
    }
}

// Undoes the partial volume next to air along the thin axis, from the middle outwards: what lies within `hold` steps before the
// air takes the value from before that, and the air the value that it counts as.
void holdToAir(Stack& stack, const TubeTissue& tissue, int hold) {
  const int middle = stack.tall / 2;
  for (int n = 0; n < stack.count; ++n)
    for (int i = 0; i < stack.wide; ++i)
      for (int way : {-1, 1}) {
        int air = middle;
        while (air >= 0 && air < stack.tall && stack.row(n, air)[i] >= tissue.airBelow) air += way;
        const int before = air - way * (hold + 1);
        const float held = (before - middle) * way >= 0 ? stack.row(n, before)[i] : stack.row(n, middle)[i];
        for (int j = air - way; (j - middle) * way >= 0 && (air - j) * way <= hold && air >= 0 && air < stack.tall; j -= way) stack.row(n, j)[i] = held;
        for (int j = air; j >= 0 && j < stack.tall; j += way) stack.row(n, j)[i] = tissue.airAs;
      }
}

// The template: weights with sum 1 inside the ellipse and sum 1 in the ring around it, soft at the edge.
struct Template {
  int halfWide, halfTall;
  std::vector<float> inside, around;
};
int halfCells(double halfMm, double stepMm) { return int(std::ceil((halfMm + kRingMm) / stepMm)); }
Template ellipse(const TubeSection& s, double stepMm) {
  Template t;
  t.halfWide = halfCells(s.halfHighMm, stepMm);
  t.halfTall = halfCells(s.halfThinMm, stepMm);
  float inside = 0, around = 0;
  for (int j = -t.halfTall; j <= t.halfTall; ++j)
    for (int i = -t.halfWide; i <= t.halfWide; ++i) {
      const double x = i * stepMm, y = j * stepMm, a = s.halfHighMm, b = s.halfThinMm;
      const double k = std::hypot(x / a, y / b), slope = std::hypot(x / (a * a), y / (b * b));
      const double outside = slope > 1e-9 ? k * (k - 1) / slope : -b;   // first-order distance to the ellipse
      t.inside.push_back(float(std::clamp(0.5 - outside / stepMm, 0.0, 1.0)));
      t.around.push_back(float(std::clamp(0.5 + outside / stepMm, 0.0, 1.0) * std::clamp(0.5 - (outside - kRingMm) / stepMm, 0.0, 1.0)));
      inside += t.inside.back(), around += t.around.back();
    }
  for (float& w : t.inside) w /= inside;
  for (float& w : t.around) w /= around;
  return t;
}

// Where the greatest of three values in a row would lie, from the middle one: the vertex of the parabola.
double vertex(double before, double here, double after) {
  const double bend = before - 2 * here + after;
  return bend < -1e-9 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

}  // namespace

std::vector<TubeSection> sectionsAlong(std::span<const Vec3> line, double stepMm, const std::function<Vec3(Vec3)>& thinAt) {
  const int count = std::max(2, int(std::lround(polylineLength(line) / stepMm)) + 1);
  const std::vector<Vec3> points = resamplePolyline(line, count);
  std::vector<TubeSection> sections;
  for (int i = 0; i < count; ++i) {
    TubeSection s;
    s.centre = points[i];
    s.along = normalized(points[std::min(i + 2, count - 1)] - points[std::max(i - 2, 0)]);
    const Vec3 thin = thinAt(points[i]);
    s.thin = normalized(thin - s.along * dot(thin, s.along));
    s.high = cross(s.along, s.thin);
    sections.push_back(s);
  }
  return sections;
}

FollowedTube followTube(std::span<const TubeSection> sections, const std::function<float(Vec3)>& valueAt,
                        const TubeTissue& tissue, std::span<const TubeNeighbour> neighbours, const TubeSearch& search) {
  const double h = search.stepMm;
  double high = 0, thin = 0;
  for (const TubeSection& s : sections) high = std::max(high, s.halfHighMm), thin = std::max(thin, s.halfThinMm);
  const int reachHigh = int(std::lround(search.rangeHighMm / h)), reachThin = int(std::lround(search.rangeThinMm / h));
  const int halfWide = reachHigh + halfCells(high, h), halfTall = reachThin + halfCells(thin, h), count = int(sections.size());

  // The straightened, smoothed values.
  Stack inside{2 * halfWide + 1, 2 * halfTall + 1, count, {}};
  inside.value.resize(std::size_t(inside.wide) * inside.tall * count);
  const auto position = [&](int n, double i, double j) { return sections[n].centre + sections[n].high * (i * h) + sections[n].thin * (j * h); };
  for (int n = 0; n < count; ++n)
    for (int j = -halfTall; j <= halfTall; ++j)
      for (int i = -halfWide; i <= halfWide; ++i) inside.row(n, j + halfTall)[i + halfWide] = valueAt(position(n, i, j));
  if (tissue.airBelow > -1e8f) holdToAir(inside, tissue, int(std::lround(kHoldMm / h)));
  const double spacing = distance(sections[0].centre, sections[1].centre);
  smooth(inside, 0, kAcrossMm / h);
  smooth(inside, 1, kAcrossMm / h);
  smooth(inside, 2, kAlongMm / std::max(0.1, spacing));
  Stack around = inside;
  for (float& v : inside.value) v = tissue.inside(v);
  for (float& v : around.value) v = tissue.around(v);

  // What belongs to neighbours.
  const double farthest = std::hypot(halfWide, halfTall) * h;
  for (const TubeNeighbour& neighbour : neighbours)
    for (int n = 0; n < count; ++n) {
      std::vector<Vec3> near;
      for (const Vec3& p : neighbour.line)
        if (distance(p, sections[n].centre) < farthest + neighbour.radiusMm) near.push_back(p);
      for (int j = -halfTall; j <= halfTall && !near.empty(); ++j)
        for (int i = -halfWide; i <= halfWide; ++i) {
          const Vec3 p = position(n, i, j);
          const auto isIn = [&](Vec3 q) { return dot(p - q, p - q) < neighbour.radiusMm * neighbour.radiusMm; };
          if (std::none_of(near.begin(), near.end(), isIn)) continue;
          inside.row(n, j + halfTall)[i + halfWide] = around.row(n, j + halfTall)[i + halfWide] = 0;
        }
    }

  // Score of every place of every section.
  const int wide = 2 * reachHigh + 1, tall = 2 * reachThin + 1, places = wide * tall;
  std::vector<float> score(std::size_t(count) * places), filling(score.size());
  for (int n = 0; n < count; ++n) {
    const Template shape = ellipse(sections[n], h);
    const int span = 2 * shape.halfWide + 1, below = halfTall - reachThin - shape.halfTall, aside = halfWide - reachHigh - shape.halfWide;
    for (int j = 0; j < tall; ++j)
      for (int i = 0; i < wide; ++i) {
        float full = 0, ring = 0;
        for (int v = 0; v < 2 * shape.halfTall + 1; ++v) {
          const float *in = inside.row(n, j + v + below) + i + aside, *out = around.row(n, j + v + below) + i + aside;
          const float *wIn = &shape.inside[std::size_t(v) * span], *wOut = &shape.around[std::size_t(v) * span];
          for (int u = 0; u < span; ++u) full += wIn[u] * in[u], ring += wOut[u] * out[u];
        }
        filling[std::size_t(n) * places + j * wide + i] = full;
        score[std::size_t(n) * places + j * wide + i] = full - ring;
      }
  }

  // The best way (Viterbi 1967).
  constexpr float kNever = -1e30f;
  std::vector<float> best(places, kNever), next(places);
  std::vector<std::int16_t> from(std::size_t(count) * places, -1);
  for (int j = 0; j < tall; ++j)
    for (int i = 0; i < wide; ++i)
      if (std::hypot(i - reachHigh, j - reachThin) * h <= search.startRangeMm + 1e-9) best[j * wide + i] = score[j * wide + i];
  for (int n = 1; n < count; ++n) {
    for (int j = 0; j < tall; ++j)
      for (int i = 0; i < wide; ++i) {
        float most = kNever;
        int before = -1;
        for (int y = std::max(0, j - kMostThinSteps); y <= std::min(tall - 1, j + kMostThinSteps); ++y)
          for (int x = std::max(0, i - kMostHighSteps); x <= std::min(wide - 1, i + kMostHighSteps); ++x) {
            const float aside = float(search.stiffness * h * h * ((x - i) * (x - i) + (y - j) * (y - j)));
            if (best[y * wide + x] - aside > most) most = best[y * wide + x] - aside, before = y * wide + x;
          }
        from[std::size_t(n) * places + j * wide + i] = std::int16_t(before);
        next[j * wide + i] = most <= kNever / 2 ? kNever : most + score[std::size_t(n) * places + j * wide + i];
      }
    best.swap(next);
  }
  int place = -1;
  float most = kNever;
  for (int p = 0; p < places; ++p) {
    const double x = (p % wide - reachHigh) * h, y = (p / wide - reachThin) * h;
    const float value = best[p] - float(search.endPull * (x * x + y * y));
    if (place < 0 || value > most) most = value, place = p;
  }

  // Back to the start, with the places between the grid's.
  FollowedTube tube;
  tube.line.resize(count), tube.inside.resize(count), tube.score.resize(count);
  for (int n = count - 1; n >= 0; --n) {
    const int i = place % wide, j = place / wide;
    const float* s = &score[std::size_t(n) * places];
    const double u = i > 0 && i + 1 < wide ? vertex(s[place - 1], s[place], s[place + 1]) : 0;
    const double v = j > 0 && j + 1 < tall ? vertex(s[place - wide], s[place], s[place + wide]) : 0;
    tube.line[n] = position(n, i - reachHigh + u, j - reachThin + v);
    tube.inside[n] = filling[std::size_t(n) * places + place];
    tube.score[n] = s[place];
    place = from[std::size_t(n) * places + place];
  }
  return tube;
}

}  // namespace pectora
