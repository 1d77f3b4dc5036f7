// The best way of a column of bone through the slices.
#pragma once

#include "plugins/segmenter/thorax/field.h"

#include <functional>
#include <limits>

namespace pectora::thorax {

/// How much like bone a value is, 0 (100 HU) to 1 (250 HU).
inline float boneness(float hu) { return hu <= 100 ? 0.0f : hu >= 250 ? 1.0f : (hu - 100) / 150; }

/// Means over rectangles of a plane in constant time (summed-area table, Crow 1984).
class Sums {
 public:
  explicit Sums(const Plane& plane);
  /// Mean over pixels [i0, i1) x [j0, j1), cut to the plane; 0 if nothing is left.
  double mean(int i0, int i1, int j0, int j1) const;

 private:
  int width_, height_;
  std::vector<double> sum_;
};

/// A position of a coarse raster in every slice of a run.
struct ColumnPath {
  std::vector<int> cell;       ///< j * nx + i
  std::vector<float> score;    ///< smoothed score at that cell
};

/// Viterbi's algorithm: `score[slice * nx * ny + cell]` is first averaged over `reach` slices to either side; then the
/// path with the greatest sum of scores is found, a step of d cells from slice to slice costing stepCost * d^2, at most
/// `side` cells along either axis.
ColumnPath bestColumn(const std::vector<float>& score, int nx, int ny, int slices, int reach, int side, float stepCost);

}  // namespace pectora::thorax
