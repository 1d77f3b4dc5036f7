#include "plugins/segmenter/thorax/spine.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"
#include "plugins/segmenter/thorax/column_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pectora::thorax {
namespace {

constexpr double kGridMm = 2.8;        // positions of the centre that are tried
constexpr double kLeastScore = 0.12;   // of the box, or there is no vertebra here

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + v.size() / 2, v.end());
  return v[v.size() / 2];
}

}  // namespace

Spine findSpine(const Body& body, const Field& field, double boneHu) {
  const int w = body.size[0], h = body.size[1], first = body.firstSlice, count = body.lastSlice - first + 1;
  const double sx = body.spacing.x, sy = body.spacing.y, sz = body.spacing.z;
  const int px = std::max(1, int(std::lround(kGridMm / sx))), py = std::max(1, int(std::lround(kGridMm / sy)));
  const int nx = w / px, ny = h / py, cells = nx * ny;
  if (cells == 0) throw Error("the CT is too small to hold a spine");

  // Middle and back of the torso: the column stands within 45 mm of the middle and 20 to 130 mm before the back.
  double middle = 0;
  std::size_t pixels = 0;
  int back = 0;
  {
    std::vector<std::size_t> perRow(h, 0);
    for (int k = first; k <= body.lastSlice; ++k)
      for (int j = 0; j < h; ++j)
        for (int i = 0; i < w; ++i)
          if (body.isTorso(i, j, k)) middle += i, ++pixels, ++perRow[j];
    middle /= double(pixels);
    std::size_t below = 0;
    for (back = h - 1; back > 0 && below < pixels / 200; --back) below += perRow[back];
  }

  // Score of every position of every slice.
  std::vector<float> score(std::size_t(cells) * count);
  parallelFor(count, [&](std::size_t s) {
    Plane bone(w, h);
    for (std::size_t n = 0; n < bone.value.size(); ++n) {
      const std::size_t at = body.index(0, 0, first + int(s)) + n;
      bone.value[n] = body.mask[at] & Body::kTorso ? boneness(body.hu[at]) : 0;
    }
    const Sums sums(bone);
    const auto mean = [&](double x, double y, double x0, double x1, double y0, double y1) {
      return sums.mean(int(std::lround(x + x0 / sx)), int(std::lround(x + x1 / sx)), int(std::lround(y + y0 / sy)),
                       int(std::lround(y + y1 / sy)));
    };
    for (int c = 0; c < cells; ++c) {
      const double x = (c % nx + 0.5) * px, y = (c / nx + 0.5) * py;
      const double aside = std::abs(x - middle) * sx, behind = (back - y) * sy;
      score[cells * s + c] = aside > 45 || behind < 20 || behind > 140 ? -1
          : float(mean(x, y, -12, 12, -10, 10) - 0.7 * mean(x, y, -12, 12, -26, -14) +
                  0.4 * mean(x, y, -28, 28, 12, 40) - 0.3 * mean(x, y, -45, -20, -14, 4) -
                  0.3 * mean(x, y, 20, 45, -14, 4));
    }
  });

  // The best path from the lowest slice to the highest; the mean over 16 mm of slices bridges the discs.
  const int side = std::max(1, int(std::ceil(sz / kGridMm)));
  const ColumnPath path = bestColumn(score, nx, ny, count, int(8 / sz), side, float(0.04 * kGridMm / std::max(sz, 1.0)));

  // Where the score holds up, the column was seen.
  Spine spine;
  spine.firstSlice = -1;
  for (int s = 0; s < count; ++s)
    if (path.score[s] > kLeastScore) {
      if (spine.firstSlice < 0) spine.firstSlice = first + s;
      spine.lastSlice = first + s;
    }
  if (spine.firstSlice < 0)
    throw Error("no spine was found in the CT", ErrorKind::runFailed)
        .advise("check that the series shows a whole chest, and that its bone is above the threshold");

  // Centres, smoothed over about 20 mm.
  const int slices = body.size[2], window = std::max(1, int(std::lround(10 / sz)));
  const auto clampSlice = [&](int k) { return std::clamp(k, spine.firstSlice, spine.lastSlice); };
  spine.centre.resize(slices);
  for (int k = 0; k < slices; ++k) {
    Vec3 sum{};
    for (int t = -window; t <= window; ++t) {
      const int c = path.cell[clampSlice(k + t) - first];
      sum += body.position((c % nx + 0.5) * px - 0.5, (c / nx + 0.5) * py - 0.5, 0);
    }
    spine.centre[k] = sum / (2.0 * window + 1);
    spine.centre[k].z = k * sz;
  }

  // Front of the body: along lines forward from the centre, the last crossing before 1.5 mm without bone.
  std::vector<double> front(slices, std::numeric_limits<double>::quiet_NaN());
  constexpr double kStep = 0.4;
  parallelFor(spine.lastSlice - spine.firstSlice + 1, [&](std::size_t s) {
    const int k = spine.firstSlice + int(s);
    std::vector<double> found;
    for (int line = -4; line <= 4; ++line) {
      Vec3 p = spine.centre[k] + Vec3{1.5 * line, 0, 0};
      double last = std::numeric_limits<double>::quiet_NaN();
      float before = field.at(p);
      for (double t = kStep; t < 26; t += kStep) {
        const float value = field.at({p.x, p.y - t, p.z});
        if (before >= boneHu && value < boneHu) last = t - kStep * (boneHu - value) / (before - value);
        if (value < boneHu && !std::isnan(last) && t - last > 1.5 && last > 5) break;
        before = value;
      }
      if (last > 5) found.push_back(p.y - last);
    }
    if (found.size() >= 5) front[k] = median(found);
  });
  // Running median over 30 mm bridges the discs, then a smoothing over 10 mm.
  std::vector<double> line(slices, std::numeric_limits<double>::quiet_NaN());
  const int wide = std::max(1, int(std::lround(15 / sz)));
  for (int k = 0; k < slices; ++k) {
    std::vector<double> near;
    for (int t = -wide; t <= wide; ++t) {
      const int at = clampSlice(k + t);
      if (!std::isnan(front[at])) near.push_back(front[at] - spine.centre[at].y);
    }
    if (near.size() >= 3) line[k] = median(near);
  }
  double fallback = -12;
  {
    std::vector<double> all;
    for (double v : line)
      if (!std::isnan(v)) all.push_back(v);
    if (!all.empty()) fallback = median(all);
  }
  spine.front.resize(slices);
  for (int k = 0; k < slices; ++k)
    spine.front[k] = spine.centre[k] + Vec3{0, std::isnan(line[k]) ? fallback : line[k], 0};
  return spine;
}

}  // namespace pectora::thorax
