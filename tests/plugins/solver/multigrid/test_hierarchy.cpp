// The coarse grids and the cycle.
#include "plugins/solver/multigrid/coarsening.h"
#include "plugins/solver/multigrid/hierarchy.h"

#include "tests/plugins/solver/multigrid/walls.h"

#include "kernel/physics/workers.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <random>

using namespace pectora;

namespace {

constexpr double kSingle = 1.2e-7;   // relative spacing of single precision

SingleVectors noise(std::size_t points, unsigned seed) {
  SingleVectors v(points);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-1, 1);
  for (std::size_t i = 0; i < points; ++i) v.set(i, {jitter(random), jitter(random), jitter(random)});
  return v;
}

double inner(const SingleVectors& a, const SingleVectors& b) {
  double total = 0;
  for (std::size_t i = 0; i < a.size(); ++i) total += dot(a[i], b[i]);
  return total;
}

Matrix3 randomBlock(std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-1, 1);
  Matrix3 block;
  for (auto& row : block.m)
    for (double& e : row) e = entry(random);
  return block;
}

struct Prepared {
  System system;
  std::unique_ptr<Hessian> hessian;
  Hierarchy hierarchy;

  explicit Prepared(int n) : system(fineWall(n)), hessian(makeHessian(system)), hierarchy({2, n, n}) {
    hessian->linearise(system.rest, true);
    hierarchy.build(*hessian, system.rest.size(), [&](const SingleVectors& in, SingleVectors& out) { multiply(in, out); });
  }
  void multiply(const SingleVectors& in, SingleVectors& out) const {
    out.clear();
    hessian->multiplySingle(in, out);
  }
};

}  // namespace

TEST(GridMatrix, MultipliesAsTheFullMatrixDoes) {
  const GridShape shape{3, 7, 6};
  GridMatrix matrix(shape);
  const Eigen::Index n = 3 * Eigen::Index(shape.points());
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
  std::mt19937 random(3);
  // Random blocks between random near points, also turned round, and on the diagonal.
  for (int k = 0; k < 2000; ++k) {
    const auto pick = [&](int count) { return int(random() % unsigned(count)); };
    const int r = pick(7), c = pick(6), r2 = std::clamp(r + pick(5) - 2, 0, 6), c2 = std::clamp(c + pick(5) - 2, 0, 5);
    const std::size_t a = shape.number(pick(3), r, c), b = shape.number(pick(3), r2, c2);
    const Matrix3 block = randomBlock(random);
    const Eigen::Matrix3d m = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&block.m[0][0]);
    const auto at = [&](std::size_t i, std::size_t j) { return full.block<3, 3>(3 * Eigen::Index(i), 3 * Eigen::Index(j)); };
    float numbers[9];
    const float* entries[9];
    for (int e = 0; e < 9; ++e) numbers[e] = float(block.m[e / 3][e % 3]), entries[e] = &numbers[e];
    matrix.add(shape.point(a), shape.point(b), 1, entries, 0.5);
    at(a, b) += 0.5 * m;
    at(b, a) += 0.5 * m.transpose();
  }
  const SingleVectors x = noise(shape.points(), 1);
  SingleVectors y(shape.points());
  matrix.multiply(x, y);
  Eigen::VectorXd dense(n);
  for (std::size_t i = 0; i < shape.points(); ++i) dense.segment<3>(3 * Eigen::Index(i)) << x[i].x, x[i].y, x[i].z;
  const Eigen::VectorXd expected = full * dense;
  // Some 100 products of single precision a row.
  for (std::size_t i = 0; i < shape.points(); ++i)
    EXPECT_LT((expected.segment<3>(3 * Eigen::Index(i)) - Eigen::Vector3d(y[i].x, y[i].y, y[i].z)).norm(), 100 * 20 * kSingle);
}

// Grids of odd and even counts, and one that is made coarser along one direction only.
TEST(Coarsening, GivesTheMatrixOfTheInterpolatedMovement) {
  for (const auto& [rows, columns] : {std::pair{17, 17}, {16, 21}, {5, 24}}) {
    System system = fineWall(std::max(rows, columns));
    system.rows = rows, system.columns = columns;
    system.freeNodes = 2 * std::size_t(rows) * columns;
    NodeVectors rest(system.freeNodes);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const std::size_t point = i % system.points();
      rest.set(i, {2.0 * double(point % columns), i < system.points() ? -20.0 : 0.0, 2.0 * double(point / columns)});
    }
    system.rest = rest;
    std::vector<StencilSpring> stencil;
    for (int r = -2; r <= 2; ++r)
      for (int c = -2; c <= 2; ++c) stencil.push_back({Layer::outer, Layer::inner, r, c, 1 + 0.1 * r + 0.03 * c});
    stencil.push_back({Layer::outer, Layer::outer, 0, 1, 0.7});
    stencil.push_back({Layer::outer, Layer::outer, 2, -1, 0.4});
    system.terms.clear();
    system.terms.push_back(makeLatticeTerm("lattice", system, stencil));
    const auto hessian = makeHessian(system);
    NodeVectors moved = rest;
    for (std::size_t i = 0; i < moved.size(); ++i) moved.y[i] -= 3 * std::sin(0.2 * moved.x[i]) * std::cos(0.1 * moved.z[i]);
    hessian->linearise(moved, true);

    const GridShape fine{2, rows, columns}, coarse = coarser(fine);
    GridMatrix matrix(coarse), diagonalOnly(fine);
    Collector collector(fine, matrix);
    std::vector<Symmetric3> diagonal(system.rest.size());
    hessian->addDiagonal(diagonal);
    diagonalOnly.addDiagonal(diagonal);
    collector.add(diagonalOnly);
    hessian->forEachCouplingRun([&](std::size_t a, std::size_t b, std::size_t n, const float* const e[9]) { collector.run(a, b, n, e); },
                                [&](std::size_t a, std::size_t b, const Matrix3& m) { collector.coupling(a, b, m); });
    matrix.finish();

    // (P x) . A (P y) = x . (P^T A P) y, for some x and y.
    for (unsigned seed : {1u, 2u, 3u}) {
      const SingleVectors x = noise(coarse.points(), seed), y = noise(coarse.points(), seed + 10);
      SingleVectors px(fine.points()), py(fine.points()), apy(fine.points()), cy(coarse.points());
      prolongate(coarse, x, fine, px);
      prolongate(coarse, y, fine, py);
      hessian->multiplySingle(py, apy);
      matrix.multiply(y, cy);
      const double scale = std::sqrt(inner(px, px) * inner(apy, apy));
      EXPECT_NEAR(inner(px, apy), inner(x, cy), 100 * kSingle * scale) << rows << " x " << columns;
    }
  }
}

TEST(Hierarchy, CycleIsSymmetricAndPositive) {
  Prepared wall(33);
  const std::size_t points = 2 * 33 * 33;
  SingleVectors mu(points), mv(points);
  for (unsigned seed = 1; seed < 8; ++seed) {
    const SingleVectors u = noise(points, seed), v = noise(points, seed + 20);
    wall.hierarchy.cycle(u, mu);
    wall.hierarchy.cycle(v, mv);
    // Rounding of each of some 6000 products, with random signs, against their common size.
    const double size = std::sqrt(inner(u, u) * inner(mv, mv));
    EXPECT_NEAR(inner(u, mv), inner(v, mu), 100 * kSingle * size);
    EXPECT_GT(inner(u, mu), 0);
  }
}

TEST(Hierarchy, ConditionDoesNotGrowWithThePoints) {
  // The largest and the smallest eigenvalue of M^-1 H, by Rayleigh quotients over random and smooth vectors.
  std::vector<double> conditions;
  for (const int n : {17, 33, 65}) {
    Prepared wall(n);
    const std::size_t points = 2 * std::size_t(n) * n;
    // Power iteration for the largest, and, shifted by it, for the smallest.
    const auto extreme = [&](double shift) {
      SingleVectors v = noise(points, 1), hv(points), mhv(points);
      double value = 0;
      for (int k = 0; k < 60; ++k) {
        wall.multiply(v, hv);
        wall.hierarchy.cycle(hv, mhv);
        double norm = 0;
        for (std::size_t i = 0; i < points; ++i) {
          const Vec3 next = mhv[i] - v[i] * shift;
          norm += dot(next, next);
          mhv.set(i, next);
        }
        norm = std::sqrt(norm);
        value = norm / std::sqrt(inner(v, v));
        for (std::size_t i = 0; i < points; ++i) v.set(i, mhv[i] / norm);
      }
      return value;
    };
    const double highest = extreme(0), lowest = highest - extreme(highest);
    EXPECT_GT(lowest, 0);
    conditions.push_back(highest / lowest);
  }
  // Without coarse grids it grows about fourfold from each size to the next until the wall's thickness stops it.
  EXPECT_LT(conditions.back(), 2 * conditions.front()) << conditions[0] << " " << conditions[1] << " " << conditions[2];
  EXPECT_LT(conditions.back(), 25);
}

TEST(Hierarchy, GivesTheSameBitsForAnyNumberOfThreads) {
  const int before = threads();
  std::vector<SingleVectors> answers;
  for (const int count : {1, 2, 8}) {
    setThreads(count);
    Prepared wall(41);
    answers.emplace_back(2 * 41 * 41);
    wall.hierarchy.cycle(noise(2 * 41 * 41, 1), answers.back());
    EXPECT_EQ(answers.back().x, answers.front().x) << count;
    EXPECT_EQ(answers.back().z, answers.front().z) << count;
  }
  setThreads(before);
}
