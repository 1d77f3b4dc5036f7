#include "plugins/solver/multigrid/hierarchy.h"

#include "plugins/solver/multigrid/coarsening.h"

#include "kernel/physics/workers.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// The part of the spectrum that smoothing is to damp, and the steps of power iteration that find its upper end.
constexpr float kLowest = 0.25f;
constexpr int kPowerSteps = 8, kPowerStepsAgain = 1;
// The finest levels cost the most and gain the least from seeing each other's work: additive, a cycle needs no product with
// their matrices, only with their diagonals.
constexpr std::size_t kAdditiveLevels = 2;

// y = a x + b y, over fixed pieces.
void combine(float a, const SingleVectors& x, float b, SingleVectors& y) {
  constexpr std::size_t kPiece = 16384;
  forEachPiece(x.size(), kPiece, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (auto v : {&SingleVectors::x, &SingleVectors::y, &SingleVectors::z}) {
      const float* in = (x.*v).data();
      float* out = (y.*v).data();
      for (std::size_t i = begin; i < end; ++i) out[i] = a * in[i] + b * out[i];
    }
  });
}

double largest(const SingleVectors& v) {
  double found = 0;
  for (std::size_t i = 0; i < v.size(); ++i) found = std::max({found, std::abs(double(v.x[i])), std::abs(double(v.y[i])), std::abs(double(v.z[i]))});
  return found;
}

// Numbers between -1 and 1, always the same.
void setRandom(SingleVectors& v) {
  unsigned random = 1;
  const auto next = [&] { return float(int((random = random * 1664525u + 1013904223u) >> 8)) / float(1 << 23) - 1; };
  for (std::size_t i = 0; i < v.size(); ++i) v.x[i] = next(), v.y[i] = next(), v.z[i] = next();
}

}  // namespace

struct Hierarchy::Level {
  explicit Level(GridShape shape) : matrix(shape) {}
  GridMatrix matrix;
  SingleVectors x, b;                 // of coarse grids
  SingleVectors residual, step;       // of those that see what others left
  SingleVectors roughest;             // where D^-1 A acts most strongly; kept where that is followed from matrix to matrix
  float highest = 2;                  // of the spectrum of D^-1 A

  Product product() const { return [this](const SingleVectors& in, SingleVectors& out) { matrix.multiply(in, out); }; }
  void findHighest(int steps, const Product& multiply) {
    SingleVectors& v = roughest;
    SingleVectors product(v.size());
    double factor = 2;
    for (int n = 0; n < steps; ++n) {
      const double size = largest(v);
      multiply(v, product);
      matrix.multiplyInverseDiagonal(product, v);
      factor = largest(v) / size;
      if (!(factor > 0 && std::isfinite(factor))) break;
      combine(0, v, float(1 / (factor * size)), v);
    }
    if (!std::isfinite(factor)) setRandom(v);
    highest = 1.1f * float(std::isfinite(factor) ? factor : 2);
  }
};

// The inverse of the coarsest matrix.
struct Hierarchy::Coarsest {
  explicit Coarsest(const GridMatrix& matrix) {
    const Eigen::Index n = 3 * Eigen::Index(matrix.shape().points());
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
    const GridShape shape = matrix.shape();
    matrix.forEachRun([&](GridPoint a, GridPoint b, std::size_t count, const float* const entries[9]) {
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Index p = 3 * Eigen::Index(shape.number(a.layer, a.row, a.column) + i), q = 3 * Eigen::Index(shape.number(b.layer, b.row, b.column) + i);
        for (int e = 0; e < 9; ++e) full(p + e / 3, q + e % 3) = full(q + e % 3, p + e / 3) = double(entries[e][i]);
      }
    });
    // Coarse points beyond the fine grid's edge may hold nothing, and rounding must not make it indefinite.
    full.diagonal().array() += 1e-6 * full.diagonal().maxCoeff();
    inverse = full.llt().solve(Eigen::MatrixXd::Identity(n, n)).cast<float>();
  }
  Eigen::MatrixXf inverse;
};

Hierarchy::Hierarchy(GridShape fine) : fine_(fine) {}
Hierarchy::~Hierarchy() = default;
Hierarchy& Hierarchy::operator=(Hierarchy&&) noexcept = default;

void Hierarchy::build(const Hessian& hessian, std::size_t nodes, const Product& multiply) {
  std::vector<std::unique_ptr<Level>> before = std::move(levels_);
  levels_.clear();
  levels_.push_back(std::make_unique<Level>(fine_));
  // Of the fine grid the diagonal alone.
  {
    std::vector<Symmetric3> diagonal(nodes);
    hessian.addDiagonal(diagonal);
    levels_[0]->matrix.addDiagonal(diagonal);
    levels_[0]->matrix.finish();
  }

  // Coarser and coarser.
  for (GridShape shape = fine_; coarser(shape).points() < shape.points(); shape = coarser(shape)) {
    auto level = std::make_unique<Level>(coarser(shape));
    level->x = level->b = SingleVectors(level->matrix.shape().points());
    Collector collector(shape, level->matrix);
    collector.add(levels_.back()->matrix);
    if (levels_.size() == 1)
      hessian.forEachCouplingRun(
          [&](std::size_t p, std::size_t q, std::size_t count, const float* const entries[9]) {
            if (p < fine_.points() && q < fine_.points()) collector.run(p, q, count, entries);
          },
          [&](std::size_t p, std::size_t q, const Matrix3& block) { collector.coupling(p, q, block); });
    level->matrix.finish();
    levels_.push_back(std::move(level));
  }
  coarsest_ = std::make_unique<Coarsest>(levels_.back()->matrix);

  // The upper ends of the spectra, by power iteration: from a start that is rough everywhere, or from where the last one ended. On the finest
  // levels they are but weights, and those of similar matrices do.
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = *levels_[i];
    const bool isAdditive = i < kAdditiveLevels;
    if (before.empty()) {
      level.roughest = SingleVectors(level.matrix.shape().points());
      setRandom(level.roughest);
      level.findHighest(kPowerSteps, i == 0 ? multiply : level.product());
    } else {
      level.highest = before[i]->highest;
      level.roughest = std::move(before[i]->roughest);
      if (!isAdditive) level.findHighest(kPowerStepsAgain, level.product());
    }
    if (isAdditive) {
      level.matrix.keepInverseDiagonal();
      level.roughest = SingleVectors();
    } else {
      level.residual = level.step = SingleVectors(level.roughest.size());
    }
  }
}

void Hierarchy::cycle(const SingleVectors& b, SingleVectors& x) { cycle(0, b, x); }

void Hierarchy::cycle(std::size_t index, const SingleVectors& b, SingleVectors& x) {
  Level& level = *levels_[index];
  if (index + 1 == levels_.size()) {
    const Eigen::Index n = Eigen::Index(b.size());
    Eigen::VectorXf right(3 * n);
    for (Eigen::Index i = 0; i < n; ++i) right.segment<3>(3 * i) << b.x[std::size_t(i)], b.y[std::size_t(i)], b.z[std::size_t(i)];
    const Eigen::VectorXf solved = coarsest_->inverse * right;
    for (Eigen::Index i = 0; i < n; ++i) x.x[std::size_t(i)] = solved[3 * i], x.y[std::size_t(i)] = solved[3 * i + 1], x.z[std::size_t(i)] = solved[3 * i + 2];
    return;
  }
  // One step of Richardson's method, the best for the upper part of the spectrum: x = w D^-1 b. The finest levels add the
  // coarser answer to it as it is; from there on, each level sees what the others left.
  const float weight = 2 / (level.highest * (1 + kLowest));
  level.matrix.multiplyInverseDiagonal(b, x);
  combine(0, x, weight, x);
  const bool isAdditive = index < kAdditiveLevels;
  if (!isAdditive) {
    level.matrix.multiply(x, level.residual);
    combine(1, b, -1, level.residual);
  }
  Level& coarse = *levels_[index + 1];
  restrict(level.matrix.shape(), isAdditive ? b : level.residual, coarse.matrix.shape(), coarse.b);
  cycle(index + 1, coarse.b, coarse.x);
  prolongate(coarse.matrix.shape(), coarse.x, level.matrix.shape(), x);
  if (isAdditive) return;
  // And once more, so that the cycle is symmetric.
  level.matrix.multiply(x, level.residual);
  combine(1, b, -1, level.residual);
  level.matrix.multiplyInverseDiagonal(level.residual, level.step);
  combine(weight, level.step, 1, x);
}

}  // namespace pectora
