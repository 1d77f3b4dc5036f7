#include "plugins/segmenter/thorax/assignment.h"

#include <algorithm>
#include <limits>

namespace pectora::thorax {

std::vector<int> assign(const std::vector<std::vector<double>>& cost, double gate) {
  const int rows = int(cost.size()), columns = rows ? int(cost[0].size()) : 0, n = rows + columns;
  if (!rows || !columns) return std::vector<int>(rows, -1);
  // A square problem: every row may end alone (dummy columns), every column may begin alone (dummy rows).
  const auto price = [&](int r, int c) {
    if (r < rows && c < columns) return std::min(cost[r][c], gate);
    return r < rows || c < columns ? gate / 2 : 0.0;
  };
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::vector<double> u(n + 1, 0), v(n + 1, 0);
  std::vector<int> rowOf(n + 1, 0), way(n + 1, 0);  // 1-based, 0 = none
  for (int r = 1; r <= n; ++r) {
    std::vector<double> least(n + 1, kInfinite);
    std::vector<char> isDone(n + 1, 0);
    int column = 0;
    rowOf[0] = r;
    do {
      isDone[column] = 1;
      const int row = rowOf[column];
      int next = 0;
      double delta = kInfinite;
      for (int c = 1; c <= n; ++c) {
        if (isDone[c]) continue;
        const double reduced = price(row - 1, c - 1) - u[row] - v[c];
        if (reduced < least[c]) least[c] = reduced, way[c] = column;
        if (least[c] < delta) delta = least[c], next = c;
      }
      for (int c = 0; c <= n; ++c) {
        if (isDone[c]) u[rowOf[c]] += delta, v[c] -= delta;
        else least[c] -= delta;
      }
      column = next;
    } while (rowOf[column] != 0);
    for (; column != 0; column = way[column]) rowOf[column] = rowOf[way[column]];
  }
  std::vector<int> result(rows, -1);
  for (int c = 1; c <= columns; ++c)
    if (rowOf[c] <= rows && cost[rowOf[c] - 1][c - 1] < gate) result[rowOf[c] - 1] = c - 1;
  return result;
}

}  // namespace pectora::thorax
