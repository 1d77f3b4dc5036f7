#include "plugins/segmenter/thorax/pleura.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr double kRowMm = 2.5;
constexpr double kPull = 1e-4;      // towards each angle's median

double medianOf(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
  return v[v.size() / 2];
}

}  // namespace

std::vector<double> fitWall(const std::vector<WallSample>& samples, int firstSlice, int lastSlice, double sliceSpacing,
                            double stiffness) {
  constexpr int angles = PolarGrid::kAngles;
  const int slices = lastSlice - firstSlice + 1;
  const int stride = std::max(1, int(kRowMm / sliceSpacing)), rows = (slices - 1 + stride - 1) / stride + 1;
  const int unknowns = rows * angles;

  // What each angle's median is; angles without samples take the nearest one's.
  std::vector<std::vector<double>> perAngle(angles);
  for (const WallSample& s : samples) perAngle[std::clamp(int(std::lround(s.angleIndex)), 0, angles - 1)].push_back(s.radius);
  std::vector<double> usual(angles, -1);
  for (int n = 0; n < angles; ++n)
    for (int d = 0; d < angles && usual[n] < 0; ++d)
      for (int m : {n - d, n + d})
        if (m >= 0 && m < angles && !perAngle[m].empty() && usual[n] < 0) usual[n] = medianOf(perAngle[m]);

  // Normal equations: samples (bilinear), thin plate, pull.
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  const auto add = [&](const int* at, const double* weight, int count, double factor, double value) {
    for (int a = 0; a < count; ++a) {
      right[at[a]] += factor * weight[a] * value;
      for (int b = 0; b < count; ++b) entries.emplace_back(at[a], at[b], factor * weight[a] * weight[b]);
    }
  };
  for (const WallSample& s : samples) {
    const double x = std::clamp(s.angleIndex, 0.0, angles - 1.0);
    const double y = std::clamp((s.slice - firstSlice) / stride, 0.0, rows - 1.0);
    const int i = std::min(int(x), angles - 2), j = std::min(int(y), std::max(0, rows - 2)), up = rows > 1 ? angles : 0;
    const double u = x - i, v = y - j;
    const int at[4] = {j * angles + i, j * angles + i + 1, j * angles + i + up, j * angles + i + 1 + up};
    const double weight[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    add(at, weight, rows > 1 ? 4 : 2, s.weight, s.radius);
  }
  // Steps in mm (angles at a radius of 100 mm) make the plate equally stiff both ways.
  const double dx = PolarGrid::kStepDeg * 0.0174533 * 100 / kRowMm, dy = stride * sliceSpacing / kRowMm;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < angles; ++i) {
      const int n = j * angles + i;
      if (i > 0 && i + 1 < angles) {
        const int at[3] = {n - 1, n, n + 1};
        const double weight[3] = {1 / (dx * dx), -2 / (dx * dx), 1 / (dx * dx)};
        add(at, weight, 3, stiffness, 0);
      }
      if (j > 0 && j + 1 < rows) {
        const int at[3] = {n - angles, n, n + angles};
        const double weight[3] = {1 / (dy * dy), -2 / (dy * dy), 1 / (dy * dy)};
        add(at, weight, 3, stiffness, 0);
      }
      if (i + 1 < angles && j + 1 < rows) {
        const int at[4] = {n, n + 1, n + angles, n + angles + 1};
        const double weight[4] = {1 / (dx * dy), -1 / (dx * dy), -1 / (dx * dy), 1 / (dx * dy)};
        add(at, weight, 4, 2 * stiffness, 0);
      }
      const double one = 1;
      add(&n, &one, 1, kPull, usual[i]);
    }
  Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::VectorXd solution = solver.solve(right);

  std::vector<double> radius(std::size_t(slices) * angles);
  for (int s = 0; s < slices; ++s) {
    const double y = double(s) / stride;
    const int j = std::min(int(y), std::max(0, rows - 2)), up = rows > 1 ? angles : 0;
    for (int i = 0; i < angles; ++i)
      radius[std::size_t(s) * angles + i] =
          solution[j * angles + i] + (y - j) * (solution[j * angles + i + up] - solution[j * angles + i]);
  }
  return radius;
}

}  // namespace pectora::thorax
