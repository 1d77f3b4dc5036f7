#include "plugins/segmenter/thorax/column_path.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cstdint>

namespace pectora::thorax {

Sums::Sums(const Plane& p) : width_(p.width + 1), height_(p.height + 1), sum_(std::size_t(width_) * height_, 0) {
  for (int j = 1; j < height_; ++j)
    for (int i = 1; i < width_; ++i)
      sum_[std::size_t(j) * width_ + i] = p.at(i - 1, j - 1) + sum_[std::size_t(j - 1) * width_ + i] +
                                          sum_[std::size_t(j) * width_ + i - 1] - sum_[std::size_t(j - 1) * width_ + i - 1];
}

double Sums::mean(int i0, int i1, int j0, int j1) const {
  i0 = std::clamp(i0, 0, width_ - 1), i1 = std::clamp(i1, 0, width_ - 1);
  j0 = std::clamp(j0, 0, height_ - 1), j1 = std::clamp(j1, 0, height_ - 1);
  if (i1 <= i0 || j1 <= j0) return 0;
  const auto at = [&](int i, int j) { return sum_[std::size_t(j) * width_ + i]; };
  return (at(i1, j1) - at(i0, j1) - at(i1, j0) + at(i0, j0)) / ((i1 - i0) * (j1 - j0));
}

ColumnPath bestColumn(const std::vector<float>& score, int nx, int ny, int slices, int reach, int side, float stepCost) {
  const std::size_t cells = std::size_t(nx) * ny;
  std::vector<float> smooth(score.size());
  parallelFor(std::size_t(slices), [&](std::size_t s) {
    const int a = std::max(0, int(s) - reach), b = std::min(slices - 1, int(s) + reach);
    for (std::size_t c = 0; c < cells; ++c) {
      double sum = 0;
      for (int t = a; t <= b; ++t) sum += score[cells * std::size_t(t) + c];
      smooth[cells * s + c] = float(sum / (b - a + 1));
    }
  });
  std::vector<float> best(smooth.begin(), smooth.begin() + std::ptrdiff_t(cells)), next(cells);
  std::vector<std::int32_t> came(cells * std::size_t(slices), 0);
  for (std::size_t s = 1; s < std::size_t(slices); ++s) {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const int c = j * nx + i;
        float most = -std::numeric_limits<float>::infinity();
        for (int dj = -side; dj <= side; ++dj)
          for (int di = -side; di <= side; ++di) {
            if (i + di < 0 || i + di >= nx || j + dj < 0 || j + dj >= ny) continue;
            const int from = c + dj * nx + di;
            const float value = best[from] - stepCost * float(di * di + dj * dj);
            if (value > most) most = value, came[cells * s + c] = from;
          }
        next[c] = most + smooth[cells * s + c];
      }
    best.swap(next);
  }
  ColumnPath path;
  path.cell.resize(slices);
  path.score.resize(slices);
  path.cell[slices - 1] = int(std::max_element(best.begin(), best.end()) - best.begin());
  for (int s = slices - 1; s > 0; --s) path.cell[s - 1] = came[cells * s + path.cell[s]];
  for (int s = 0; s < slices; ++s) path.score[s] = smooth[cells * s + path.cell[s]];
  return path;
}

}  // namespace pectora::thorax
