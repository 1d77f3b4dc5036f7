#include "plugins/solver/multigrid/coarsening.h"

#include <algorithm>

namespace pectora {
namespace {

// Grids of so many rows and columns are not made coarser.
constexpr int kCoarsest = 6;

// Of a point along one direction, the coarse points from which it is interpolated.
struct Parents {
  int at[2];
  float weight;   // of each
  int count;
};
Parents parentsOf(int i, int fine, int coarse) {
  if (fine == coarse) return {{i, i}, 1, 1};
  if (i % 2 == 0) return {{i / 2, i / 2}, 1, 1};
  return {{i / 2, i / 2 + 1}, 0.5f, 2};
}

// Calls f(point, weight) for the fine points that are interpolated from coarse point i.
template <class F>
void forEachChild(int i, int fine, int coarse, F&& f) {
  if (fine == coarse) return f(i, 1.0f);
  for (int n = std::max(0, 2 * i - 1); n <= std::min(fine - 1, 2 * i + 1); ++n) f(n, n == 2 * i ? 1.0f : 0.5f);
}

int coarserCount(int count) { return count > kCoarsest ? count / 2 + 1 : count; }

int halfDown(int i) { return i >= 0 ? i / 2 : -((1 - i) / 2); }

}  // namespace

GridShape coarser(GridShape fine) { return {fine.layers, coarserCount(fine.rows), coarserCount(fine.columns)}; }

void restrict(GridShape fineShape, const SingleVectors& fine, GridShape shape, SingleVectors& coarse) {
  forEachLine(shape, [&](std::size_t line) {
    const int l = int(line) / shape.rows, r = int(line) % shape.rows;
    for (auto v : {&SingleVectors::x, &SingleVectors::y, &SingleVectors::z}) {
      float* out = &(coarse.*v)[shape.number(l, r, 0)];
      std::fill_n(out, shape.columns, 0.0f);
      forEachChild(r, fineShape.rows, shape.rows, [&](int fineRow, float rowWeight) {
        const float* in = &(fine.*v)[fineShape.number(l, fineRow, 0)];
        if (shape.columns == fineShape.columns) {
          for (int c = 0; c < shape.columns; ++c) out[c] += rowWeight * in[c];
          return;
        }
        // Inner columns without a branch, then the edges.
        const int last = shape.columns - 1, inner = (fineShape.columns - 2) / 2;
        for (int c = 1; c <= std::min(inner, last); ++c) out[c] += rowWeight * (0.5f * (in[2 * c - 1] + in[2 * c + 1]) + in[2 * c]);
        out[0] += rowWeight * (in[0] + 0.5f * in[1]);
        for (int c = inner + 1; c <= last; ++c) {
          if (2 * c - 1 < fineShape.columns) out[c] += 0.5f * rowWeight * in[2 * c - 1];
          if (2 * c < fineShape.columns) out[c] += rowWeight * in[2 * c];
        }
      });
    }
  });
}

void prolongate(GridShape shape, const SingleVectors& coarse, GridShape fineShape, SingleVectors& fine) {
  forEachLine(fineShape, [&](std::size_t line) {
    const int l = int(line) / fineShape.rows, r = int(line) % fineShape.rows;
    const Parents rows = parentsOf(r, fineShape.rows, shape.rows);
    for (auto v : {&SingleVectors::x, &SingleVectors::y, &SingleVectors::z}) {
      float* out = &(fine.*v)[fineShape.number(l, r, 0)];
      const float* a = &(coarse.*v)[shape.number(l, rows.at[0], 0)];
      const float* b = &(coarse.*v)[shape.number(l, rows.at[rows.count - 1], 0)];
      if (shape.columns == fineShape.columns) {
        for (int c = 0; c < fineShape.columns; ++c) out[c] += 0.5f * (a[c] + b[c]);
        continue;
      }
      for (int c = 0; 2 * c < fineShape.columns; ++c) out[2 * c] += 0.5f * (a[c] + b[c]);
      for (int c = 0; 2 * c + 1 < fineShape.columns; ++c) out[2 * c + 1] += 0.25f * (a[c] + a[c + 1] + b[c] + b[c + 1]);
    }
  });
}

void Collector::coupling(std::size_t a, std::size_t b, const Matrix3& block) {
  if (a >= fine_.points() || b >= fine_.points()) return;
  const GridShape coarse = coarse_.shape();
  const GridPoint p = fine_.point(a), q = fine_.point(b);
  const Parents pRows = parentsOf(p.row, fine_.rows, coarse.rows), pColumns = parentsOf(p.column, fine_.columns, coarse.columns);
  const Parents qRows = parentsOf(q.row, fine_.rows, coarse.rows), qColumns = parentsOf(q.column, fine_.columns, coarse.columns);
  const float weight = pRows.weight * pColumns.weight * qRows.weight * qColumns.weight;
  float entries[9];
  for (int e = 0; e < 9; ++e) entries[e] = float(block.m[e / 3][e % 3]);
  const float* rows[9];
  for (int e = 0; e < 9; ++e) rows[e] = &entries[e];
  for (int i = 0; i < pRows.count; ++i)
    for (int j = 0; j < pColumns.count; ++j)
      for (int k = 0; k < qRows.count; ++k)
        for (int l = 0; l < qColumns.count; ++l)
          coarse_.add({p.layer, pRows.at[i], pColumns.at[j]}, {q.layer, qRows.at[k], qColumns.at[l]}, 1, rows, weight);
}

void Collector::run(std::size_t a, std::size_t b, std::size_t count, const float* const entries[9], float weight) {
  const GridShape coarse = coarse_.shape();
  const GridPoint p = fine_.point(a), q = fine_.point(b);
  const int between = q.column - p.column;
  const Parents pRows = parentsOf(p.row, fine_.rows, coarse.rows), qRows = parentsOf(q.row, fine_.rows, coarse.rows);
  // Adds a run of coarse blocks, column by column, to all coarse rows.
  const auto addToRows = [&](int column, int otherColumn, std::size_t length, const float* const blocks[9]) {
    for (int i = 0; i < pRows.count; ++i)
      for (int k = 0; k < qRows.count; ++k)
        coarse_.add({p.layer, pRows.at[i], column}, {q.layer, qRows.at[k], otherColumn}, length, blocks, weight * pRows.weight * qRows.weight);
  };
  if (coarse.columns == fine_.columns) return addToRows(p.column, q.column, count, entries);

  // Entries that lie in one place, as of symmetric blocks, are summed once.
  int source[9];
  for (int e = 0; e < 9; ++e) source[e] = int(std::find(entries, entries + e, entries[e]) - entries);

  // First along the columns. Between the coarse columns of both ends lie `least` to `least` + 2 others: for every such distance there is a run
  // of blocks, which begins at coarse column `first`.
  const int least = halfDown(between - 1), first = p.column / 2;
  const std::size_t length = std::size_t(int(p.column + count - 1) / 2 - first + 2);
  thread_local std::vector<float> room;
  room.assign(3 * 9 * length, 0);
  const auto blocksOf = [&](int distance, int entry) { return &room[(std::size_t(distance - least) * 9 + std::size_t(entry)) * length]; };
  bool isUsed[3] = {};
  for (int parity = 0; parity < 2; ++parity) {
    const std::size_t begin = std::size_t((p.column + parity) % 2);   // the first block whose near column has this parity
    if (begin >= count) continue;
    const int column = p.column + int(begin), half = column / 2 - first;
    const std::size_t blocks = (count - begin + 1) / 2;
    const bool isOdd = column % 2 != 0, isOtherOdd = (column + between) % 2 != 0;
    const int otherHalf = halfDown(column + between) - column / 2;
    const float part = (isOdd ? 0.5f : 1.0f) * (isOtherOdd ? 0.5f : 1.0f);
    for (int i = 0; i <= int(isOdd); ++i)
      for (int j = 0; j <= int(isOtherOdd); ++j) {
        const int distance = otherHalf + j - i;
        isUsed[distance - least] = true;
        for (int e = 0; e < 9; ++e)
          if (source[e] == e) addEverySecond(blocks, entries[e] + begin, part, blocksOf(distance, e) + half + i);
      }
  }
  // Then along the rows. Of a run, coarse columns beyond the grid hold nothing.
  for (int d = 0; d < 3; ++d) {
    if (!isUsed[d]) continue;
    const int distance = least + d, begin = std::max({first, 0, -distance});
    const int end = std::min({first + int(length), coarse.columns, coarse.columns - distance});
    const float* blocks[9];
    for (int e = 0; e < 9; ++e) blocks[e] = blocksOf(distance, source[e]) + (begin - first);
    if (begin < end) addToRows(begin, begin + distance, std::size_t(end - begin), blocks);
  }
}

void Collector::add(const GridMatrix& fine) {
  fine.forEachRun([&](GridPoint a, GridPoint b, std::size_t count, const float* const entries[9]) {
    const std::size_t p = fine_.number(a.layer, a.row, a.column), q = fine_.number(b.layer, b.row, b.column);
    run(p, q, count, entries, p == q ? 0.5f : 1.0f);
  });
}

}  // namespace pectora
