#include "plugins/effect/common/cell_hessian.h"

#include <cmath>

namespace pectora::cells {

CellHessian::CellHessian(const RestCells& rest)
    : rest_(rest), grid_(rest.grid),
      values_(std::make_unique_for_overwrite<float[]>(std::size_t(grid_.layers()) * grid_.rows() * grid_.columns() * kEntries)) {}

// Calls f(first column, count, entries, layer, row and first column of the neighbours) for what follows the nodes of a row.
template <class F>
void CellHessian::forEachNeighbour(int l, int r, F&& f) const {
  for (int k = 0; k < kNeighbourCount; ++k) {
    const auto [dl, dr, dc] = kNeighbours[k];
    const int first = std::max(0, -dc), count = grid_.columns() - std::abs(dc);
    if (l + dl >= grid_.layers() || r + dr < 0 || r + dr >= grid_.rows()) continue;
    f(first, std::size_t(count), row(l, r) + std::size_t(6 + 9 * k) * grid_.columns() + first, l + dl, r + dr, first + dc);
  }
}

void CellHessian::linearise(const NodeVectors& positions, bool projected) {
  const std::size_t perRow = std::size_t(kEntries) * grid_.columns();
  parallelFor(std::size_t(grid_.layers()) * grid_.rows(), [&](std::size_t i) { std::fill_n(&values_[i * perRow], perRow, 0.0f); });
  grid_.forEachBlock([&](int, int begin, int end) {
    grid_.forEachPack(begin, end, [&](const Grid::Place& p) {
      float* rows[4];
      for (int k = 0; k < 4; ++k) rows[k] = row(p.l + (k >> 1), p.r + (k & 1)) + p.c;
      addCurvatures(rest_.run(positions, p), rest_.packs[p.index], projected, rows, grid_.columns());
    });
  });
}

void CellHessian::multiply(const NodeVectors& v, NodeVectors& y) const {
  const std::size_t columns = grid_.columns();
  grid_.forEachBlock([&](int, int begin, int end) {
    std::vector<double> sums(3 * columns);
    for (int l = 0; l < grid_.layers(); ++l)
      for (int r = begin; r < end; ++r) {
        // What a row receives from those after it is collected apart, so that no loop writes to what it reads.
        std::fill(sums.begin(), sums.end(), 0.0);
        const std::size_t here = grid_.node(l, r, 0);
        diagonalProducts(columns, row(l, r), columns, rowOf(v, here), {&sums[0], &sums[columns], &sums[2 * columns]});
        forEachNeighbour(l, r, [&](int first, std::size_t count, const float* entries, int farLayer, int farRow, int farColumn) {
          const std::size_t far = grid_.node(farLayer, farRow, farColumn);
          blockProducts(count, entries, columns, rowOf(v, here + first), rowOf(v, far), {&sums[first], &sums[columns + first], &sums[2 * columns + first]}, rowOf(y, far));
        });
        for (std::size_t c = 0; c < columns; ++c) y.add(here + c, {sums[c], sums[columns + c], sums[2 * columns + c]});
      }
  });
}

void CellHessian::forEachCoupling(const Coupling& visit) const {
  const std::size_t columns = grid_.columns();
  for (int l = 0; l < grid_.layers(); ++l)
    for (int r = 0; r < grid_.rows(); ++r)
      forEachNeighbour(l, r, [&](int first, std::size_t count, const float* entries, int farLayer, int farRow, int farColumn) {
        for (std::size_t i = 0; i < count; ++i) {
          Matrix3 block;
          for (std::size_t e = 0; e < 9; ++e) block.m[e / 3][e % 3] = double(entries[e * columns + i]);
          visit(grid_.node(l, r, first) + i, grid_.node(farLayer, farRow, farColumn) + i, block);
        }
      });
}

void CellHessian::addDiagonal(std::vector<Symmetric3>& blocks) const {
  const std::size_t columns = grid_.columns();
  for (int l = 0; l < grid_.layers(); ++l)
    for (int r = 0; r < grid_.rows(); ++r)
      for (std::size_t c = 0; c < columns; ++c) {
        const float* e = row(l, r) + c;
        blocks[grid_.node(l, r, int(c))] += {double(e[0]), double(e[columns]), double(e[2 * columns]), double(e[3 * columns]), double(e[4 * columns]), double(e[5 * columns])};
      }
}

void CellHessian::addRowNorms(std::vector<double>& bound) const {
  const std::size_t columns = grid_.columns();
  const auto normOf = [&](const float* e, int entries) {
    double sum = 0;
    for (int k = 0; k < entries; ++k) sum += double(e[k * columns]) * double(e[k * columns]);
    return std::sqrt(sum);
  };
  std::vector<Symmetric3> diagonal(bound.size());
  addDiagonal(diagonal);
  for (std::size_t i = 0; i < bound.size(); ++i) {
    const Symmetric3& d = diagonal[i];
    bound[i] += std::sqrt(d.xx * d.xx + d.yy * d.yy + d.zz * d.zz + 2 * (d.xy * d.xy + d.xz * d.xz + d.yz * d.yz));
  }
  for (int l = 0; l < grid_.layers(); ++l)
    for (int r = 0; r < grid_.rows(); ++r)
      forEachNeighbour(l, r, [&](int first, std::size_t count, const float* entries, int farLayer, int farRow, int farColumn) {
        for (std::size_t i = 0; i < count; ++i) {
          const double n = normOf(entries + i, 9);
          bound[grid_.node(l, r, first) + i] += n;
          bound[grid_.node(farLayer, farRow, farColumn) + i] += n;
        }
      });
}

}  // namespace pectora::cells
