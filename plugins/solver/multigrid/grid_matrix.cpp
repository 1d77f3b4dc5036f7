#include "plugins/solver/multigrid/grid_matrix.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace pectora {
namespace {

// Fewer points than this are not worth a second thread.
constexpr int kBlockPoints = 512;

}  // namespace

GridMatrix::GridMatrix(GridShape shape)
    : shape_(shape), diagonal_(std::size_t(shape.layers), std::vector<float>(6 * std::size_t(shape.rows) * shape.columns)), inverse_(diagonal_),
      near_(std::size_t(shape.layers) * shape.layers * (kNear + 1) * (2 * kNear + 1)) {}

GridMatrix::Offset& GridMatrix::offset(int layer, int otherLayer, int rows, int columns) {
  // Those to near neighbours are found without waiting for others.
  std::atomic<Offset*>* known = nullptr;
  if (rows <= kNear && std::abs(columns) <= kNear)
    known = &near_[((std::size_t(layer) * shape_.layers + otherLayer) * (kNear + 1) + rows) * (2 * kNear + 1) + (columns + kNear)];
  if (known)
    if (Offset* found = known->load(std::memory_order_acquire)) return *found;
  const std::lock_guard lock(adding_);
  auto found = std::find_if(offsets_.begin(), offsets_.end(), [&](const auto& o) {
    return o->rows == rows && o->columns == columns && o->layer == layer && o->otherLayer == otherLayer;
  });
  if (found == offsets_.end())
    found = offsets_.insert(found, std::make_unique<Offset>(Offset{layer, otherLayer, rows, columns, std::vector<float>(9 * std::size_t(shape_.rows) * shape_.columns)}));
  if (known) known->store(found->get(), std::memory_order_release);
  return **found;
}

void GridMatrix::add(GridPoint a, GridPoint b, std::size_t count, const float* const entries[9], float weight) {
  const std::size_t stride = std::size_t(shape_.columns);
  int rows = b.row - a.row, columns = b.column - a.column;
  if (rows == 0 && columns == 0 && a.layer == b.layer) {
    float* d = &diagonal_[std::size_t(a.layer)][place(a.row, a.column, 6)];
    const int of[6][2] = {{0, 0}, {1, 3}, {2, 6}, {4, 4}, {5, 7}, {8, 8}};   // an entry and the one across the diagonal
    for (std::size_t e = 0; e < 6; ++e)
      for (int side = 0; side < 2; ++side) addScaled(count, entries[of[e][side]], weight, d + e * stride);
    return;
  }
  // A pair is kept with the end that comes first.
  const bool turned = rows < 0 || (rows == 0 && (columns < 0 || (columns == 0 && a.layer > b.layer)));
  if (turned) {
    std::swap(a, b);
    rows = -rows, columns = -columns;
  }
  float* m = &offset(a.layer, b.layer, rows, columns).blocks[place(a.row, a.column, 9)];
  for (std::size_t e = 0; e < 9; ++e) addScaled(count, entries[turned ? e % 3 * 3 + e / 3 : e], weight, m + e * stride);
}

void GridMatrix::addDiagonal(const std::vector<Symmetric3>& blocks) {
  const std::size_t stride = std::size_t(shape_.columns);
  forEachLine(shape_, [&](std::size_t line) {
    const int l = int(line) / shape_.rows, r = int(line) % shape_.rows;
    float* d = &diagonal_[std::size_t(l)][place(r, 0, 6)];
    for (std::size_t c = 0; c < stride; ++c) {
      const Symmetric3& b = blocks[shape_.number(l, r, int(c))];
      const double values[6] = {b.xx, b.xy, b.xz, b.yy, b.yz, b.zz};
      for (std::size_t e = 0; e < 6; ++e) d[e * stride + c] += float(values[e]);
    }
  });
}

void GridMatrix::finish() {
  // One order, whoever came first: it is that of the sums.
  const auto order = [](const Offset& o) { return std::tuple(o.rows, o.columns, o.layer, o.otherLayer); };
  std::sort(offsets_.begin(), offsets_.end(), [&](const auto& a, const auto& b) { return order(*a) < order(*b); });
  const std::size_t stride = std::size_t(shape_.columns);
  forEachLine(shape_, [&](std::size_t line) {
    const std::size_t l = line / std::size_t(shape_.rows);
    for (int c = 0; c < shape_.columns; ++c) {
      const std::size_t first = place(int(line) % shape_.rows, c, 6);
      const float* d = &diagonal_[l][first];
      float* i = &inverse_[l][first];
      const Symmetric3 inverted = inverse({double(d[0]), double(d[stride]), double(d[2 * stride]), double(d[3 * stride]),
                                           double(d[4 * stride]), double(d[5 * stride])});
      i[0] = float(inverted.xx), i[stride] = float(inverted.xy), i[2 * stride] = float(inverted.xz);
      i[3 * stride] = float(inverted.yy), i[4 * stride] = float(inverted.yz), i[5 * stride] = float(inverted.zz);
    }
  });
}

void GridMatrix::keepInverseDiagonal() {
  offsets_.clear();
  for (auto& known : near_) known = nullptr;
  diagonal_ = {};
}

template <class F>
void GridMatrix::forEachRowBlock(F&& f) const {
  int reach = 0;
  for (const auto& o : offsets_) reach = std::max(reach, o->rows);
  const int rows = std::max({8, reach + 2, kBlockPoints / (shape_.layers * shape_.columns)});
  const std::size_t blocks = std::size_t((shape_.rows + rows - 1) / rows);
  for (std::size_t parity = 0; parity < 2; ++parity)
    parallelFor((blocks + 1 - parity) / 2, [&](std::size_t i) {
      const int begin = int(2 * i + parity) * rows;
      f(begin, std::min(shape_.rows, begin + rows));
    });
}

template <class F>
void GridMatrix::inGrid(const Offset& o, F&& f) const {
  const int first = std::max(0, -o.columns), end = std::min(shape_.columns, shape_.columns - o.columns);
  if (first < end) f(first, std::size_t(end - first));
}

// A row takes from the rows that it is joined with, and gives to them: every block is read once.
void GridMatrix::multiply(const SingleVectors& x, SingleVectors& y) const {
  const std::size_t columns = std::size_t(shape_.columns);
  forEachLine(shape_, [&](std::size_t line) {
    const std::size_t l = line / std::size_t(shape_.rows), node = line * columns;
    setSymmetricProducts(columns, {&diagonal_[l][place(int(line) % shape_.rows, 0, 6)], columns}, rowOf(x, node), rowOf(y, node));
  });
  forEachRowBlock([&](int begin, int end) {
    for (const auto& o : offsets_)
      for (int row = begin; row < std::min(end, shape_.rows - o->rows); ++row)
        inGrid(*o, [&](int first, std::size_t count) {
          const BlockRow blocks{&o->blocks[place(row, first, 9)], columns};
          const std::size_t near = shape_.number(o->layer, row, first), far = shape_.number(o->otherLayer, row + o->rows, first + o->columns);
          if (o->rows > 0 || o->layer != o->otherLayer) {
            addBlockProducts(count, blocks, rowOf(x, near), rowOf(x, far), rowOf(y, near), rowOf(y, far));
          } else {
            addBlockProducts(count, blocks, false, rowOf(x, far), rowOf(y, near));
            addBlockProducts(count, blocks, true, rowOf(x, near), rowOf(y, far));
          }
        });
  });
}

void GridMatrix::multiplyInverseDiagonal(const SingleVectors& x, SingleVectors& y) const {
  const std::size_t columns = std::size_t(shape_.columns);
  forEachLine(shape_, [&](std::size_t line) {
    const std::size_t l = line / std::size_t(shape_.rows), node = line * columns;
    setSymmetricProducts(columns, {&inverse_[l][place(int(line) % shape_.rows, 0, 6)], columns}, rowOf(x, node), rowOf(y, node));
  });
}

void GridMatrix::forEachRun(const Run& run) const {
  const std::size_t stride = std::size_t(shape_.columns);
  forEachRowBlock([&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      for (int l = 0; l < shape_.layers; ++l) {
        const float* d = &diagonal_[std::size_t(l)][place(row, 0, 6)];
        const float* const entries[9] = {d, d + stride, d + 2 * stride, d + stride, d + 3 * stride, d + 4 * stride, d + 2 * stride, d + 4 * stride, d + 5 * stride};
        run({l, row, 0}, {l, row, 0}, stride, entries);
      }
      for (const auto& o : offsets_) {
        if (row + o->rows >= shape_.rows) continue;
        inGrid(*o, [&](int first, std::size_t count) {
          const float* entries[9];
          for (std::size_t e = 0; e < 9; ++e) entries[e] = &o->blocks[place(row, first, 9) + e * stride];
          run({o->layer, row, first}, {o->otherLayer, row + o->rows, first + o->columns}, count, entries);
        });
      }
    }
  });
}

}  // namespace pectora
