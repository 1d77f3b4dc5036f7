#include "plugins/segmenter/thorax/field.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr int kSlab = 16;  // slices smoothed between two calls of step

}  // namespace

std::vector<float> gaussianKernel(double sigma) {
  const int radius = sigma > 0 ? int(std::ceil(3 * sigma)) : 0;
  std::vector<float> kernel(2 * radius + 1, 1.0f);
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) sum += radius ? std::exp(-0.5 * i * i / (sigma * sigma)) : 1;
  for (int i = -radius; i <= radius && radius; ++i)
    kernel[i + radius] = float(std::exp(-0.5 * i * i / (sigma * sigma)) / sum);
  return kernel;
}

void smooth(Plane& plane, double sigmaX, double sigmaY) {
  const int w = plane.width, h = plane.height;
  // Along the rows, through a padded copy of one row.
  if (sigmaX > 0) {
    const std::vector<float> kernel = gaussianKernel(sigmaX);
    const int r = int(kernel.size()) / 2;
    std::vector<float> row(w + 2 * r);
    for (int j = 0; j < h; ++j) {
      float* line = &plane.value[std::size_t(j) * w];
      std::fill(row.begin(), row.begin() + r, line[0]);
      std::copy(line, line + w, row.begin() + r);
      std::fill(row.begin() + r + w, row.end(), line[w - 1]);
      std::fill(line, line + w, 0.0f);
      for (int t = 0; t <= 2 * r; ++t) {
        const float weight = kernel[t];
        for (int i = 0; i < w; ++i) line[i] += weight * row[i + t];
      }
    }
  }
  // Down the columns, a whole row at a time.
  if (sigmaY > 0) {
    const std::vector<float> kernel = gaussianKernel(sigmaY);
    const int r = int(kernel.size()) / 2;
    std::vector<float> result(plane.value.size(), 0.0f);
    for (int j = 0; j < h; ++j) {
      float* line = &result[std::size_t(j) * w];
      for (int t = -r; t <= r; ++t) {
        const float* from = &plane.value[std::size_t(std::clamp(j + t, 0, h - 1)) * w];
        const float weight = kernel[t + r];
        for (int i = 0; i < w; ++i) line[i] += weight * from[i];
      }
    }
    plane.value.swap(result);
  }
}

Field::Field(const Volume& ct, const Box& box, double sigmaMm, const std::function<void(double)>& step)
    : box_(box), spacing_(ct.grid.spacing) {
  const int w = box.size(0), h = box.size(1), d = box.size(2);
  const std::size_t area = std::size_t(w) * h;
  hu_.resize(area * d);
  std::array<double, 3> sigma{};
  for (int a = 0; a < 3; ++a) sigma[a] = spacing_[a] > 2 * sigmaMm ? 0 : sigmaMm / spacing_[a];

  const std::vector<float> kernel = gaussianKernel(sigma[2]);
  const int r = int(kernel.size()) / 2;
  for (int first = 0; first < d; first += kSlab) {
    if (step) step(double(first) / d);
    const int count = std::min(kSlab, d - first);
    parallelFor(count, [&](std::size_t s) {
      const int k = first + int(s);
      Plane plane(w, h);
      // Through the slices, then within the slice.
      for (int t = -r; t <= r; ++t) {
        const int from = std::clamp(k + t, 0, d - 1) + box.low[2];
        const float weight = kernel[t + r];
        for (int j = 0; j < h; ++j) {
          const std::int16_t* source = &ct.hu[ct.grid.index(box.low[0], j + box.low[1], from)];
          float* line = &plane.value[std::size_t(j) * w];
          for (int i = 0; i < w; ++i) line[i] += weight * std::max<std::int16_t>(source[i], -1024);
        }
      }
      smooth(plane, sigma[0], sigma[1]);
      std::int16_t* to = &hu_[area * k];
      for (std::size_t n = 0; n < area; ++n) to[n] = std::int16_t(std::lrintf(plane.value[n]));
    });
  }
}

float Field::at(Vec3 p) const {
  std::array<int, 3> low{};
  std::array<float, 3> t{};
  for (int a = 0; a < 3; ++a) {
    const int last = box_.size(a) - 1;
    const double x = std::clamp(p[a] / spacing_[a] - box_.low[a], 0.0, double(last));
    low[a] = std::min(int(x), std::max(0, last - 1));
    t[a] = float(x - low[a]);
  }
  const std::size_t w = box_.size(0), area = w * box_.size(1);
  const std::size_t dx = box_.size(0) > 1, dy = box_.size(1) > 1 ? w : 0, dz = box_.size(2) > 1 ? area : 0;
  const std::int16_t* v = &hu_[area * low[2] + w * low[1] + low[0]];
  const auto mix = [](float a, float b, float u) { return a + (b - a) * u; };
  const float bottom = mix(mix(v[0], v[dx], t[0]), mix(v[dy], v[dy + dx], t[0]), t[1]);
  const float top = mix(mix(v[dz], v[dz + dx], t[0]), mix(v[dz + dy], v[dz + dy + dx], t[0]), t[1]);
  return mix(bottom, top, t[2]);
}

void Field::shift(Vec3 corner, Vec3 opposite, double hu) {
  constexpr int kFaintHu = 80, kBrightHu = 400;
  std::array<int, 3> low{}, high{};
  for (int a = 0; a < 3; ++a) {
    low[a] = std::max(box_.low[a], int(std::ceil(std::min(corner[a], opposite[a]) / spacing_[a])));
    high[a] = std::min(box_.high[a] - 1, int(std::floor(std::max(corner[a], opposite[a]) / spacing_[a])));
  }
  for (int k = low[2]; k <= high[2]; ++k)
    for (int j = low[1]; j <= high[1]; ++j)
      for (int i = low[0]; i <= high[0]; ++i) {
        std::int16_t& v = hu_[(std::size_t(k - box_.low[2]) * box_.size(1) + (j - box_.low[1])) * box_.size(0) + (i - box_.low[0])];
        if (v > kFaintHu && v < kBrightHu) v = std::int16_t(std::clamp<long>(std::lround(v + hu), -1024, 3071));
      }
}

bool Field::contains(Vec3 p, double marginMm) const {
  for (int a = 0; a < 3; ++a)
    if (p[a] < box_.low[a] * spacing_[a] + marginMm || p[a] > (box_.high[a] - 1) * spacing_[a] - marginMm) return false;
  return true;
}

}  // namespace pectora::thorax
