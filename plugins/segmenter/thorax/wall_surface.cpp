#include "plugins/segmenter/thorax/pleura.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr double kRowMm = 2.5;
constexpr double kNearMm = 40, kNearPull = 1e-5, kFarPull = 1e-3;

double quantileOf(std::vector<double>& v, double part) {
  const auto at = v.begin() + std::ptrdiff_t(part * double(v.size() - 1));
  std::nth_element(v.begin(), at, v.end());
  return *at;
}

}  // namespace

UsualWall usualWall(const std::vector<WallSample>& samples, const std::vector<WallSample>& lung,
                    const std::vector<std::vector<double>>& skinRadius,
                    int firstSlice, double sliceSpacing) {
  constexpr int angles = PolarGrid::kAngles;
  const int slices = int(skinRadius.size());
  // Radii and depths below the skin that occur within 6 degrees of each angle.
  std::vector<double> radius(angles, -1), large(angles, -1), depth(angles, -1);
  std::vector<std::vector<double>> radii(angles), depths(angles), outermost(angles);
  std::vector<std::vector<char>> isKnown(angles, std::vector<char>(slices, 0));
  for (const WallSample& s : lung) {
    const int n = std::clamp(int(std::lround(s.angleIndex)), 0, angles - 1);
    for (int m = std::max(0, n - 4); m <= std::min(angles - 1, n + 4); ++m) outermost[m].push_back(s.radius);
  }
  for (const WallSample& s : samples) {
    const int n = std::clamp(int(std::lround(s.angleIndex)), 0, angles - 1);
    const int row = std::clamp(int(std::lround(s.slice)) - firstSlice, 0, slices - 1);
    for (int m = std::max(0, n - 4); m <= std::min(angles - 1, n + 4); ++m) {
      isKnown[m][row] = 1;
      radii[m].push_back(s.radius);
      if (skinRadius[row][n] > s.radius) depths[m].push_back(skinRadius[row][n] - s.radius);
    }
  }
  for (int n = 0; n < angles; ++n)
    for (int d = 0; d < angles && radius[n] < 0; ++d)
      for (int m : {n - d, n + d})
        if (m >= 0 && m < angles && radius[n] < 0 && !radii[m].empty() && !depths[m].empty()) {
          radius[n] = quantileOf(radii[m], 0.5), depth[n] = quantileOf(depths[m], 0.1);
          large[n] = quantileOf(radii[m], 0.97);
          if (!outermost[m].empty()) large[n] = std::max(large[n], quantileOf(outermost[m], 0.97));
        }
  UsualWall usual;
  usual.radius.resize(std::size_t(slices) * angles);
  usual.weight.assign(usual.radius.size(), kFarPull);
  for (int s = 0; s < slices; ++s)
    for (int n = 0; n < angles; ++n) {
      // In front the wall follows the skin, within what occurs; at the sides there may be arms, and it stays in.
      const bool isFront = std::abs(PolarGrid::degrees(n)) <= 60;
      // What covers one side alone (a breast, fluid behind the wall) does not make the wall thicker below it.
      const double thinner = std::min(depth[n], depth[angles - 1 - n]);
      const double below = skinRadius[s][n] > 0 ? skinRadius[s][n] - thinner : radius[n];
      usual.radius[std::size_t(s) * angles + n] = std::max(1.0, std::min(isFront ? large[n] : radius[n], below));
    }
  const int reach = int(kNearMm / sliceSpacing);
  for (int n = 0; n < angles; ++n)
    for (int s = 0; s < slices; ++s)
      for (int t = isKnown[n][s] ? std::max(0, s - reach) : slices; t <= std::min(slices - 1, s + reach); ++t)
        usual.weight[std::size_t(t) * angles + n] = kNearPull;
  return usual;
}

std::vector<double> fitWall(const std::vector<WallSample>& samples, const UsualWall& usual, int firstSlice,
                            int lastSlice, double sliceSpacing, double stiffness) {
  constexpr int angles = PolarGrid::kAngles;
  const int slices = lastSlice - firstSlice + 1;
  const int stride = std::max(1, int(kRowMm / sliceSpacing)), rows = (slices - 1 + stride - 1) / stride + 1;
  const int unknowns = rows * angles;

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
      const std::size_t at = std::size_t(std::min(j * stride, slices - 1)) * angles + i;
      add(&n, &one, 1, usual.weight[at], usual.radius[at]);
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
