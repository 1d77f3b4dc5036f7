#include "plugins/scan/rbf/field.h"

#include "kernel/physics/workers.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr std::size_t kLeaf = 40;      // points of a fine cell, at most
constexpr std::size_t kData = 54;      // points of a ball's fit, at most
constexpr std::size_t kFewest = 24;    // and at least
constexpr int kOffEvery = 3;           // every third point has two beside it off the surface
constexpr double kBend = 0.05;         // how far the surface departs from a plane in a ball, as a share of its radius

struct Cell {
  Vec3 center;
  double half;
  std::vector<std::int32_t> points;
};

// Cells of an octree with few points each, or no larger than a side.
std::vector<Cell> octree(const std::vector<Vec3>& points, std::size_t most, double side) {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (const Vec3& p : points)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  const Vec3 size = high - low;
  Cell root{(low + high) / 2, std::max({size.x, size.y, size.z, 1e-3}) * 0.5001, {}};
  for (std::size_t i = 0; i < points.size(); ++i) root.points.push_back(std::int32_t(i));
  std::vector<Cell> open{std::move(root)}, leaves;
  while (!open.empty()) {
    Cell cell = std::move(open.back());
    open.pop_back();
    const bool isLeaf = most > 0 ? cell.points.size() <= most || cell.half < 1e-3 : 2 * cell.half <= side;
    if (isLeaf) {
      leaves.push_back(std::move(cell));
      continue;
    }
    std::array<Cell, 8> children;
    for (int c = 0; c < 8; ++c) {
      children[c].half = cell.half / 2;
      for (int a = 0; a < 3; ++a) children[c].center[a] = cell.center[a] + (c >> a & 1 ? 0.5 : -0.5) * cell.half;
    }
    for (std::int32_t i : cell.points) {
      int c = 0;
      for (int a = 0; a < 3; ++a) c |= (points[i][a] > cell.center[a]) << a;
      children[c].points.push_back(i);
    }
    for (Cell& child : children)
      if (!child.points.empty()) open.push_back(std::move(child));
  }
  return leaves;
}

// Wendland's C2 function.
double wendland(double r) {
  const double s = 1 - r;
  return r < 1 ? s * s * s * s * (4 * r + 1) : 0;
}

}  // namespace

RbfField::RbfField(const std::vector<Vec3>& points, const std::vector<Vec3>& normals, const Neighbours& tree, const FieldSettings& settings,
                   const std::function<void(double)>& poll) {
  for (const bool isWide : {false, true})
    for (const Cell& cell : octree(points, isWide ? 0 : kLeaf, settings.coarseCell)) {
      Ball ball;
      ball.center = cell.center;
      ball.radius = (isWide ? 2.6 : 1.8) * cell.half;   // the cell's corners lie at 1.73; wide balls reach beyond all data
      ball.isWide = isWide;
      balls_.push_back(std::move(ball));
    }
  constexpr std::size_t kBlock = 8, kRound = 64;
  const std::size_t blocks = (balls_.size() + kBlock - 1) / kBlock;
  for (std::size_t first = 0; first < blocks; first += kRound) {
    poll(double(first) / double(blocks));
    parallelFor(std::min(kRound, blocks - first), [&](std::size_t b) {
      for (std::size_t i = (first + b) * kBlock; i < std::min(balls_.size(), (first + b + 1) * kBlock); ++i) fit(balls_[i], points, normals, tree, settings.noise);
    });
  }
  // A grid of cells as wide as a usual ball, to find the balls around a place.
  std::vector<double> radii;
  for (const Ball& ball : balls_) radii.push_back(ball.radius);
  std::nth_element(radii.begin(), radii.begin() + std::ptrdiff_t(radii.size() / 2), radii.end());
  cell_ = std::max(radii[radii.size() / 2], 1e-3);
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const Ball& ball = balls_[i];
    const int reach = int(std::ceil(ball.radius / cell_));
    for (int dx = -reach; dx <= reach; ++dx)
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dz = -reach; dz <= reach; ++dz) cells_[key(ball.center + Vec3{double(dx), double(dy), double(dz)} * cell_)].push_back(std::int32_t(i));
  }
}

void RbfField::fit(Ball& ball, const std::vector<Vec3>& points, const std::vector<Vec3>& normals, const Neighbours& tree, double noise) const {
  std::vector<std::int32_t> near;
  const std::size_t enough = std::min(kFewest, points.size());
  for (tree.within(ball.center, ball.radius, near); near.size() < enough; tree.within(ball.center, ball.radius, near)) ball.radius *= 1.3;
  if (near.size() > kData) {
    for (std::size_t i = 0; i < kData; ++i) near[i] = near[i * near.size() / kData];
    near.resize(kData);
  }
  // Centres in units of the radius, with their values: on the surface 0, off it the distance.
  std::vector<double> values;
  const auto add = [&](Vec3 p, double value) {
    const Vec3 q = (p - ball.center) / ball.radius;
    ball.x.push_back(q.x), ball.y.push_back(q.y), ball.z.push_back(q.z);
    values.push_back(value / ball.radius);
  };
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Vec3 p = points[near[i]], n = normals[near[i]];
    add(p, 0);
    if (i % kOffEvery != 0) continue;
    // Nearer to the surface until no other part of it is nearer than this one (Carr et al., section 3).
    for (const double side : {1.0, -1.0}) {
      double d = 0.3 * ball.radius;
      for (int tries = 0; tries < 6 && tree.distance(p + n * (side * d)) < 0.7 * d; ++tries) d /= 2;
      add(p + n * (side * d), side * d);
    }
  }
  // [A + k I, P; P^T 0], k the variance of the noise over that of the surface about its plane.
  const Eigen::Index m = Eigen::Index(values.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(m + 4, m + 4);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(m + 4);
  const double smoothing = 1e-6 + std::pow(noise / (kBend * ball.radius), 2);
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double r2 = std::pow(ball.x[i] - ball.x[j], 2) + std::pow(ball.y[i] - ball.y[j], 2) + std::pow(ball.z[i] - ball.z[j], 2);
      system(i, j) = system(j, i) = r2 * std::sqrt(r2);
    }
    system(i, i) = smoothing;
    const double row[4] = {1, ball.x[i], ball.y[i], ball.z[i]};
    for (int a = 0; a < 4; ++a) system(i, m + a) = system(m + a, i) = row[a];
    right(i) = values[i];
  }
  const Eigen::VectorXd solution = system.partialPivLu().solve(right);
  ball.weight.assign(solution.data(), solution.data() + m);
  for (int a = 0; a < 4; ++a) ball.linear[a] = solution(m + a);
}

double RbfField::evaluate(const Ball& ball, Vec3 p) const {
  const Vec3 q = (p - ball.center) / ball.radius;
  double sum = ball.linear[0] + ball.linear[1] * q.x + ball.linear[2] * q.y + ball.linear[3] * q.z;
  for (std::size_t i = 0; i < ball.weight.size(); ++i) {
    const double dx = q.x - ball.x[i], dy = q.y - ball.y[i], dz = q.z - ball.z[i], r2 = dx * dx + dy * dy + dz * dz;
    sum += ball.weight[i] * r2 * std::sqrt(r2);
  }
  return sum * ball.radius;
}

double RbfField::operator()(Vec3 p) const {
  const auto found = cells_.find(key(p));
  if (found == cells_.end()) return std::numeric_limits<double>::quiet_NaN();
  double fine = 0, sum = 0;
  for (std::int32_t i : found->second) {
    const Ball& ball = balls_[i];
    const double w = ball.isWide ? 0 : wendland(distance(p, ball.center) / ball.radius);
    if (w <= 0) continue;
    fine += w;
    sum += w * evaluate(ball, p);
  }
  // Wide balls fade in where the fine ones fade out.
  constexpr double kEnough = 0.05;
  const double fade = fine < kEnough ? std::pow(1 - fine / kEnough, 2) * kEnough : 0;
  double total = fine;
  if (fade > 0)
    for (std::int32_t i : found->second) {
      const Ball& ball = balls_[i];
      const double w = ball.isWide ? fade * wendland(distance(p, ball.center) / ball.radius) : 0;
      if (w <= 0) continue;
      total += w;
      sum += w * evaluate(ball, p);
    }
  return total > 1e-12 ? sum / total : std::numeric_limits<double>::quiet_NaN();
}

std::uint64_t RbfField::key(Vec3 p) const {
  std::uint64_t key = 0;
  for (int a = 0; a < 3; ++a) key = key << 21 | (std::uint64_t(std::int64_t(std::floor(p[a] / cell_)) + (1 << 20)) & 0x1fffff);
  return key;
}

}  // namespace pectora
