#include "plugins/segmenter/thorax/skin.h"

#include "plugins/segmenter/thorax/surface_metal.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr float kAirHu = -1000, kBrightestHu = 300;   // bone counts as no brighter
constexpr int kPaddingHu = -1500;    // below: outside the scanner's field of view
constexpr double kBorderPx = 1.6;

/// A slice on the body's box, air wherever the coarse torso (and a rim of two coarse pixels around it) is not.
Plane bodySlice(const Volume& ct, const Body& body, int slice) {
  const Box& box = body.box;
  const int f = body.factor, cw = body.size[0], ch = body.size[1], rim = 2;
  std::vector<std::uint8_t> wide(std::size_t(cw) * ch, 0), rows = wide;
  for (int j = 0; j < ch; ++j)
    for (int i = 0; i < cw; ++i)
      if (body.isTorso(i, j, slice))
        for (int d = std::max(0, i - rim); d <= std::min(cw - 1, i + rim); ++d) rows[std::size_t(j) * cw + d] = 1;
  for (int j = 0; j < ch; ++j)
    for (int d = std::max(0, j - rim); d <= std::min(ch - 1, j + rim); ++d)
      for (int i = 0; i < cw; ++i) wide[std::size_t(d) * cw + i] |= rows[std::size_t(j) * cw + i];
  Plane plane(box.size(0), box.size(1), kAirHu);
  for (int j = 0; j < plane.height; ++j)
    for (int i = 0; i < plane.width; ++i) {
      const int x = std::min(cw - 1, (i + box.low[0]) / f), y = std::min(ch - 1, (j + box.low[1]) / f);
      if (wide[std::size_t(y) * cw + x])
        plane.at(i, j) = std::max<float>(ct.at(i + box.low[0], j + box.low[1], slice), kAirHu);
    }
  return plane;
}

/// The torso's outline in the plane's pixels: the outer contour of largest area.
Loop torsoOutline(const Plane& plane, float level) {
  Loop best;
  double bestArea = 0;
  for (Loop& loop : isoContours(plane, level)) {
    const double area = shapeOf(loop).area;
    if (area > bestArea) bestArea = area, best = std::move(loop);
  }
  return best;
}

/// The paper's edge: first pixels above the gradient threshold seen along the columns from the front and along the rows
/// from both sides, in front of row `lastRow`, in the order of their angle around the point (middle, lastRow).
Loop firstEdgePixels(Plane plane, const Loop& torso, double lastRow, const SkinSettings& settings) {
  smooth(plane, settings.paperSigmaPx, settings.paperSigmaPx);
  const int w = plane.width, h = plane.height;
  Plane gradient(w, h);
  float greatest = 0;
  for (int j = 1; j + 1 < h; ++j)
    for (int i = 1; i + 1 < w; ++i) {
      const auto v = [&](int di, int dj) { return plane.at(i + di, j + dj); };
      const float gx = (v(1, -1) + 2 * v(1, 0) + v(1, 1)) - (v(-1, -1) + 2 * v(-1, 0) + v(-1, 1));
      const float gy = (v(-1, 1) + 2 * v(0, 1) + v(1, 1)) - (v(-1, -1) + 2 * v(0, -1) + v(1, -1));
      gradient.at(i, j) = std::hypot(gx, gy);
      greatest = std::max(greatest, gradient.at(i, j));
    }
  const float threshold = float(settings.paperThreshold) * greatest;
  double left = w, right = 0;
  for (const Point2& p : torso) left = std::min(left, p.x), right = std::max(right, p.x);
  const double middle = 0.5 * (left + right);
  const int last = std::clamp(int(lastRow), 0, h - 1);
  Loop found;
  for (int i = 0; i < w; ++i)
    for (int j = 0; j <= last; ++j)
      if (gradient.at(i, j) > threshold) {
        found.push_back({double(i), double(j)});
        break;
      }
  for (int j = 0; j <= last; ++j) {
    for (int i = 0; i < w; ++i)
      if (gradient.at(i, j) > threshold) {
        found.push_back({double(i), double(j)});
        break;
      }
    for (int i = w - 1; i >= 0; --i)
      if (gradient.at(i, j) > threshold) {
        found.push_back({double(i), double(j)});
        break;
      }
  }
  const auto angle = [&](Point2 p) { return std::atan2(p.x - middle, lastRow + 1 - p.y); };
  std::sort(found.begin(), found.end(), [&](Point2 a, Point2 b) { return angle(a) < angle(b); });
  found.erase(std::unique(found.begin(), found.end(), [](Point2 a, Point2 b) { return a.x == b.x && a.y == b.y; }), found.end());
  return found;
}

/// Whether a pixel of the CT lies at the border of what the scanner reconstructed.
bool isAtBorder(const Volume& ct, int slice, Point2 pixel) {
  const int w = ct.grid.size[0], h = ct.grid.size[1];
  if (pixel.x < kBorderPx || pixel.y < kBorderPx || pixel.x > w - 1 - kBorderPx || pixel.y > h - 1 - kBorderPx) return true;
  const int i = int(std::lround(pixel.x)), j = int(std::lround(pixel.y));
  for (int dj = -2; dj <= 2; ++dj)
    for (int di = -2; di <= 2; ++di) {
      const int x = std::clamp(i + di, 0, w - 1), y = std::clamp(j + dj, 0, h - 1);
      if (ct.at(x, y, slice) < kPaddingHu) return true;
    }
  return false;
}

}  // namespace

std::vector<Point2> frontOf(const Loop& outline, double coronalY) {
  struct Crossing {
    std::size_t after;  // the vertex before the crossing
    double x;
  };
  std::vector<Crossing> crossings;
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 a = outline[i], b = outline[(i + 1) % n];
    if ((a.y < coronalY) == (b.y < coronalY)) continue;
    crossings.push_back({i, a.x + (b.x - a.x) * (coronalY - a.y) / (b.y - a.y)});
  }
  if (crossings.size() < 2) return {};
  const auto byX = [](const Crossing& a, const Crossing& b) { return a.x < b.x; };
  const auto [right, left] = std::minmax_element(crossings.begin(), crossings.end(), byX);
  // One of the two ways around holds the most anterior point.
  const auto way = [&](const Crossing& from, const Crossing& to) {
    std::vector<Point2> line{{from.x, coronalY}};
    for (std::size_t i = (from.after + 1) % n;; i = (i + 1) % n) {
      line.push_back(outline[i]);
      if (i == to.after) break;
    }
    line.push_back({to.x, coronalY});
    return line;
  };
  std::vector<Point2> forward = way(*right, *left), backward = way(*left, *right);
  const auto mostAnterior = [](const std::vector<Point2>& line) {
    double y = 1e300;
    for (const Point2& p : line) y = std::min(y, p.y);
    return y;
  };
  if (mostAnterior(forward) <= mostAnterior(backward)) return forward;
  std::reverse(backward.begin(), backward.end());
  return backward;
}

SkinSlice findSkin(const Volume& ct, const Body& body, int slice, double coronalY, const SkinSettings& settings) {
  const Vec3 spacing = ct.grid.spacing;
  Plane raw = bodySlice(ct, body, slice);
  removeSurfaceMetal(raw, spacing, float(settings.levelHu));
  for (float& hu : raw.value) hu = std::min(hu, kBrightestHu);
  Plane plane = raw;
  smooth(plane, settings.sigmaMm / spacing.x, settings.sigmaMm / spacing.y);
  const Loop torso = torsoOutline(plane, float(settings.levelHu));
  SkinSlice skin;
  if (torso.empty()) return skin;
  const auto toLocal = [&](Point2 p) {
    return Point2{(p.x + body.box.low[0]) * spacing.x, (p.y + body.box.low[1]) * spacing.y};
  };
  for (const Point2& p : torso) skin.whole.push_back(toLocal(p));
  skin.front = frontOf(skin.whole, coronalY);
  if (settings.edge == Edge::paper && !skin.front.empty()) {
    skin.front.clear();
    for (const Point2& p : firstEdgePixels(raw, torso, coronalY / spacing.y - body.box.low[1], settings))
      skin.front.push_back(toLocal(p));
  }
  for (const Point2& p : skin.front)
    skin.clipped = skin.clipped || isAtBorder(ct, slice, {p.x / spacing.x, p.y / spacing.y});
  return skin;
}

}  // namespace pectora::thorax
