#include "plugins/segmenter/thorax/outline.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pectora::thorax {
namespace {

// Edges of the cell whose upper left corner is pixel (i, j): 0 top, 1 right, 2 bottom, 3 left.
// For each of the 16 cases the directed segments (to edge, from edge), inside on the right of travel with y down.
struct Segments {
  int count;
  std::array<std::array<int, 2>, 2> edge;
};
// Case bits: 1 upper left, 2 upper right, 4 lower right, 8 lower left.
constexpr Segments kCases[16] = {
    {0, {}},
    {1, {{{3, 0}, {}}}}, {1, {{{0, 1}, {}}}}, {1, {{{3, 1}, {}}}}, {1, {{{1, 2}, {}}}},
    {2, {{{3, 0}, {1, 2}}}},  // saddle, corners apart
    {1, {{{0, 2}, {}}}}, {1, {{{3, 2}, {}}}}, {1, {{{2, 3}, {}}}}, {1, {{{2, 0}, {}}}},
    {2, {{{0, 1}, {2, 3}}}},  // saddle, corners apart
    {1, {{{2, 1}, {}}}}, {1, {{{1, 3}, {}}}}, {1, {{{1, 0}, {}}}}, {1, {{{0, 3}, {}}}},
    {0, {}}};
constexpr Segments kJoined5 = {2, {{{3, 2}, {1, 0}}}};
constexpr Segments kJoined10 = {2, {{{0, 3}, {2, 1}}}};

}  // namespace

std::vector<Loop> isoContours(const Plane& plane, float level) {
  // A frame one pixel wide far below the level closes every contour.
  const int w = plane.width + 2, h = plane.height + 2;
  const auto value = [&](int i, int j) {
    const bool isFrame = i == 0 || j == 0 || i == w - 1 || j == h - 1;
    return isFrame ? level - 1e6f : plane.at(i - 1, j - 1) - level;
  };
  // Every grid edge has an id: horizontal ones 2n, vertical ones 2n + 1, n the pixel at their upper left end.
  const auto edgeId = [&](int i, int j, int side) -> std::int64_t {
    switch (side) {
      case 0: return 2 * (std::int64_t(j) * w + i);
      case 1: return 2 * (std::int64_t(j) * w + i + 1) + 1;
      case 2: return 2 * (std::int64_t(j + 1) * w + i);
      default: return 2 * (std::int64_t(j) * w + i) + 1;
    }
  };
  const auto crossing = [&](std::int64_t id) -> Point2 {
    const int n = int(id / 2), i = n % w, j = n / w;
    const bool isVertical = id % 2;
    const float a = value(i, j), b = isVertical ? value(i, j + 1) : value(i + 1, j);
    const double t = double(a) / (double(a) - double(b));
    return isVertical ? Point2{i - 1.0, j - 1 + t} : Point2{i - 1 + t, j - 1.0};
  };

  // The directed segments, sorted by the edge where they begin; an edge begins at most one segment.
  struct Link {
    std::int64_t from, to;
  };
  std::vector<Link> links;
  for (int j = 0; j + 1 < h; ++j) {
    unsigned left = (value(0, j) >= 0) | (value(0, j + 1) >= 0) << 3;
    for (int i = 0; i + 1 < w; ++i) {
      const unsigned upper = value(i + 1, j) >= 0, lower = value(i + 1, j + 1) >= 0;
      const unsigned bits = left | upper << 1 | lower << 2;
      left = upper | lower << 3;
      if (bits == 0 || bits == 15) continue;
      const Segments* segments = &kCases[bits];
      if (bits == 5 || bits == 10) {
        const float mean = value(i, j) + value(i + 1, j) + value(i, j + 1) + value(i + 1, j + 1);
        if (mean >= 0) segments = bits == 5 ? &kJoined5 : &kJoined10;
      }
      for (int s = 0; s < segments->count; ++s)
        links.push_back({edgeId(i, j, segments->edge[s][1]), edgeId(i, j, segments->edge[s][0])});
    }
  }
  std::sort(links.begin(), links.end(), [](Link a, Link b) { return a.from < b.from; });

  std::vector<Loop> loops;
  std::vector<char> used(links.size(), 0);
  for (std::size_t start = 0; start < links.size(); ++start) {
    if (used[start]) continue;
    Loop loop;
    std::size_t n = start;
    while (n < links.size() && !used[n]) {
      used[n] = 1;
      loop.push_back(crossing(links[n].from));
      const auto next = std::lower_bound(links.begin(), links.end(), links[n].to,
                                         [](Link a, std::int64_t id) { return a.from < id; });
      n = std::size_t(next - links.begin());
    }
    if (loop.size() >= 3) loops.push_back(std::move(loop));
  }
  return loops;
}

Shape shapeOf(const Loop& loop) {
  Shape shape;
  if (loop.size() < 3) return shape;
  // Moments about a point of the contour, so that no digits are lost far from the origin.
  const Point2 base = loop.front();
  double m[4][4] = {};
  constexpr double kNode = 0.7745966692414834;  // three-point Gauss: exact to degree 5, we need 4
  for (std::size_t n = 0; n < loop.size(); ++n) {
    const Point2 a = loop[n], b = loop[(n + 1) % loop.size()];
    const double dy = b.y - a.y;
    for (int g = -1; g <= 1; ++g) {
      const double t = 0.5 + 0.5 * kNode * g, weight = (g == 0 ? 8.0 : 5.0) / 18 * dy;
      const double x = a.x + t * (b.x - a.x) - base.x, y = a.y + t * (b.y - a.y) - base.y;
      double xp = x;
      for (int p = 0; p <= 3; ++p, xp *= x) {
        double yq = weight;
        for (int q = 0; p + q <= 3; ++q, yq *= y) m[p][q] += xp / (p + 1) * yq;
      }
    }
  }
  shape.area = m[0][0];
  if (std::abs(shape.area) < 1e-12) return {};
  const double cx = m[1][0] / m[0][0], cy = m[0][1] / m[0][0];
  shape.centroid = {base.x + cx, base.y + cy};

  // Central moments, the same for both directions of travel.
  const double sign = shape.area < 0 ? -1 : 1, area = std::abs(shape.area);
  const double m20 = sign * (m[2][0] - cx * m[1][0]), m02 = sign * (m[0][2] - cy * m[0][1]);
  const double m11 = sign * (m[1][1] - cx * m[0][1]);
  const double m30 = sign * (m[3][0] - 3 * cx * m[2][0] + 2 * cx * cx * m[1][0]);
  const double m03 = sign * (m[0][3] - 3 * cy * m[0][2] + 2 * cy * cy * m[0][1]);
  const double m21 = sign * (m[2][1] - 2 * cx * m[1][1] - cy * m[2][0] + 2 * cx * cx * m[0][1]);
  const double m12 = sign * (m[1][2] - 2 * cy * m[1][1] - cx * m[0][2] + 2 * cy * cy * m[1][0]);

  const double mean = 0.5 * (m20 + m02), half = std::hypot(0.5 * (m20 - m02), m11);
  shape.spreadMajor = std::sqrt(std::max(0.0, (mean + half) / area));
  shape.spreadMinor = std::sqrt(std::max(0.0, (mean - half) / area));
  shape.angle = 0.5 * std::atan2(2 * m11, m20 - m02);

  const double n2 = area * area, n3 = n2 * std::sqrt(area);
  const double e20 = m20 / n2, e02 = m02 / n2, e11 = m11 / n2;
  const double e30 = m30 / n3, e03 = m03 / n3, e21 = m21 / n3, e12 = m12 / n3;
  const double a = e30 + e12, b = e21 + e03, c = e30 - 3 * e12, d = 3 * e21 - e03;
  shape.hu = {e20 + e02,
              (e20 - e02) * (e20 - e02) + 4 * e11 * e11,
              c * c + d * d,
              a * a + b * b,
              c * a * (a * a - 3 * b * b) + d * b * (3 * a * a - b * b),
              (e20 - e02) * (a * a - b * b) + 4 * e11 * a * b,
              d * a * (a * a - 3 * b * b) - c * b * (3 * a * a - b * b)};
  return shape;
}

double rmsDistance(const Loop& a, const Loop& b) {
  const auto sum = [](const Loop& from, const Loop& to) {
    double total = 0;
    for (const Point2& p : from) {
      double nearest = 1e300;
      for (const Point2& q : to) nearest = std::min(nearest, (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y));
      total += nearest;
    }
    return total;
  };
  return std::sqrt((sum(a, b) + sum(b, a)) / double(a.size() + b.size()));
}

Column columnAt(const Loop& loop, double x) {
  Column column;
  for (std::size_t n = 0; n < loop.size(); ++n) {
    const Point2 a = loop[n], b = loop[(n + 1) % loop.size()];
    if ((a.x > x) == (b.x > x)) continue;
    const double y = a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
    column.front = std::min(column.front, y), column.back = std::max(column.back, y);
  }
  return column;
}

Sides sidesOf(const Loop& loop) {
  const auto [right, left] = std::minmax_element(loop.begin(), loop.end(), [](Point2 a, Point2 b) { return a.x < b.x; });
  return {right->x, left->x};
}

bool isInside(const Loop& loop, Point2 p) {
  bool inside = false;
  for (std::size_t n = 0, last = loop.size() - 1; n < loop.size(); last = n++) {
    const Point2 a = loop[n], b = loop[last];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

}  // namespace pectora::thorax
