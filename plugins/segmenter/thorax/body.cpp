#include "plugins/segmenter/thorax/body.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"
#include "plugins/segmenter/thorax/components.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr double kCoarseMm = 1.4;     // wished width of a coarse pixel
constexpr double kOpeningMm = 3.0;    // what is thinner than twice this falls off the body
constexpr int kSolidHu = -300;        // between fat and clothes
constexpr int kLungHu = -400;
constexpr int kGasHu = -960;
constexpr double kLeastBodyMl = 50, kLeastLungMl = 30;

/// One step of erosion (or dilation) of a slice by a cross or, every second step, a square: nearly round.
void erode(std::vector<std::uint8_t>& slice, int w, int h, bool isSquare, bool dilates) {
  std::vector<std::uint8_t> from = slice;
  if (dilates)
    for (std::uint8_t& v : from) v = !v;
  std::vector<std::uint8_t> to(from.size(), 0);
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      bool all = true;
      for (int dj = -1; dj <= 1 && all; ++dj)
        for (int di = -1; di <= 1 && all; ++di) {
          if (!isSquare && di && dj) continue;
          // Beyond the picture the body goes on.
          const int x = std::clamp(i + di, 0, w - 1), y = std::clamp(j + dj, 0, h - 1);
          all = from[std::size_t(y) * w + x];
        }
      to[std::size_t(j) * w + i] = all;
    }
  if (dilates)
    for (std::uint8_t& v : to) v = !v;
  slice.swap(to);
}

/// Marks what cannot be reached from the slice's border without crossing `solid`.
void fillHoles(std::uint8_t* solid, int w, int h) {
  std::vector<std::uint8_t> isOutside(std::size_t(w) * h, 0);
  std::vector<int> stack;
  const auto push = [&](int n) {
    if (!solid[n] && !isOutside[n]) isOutside[n] = 1, stack.push_back(n);
  };
  for (int i = 0; i < w; ++i) push(i), push((h - 1) * w + i);
  for (int j = 0; j < h; ++j) push(j * w), push(j * w + w - 1);
  while (!stack.empty()) {
    const int n = stack.back();
    stack.pop_back();
    if (n % w) push(n - 1);
    if (n % w != w - 1) push(n + 1);
    if (n >= w) push(n - w);
    if (n < (h - 1) * w) push(n + w);
  }
  for (int n = 0; n < w * h; ++n) solid[n] = !isOutside[n];
}

}  // namespace

std::array<int, 3> Body::nearest(Vec3 p) const {
  const double shift = 0.5 * (1 - 1.0 / factor);
  return {std::clamp(int(std::lround(p.x / spacing.x - shift)), 0, size[0] - 1),
          std::clamp(int(std::lround(p.y / spacing.y - shift)), 0, size[1] - 1),
          std::clamp(int(std::lround(p.z / spacing.z)), 0, size[2] - 1)};
}

Body findBody(const Volume& ct, const std::function<void(double)>& step) {
  const Grid& grid = ct.grid;
  Body body;
  const int f = std::max(1, int(std::lround(kCoarseMm / std::max(grid.spacing.x, grid.spacing.y))));
  body.factor = f;
  body.size = {grid.size[0] / f, grid.size[1] / f, grid.size[2]};
  body.spacing = {grid.spacing.x * f, grid.spacing.y * f, grid.spacing.z};
  const int w = body.size[0], h = body.size[1], d = body.size[2];
  if (w < 8 || h < 8 || d < 1) throw Error("the CT is too small to hold a chest").advise("load the whole series");
  const std::size_t area = std::size_t(w) * h;
  body.hu.resize(area * d);
  body.mask.assign(area * d, 0);
  if (step) step(0);

  // Coarse copy, threshold and erosion, slice by slice.
  const int rounds = std::max(1, int(std::lround(kOpeningMm / std::max(body.spacing.x, body.spacing.y))));
  std::vector<std::uint8_t> core(area * d);
  parallelFor(d, [&](std::size_t k) {
    std::int16_t* to = &body.hu[area * k];
    std::vector<int> sum(w);
    for (int j = 0; j < h; ++j) {
      std::fill(sum.begin(), sum.end(), 0);
      for (int b = 0; b < f; ++b) {
        const std::int16_t* from = &ct.hu[grid.index(0, j * f + b, int(k))];
        for (int i = 0; i < w; ++i)
          for (int a = 0; a < f; ++a) sum[i] += std::max<int>(from[i * f + a], -1024);
      }
      for (int i = 0; i < w; ++i) to[std::size_t(j) * w + i] = std::int16_t(std::lround(double(sum[i]) / (f * f)));
    }
    std::vector<std::uint8_t> slice(area);
    for (std::size_t n = 0; n < area; ++n) slice[n] = to[n] > kSolidHu;
    for (int r = 0; r < rounds; ++r) erode(slice, w, h, r % 2, false);
    std::copy(slice.begin(), slice.end(), core.begin() + area * k);
  });
  if (step) step(0.4);

  const double millilitres = body.spacing.x * body.spacing.y * body.spacing.z / 1000;
  {
    const Components parts = components(core, body.size);
    const int largest = parts.largest();
    if (!largest || parts.voxels[largest - 1] * millilitres < kLeastBodyMl)
      throw Error("no body was found in the CT: there is hardly anything denser than air in it")
          .advise("check that the series is a CT of the chest, in Hounsfield units");
    if (parts.voxels[largest - 1] == core.size())
      throw Error("no body was found in the CT: there is no air around it or in it")
          .advise("check that the series is a CT of the chest, in Hounsfield units");
    for (std::size_t n = 0; n < core.size(); ++n) core[n] = parts.label[n] == largest;
  }
  if (step) step(0.6);

  // Back to full width, cavities filled; the cavities are candidates for lung.
  std::vector<std::uint8_t> cavity(area * d);
  parallelFor(d, [&](std::size_t k) {
    std::vector<std::uint8_t> slice(core.begin() + area * k, core.begin() + area * (k + 1));
    const std::int16_t* hu = &body.hu[area * k];
    for (int r = 0; r < rounds; ++r) {
      erode(slice, w, h, (rounds - 1 - r) % 2, true);
      for (std::size_t n = 0; n < area; ++n) slice[n] = slice[n] && hu[n] > kSolidHu;
    }
    fillHoles(slice.data(), w, h);
    for (std::size_t n = 0; n < area; ++n) {
      body.mask[area * k + n] = slice[n] ? Body::kTorso : 0;
      cavity[area * k + n] = slice[n] && hu[n] < kLungHu;
    }
  });
  if (step) step(0.8);

  const Components holes = components(cavity, body.size);
  std::vector<double> sum(holes.voxels.size(), 0);
  for (std::size_t n = 0; n < cavity.size(); ++n)
    if (holes.label[n]) sum[holes.label[n] - 1] += body.hu[n];
  std::vector<char> isLung(holes.voxels.size(), 0);
  double largest = 0;
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t c = 0; c < holes.voxels.size(); ++c) {
      const double volume = holes.voxels[c] * millilitres;
      if (sum[c] / holes.voxels[c] < kGasHu || volume < kLeastLungMl) continue;
      if (pass == 0) largest = std::max(largest, volume);
      else isLung[c] = volume >= 0.1 * largest;
    }
  for (std::size_t n = 0; n < cavity.size(); ++n)
    if (holes.label[n] && isLung[holes.label[n] - 1]) body.mask[n] |= Body::kLung, body.hasLungs = true;

  // Bounding box of the torso.
  std::array<int, 3> low{w, h, d}, high{-1, -1, -1};
  for (int k = 0; k < d; ++k)
    for (int j = 0; j < h; ++j)
      for (int i = 0; i < w; ++i)
        if (body.isTorso(i, j, k)) {
          low = {std::min(low[0], i), std::min(low[1], j), std::min(low[2], k)};
          high = {std::max(high[0], i), std::max(high[1], j), std::max(high[2], k)};
        }
  body.firstSlice = low[2], body.lastSlice = high[2];
  for (int a = 0; a < 3; ++a) {
    const int blocks = a < 2 ? f : 1, border = a < 2 ? 4 : 0;
    body.box.low[a] = std::max(0, low[a] * blocks - border);
    body.box.high[a] = std::min(grid.size[a], (high[a] + 1) * blocks + border);
    if (high[a] == body.size[a] - 1) body.box.high[a] = grid.size[a];
  }
  return body;
}

}  // namespace pectora::thorax
