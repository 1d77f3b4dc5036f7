// Which item of this slice continues which track of the last one.
#pragma once

#include <vector>

namespace pectora::thorax {

/// The cheapest one-to-one assignment of rows to columns (Kuhn 1955, Munkres 1957; shortest augmenting paths with
/// potentials, O(n^3)). cost[r][c] >= 0; a pair that costs `gate` or more is never made, and leaving a row or a column
/// alone costs gate / 2. Returns for each row its column, or -1.
std::vector<int> assign(const std::vector<std::vector<double>>& cost, double gate);

}  // namespace pectora::thorax
