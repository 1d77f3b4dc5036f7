#include "plugins/solver/multigrid/hierarchy.h"

#include "kernel/physics/workers.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// Below this many rows and columns a grid is solved directly.
constexpr int kCoarsest = 6;
// The part of the spectrum that smoothing is to damp, and the steps of power iteration that find its upper end.
constexpr float kLowest = 0.25f;
constexpr int kPowerSteps = 8;
// The finest levels cost the most and gain the least from seeing each other's work: additive, a cycle needs no product with
// their matrices, only with their diagonals.
static const std::size_t kAdditiveLevels = getenv("ADD") ? std::size_t(atoi(getenv("ADD"))) : 2;

int coarser(int count) { return count > kCoarsest ? count / 2 + 1 : count; }

// The coarse points from which a fine one is interpolated.
struct Parents {
  std::size_t point[4];
  double weight[4];
  int count = 0;
};

class Interpolation {
 public:
  Interpolation(GridShape fine, GridShape coarse) : fine_(fine), coarse_(coarse) {}

  Parents parents(std::size_t point) const {
    const std::size_t layer = std::size_t(fine_.rows) * fine_.columns;
    const int l = int(point / layer), r = int(point % layer / fine_.columns), c = int(point % fine_.columns);
    int rows[2], columns[2];
    const int rowCount = along(r, fine_.rows, coarse_.rows, rows), columnCount = along(c, fine_.columns, coarse_.columns, columns);
    Parents p;
    for (int i = 0; i < rowCount; ++i)
      for (int j = 0; j < columnCount; ++j) {
        p.point[p.count] = coarse_.number(l, rows[i], columns[j]);
        p.weight[p.count++] = 1.0 / (rowCount * columnCount);
      }
    return p;
  }

  // coarse = P^T fine.
  void restrict(const SingleVectors& fine, SingleVectors& coarse) const {
    parallelFor(std::size_t(coarse_.layers) * coarse_.rows, [&](std::size_t line) {
      const int l = int(line) / coarse_.rows, r = int(line) % coarse_.rows;
      for (auto v : {&SingleVectors::x, &SingleVectors::y, &SingleVectors::z}) {
        float* out = &(coarse.*v)[coarse_.number(l, r, 0)];
        std::fill_n(out, coarse_.columns, 0.0f);
        forEachNear(r, fine_.rows, coarse_.rows, [&](int fineRow, float rowWeight) {
          const float* in = &(fine.*v)[fine_.number(l, fineRow, 0)];
          if (coarse_.columns == fine_.columns) {
            for (int c = 0; c < coarse_.columns; ++c) out[c] += rowWeight * in[c];
            return;
          }
          // Inner columns without a branch, then the edges.
          const int last = coarse_.columns - 1, inner = (fine_.columns - 2) / 2;
          for (int c = 1; c <= std::min(inner, last); ++c) out[c] += rowWeight * (0.5f * (in[2 * c - 1] + in[2 * c + 1]) + in[2 * c]);
          out[0] += rowWeight * (in[0] + 0.5f * in[1]);
          for (int c = inner + 1; c <= last; ++c) {
            if (2 * c - 1 < fine_.columns) out[c] += 0.5f * rowWeight * in[2 * c - 1];
            if (2 * c < fine_.columns) out[c] += rowWeight * in[2 * c];
          }
        });
      }
    });
  }

  // fine += P coarse.
  void prolongate(const SingleVectors& coarse, SingleVectors& fine) const {
    parallelFor(std::size_t(fine_.layers) * fine_.rows, [&](std::size_t line) {
      const int l = int(line) / fine_.rows, r = int(line) % fine_.rows;
      int rows[2];
      const int rowCount = along(r, fine_.rows, coarse_.rows, rows);
      for (auto v : {&SingleVectors::x, &SingleVectors::y, &SingleVectors::z}) {
        float* out = &(fine.*v)[fine_.number(l, r, 0)];
        const float* a = &(coarse.*v)[coarse_.number(l, rows[0], 0)];
        const float* b = &(coarse.*v)[coarse_.number(l, rows[rowCount - 1], 0)];
        if (coarse_.columns == fine_.columns) {
          for (int c = 0; c < fine_.columns; ++c) out[c] += 0.5f * (a[c] + b[c]);
          continue;
        }
        for (int c = 0; 2 * c < fine_.columns; ++c) out[2 * c] += 0.5f * (a[c] + b[c]);
        for (int c = 0; 2 * c + 1 < fine_.columns; ++c) out[2 * c + 1] += 0.25f * (a[c] + a[c + 1] + b[c] + b[c + 1]);
      }
    });
  }

 private:
  static int along(int i, int fine, int coarse, int parents[2]) {
    if (fine == coarse) return parents[0] = i, 1;
    parents[0] = i / 2, parents[1] = i / 2 + 1;
    return i % 2 == 0 ? 1 : 2;
  }
  template <class F>
  static void forEachNear(int i, int fine, int coarse, F&& f) {
    if (fine == coarse) return f(i, 1.0f);
    for (int n = std::max(0, 2 * i - 1); n <= std::min(fine - 1, 2 * i + 1); ++n) f(n, n == 2 * i ? 1.0f : 0.5f);
  }

  GridShape fine_, coarse_;
};

// The Galerkin sum into a coarse matrix.
class Collector {
 public:
  Collector(GridShape fine, GridMatrix& coarse) : interpolation_(fine, coarse.shape()), coarse_(coarse) {}
  void diagonal(std::size_t point, const Symmetric3& d) {
    const Parents p = interpolation_.parents(point);
    const Matrix3 block{{{d.xx, d.xy, d.xz}, {d.xy, d.yy, d.yz}, {d.xz, d.yz, d.zz}}};
    for (int i = 0; i < p.count; ++i) {
      coarse_.addDiagonal(p.point[i], d, p.weight[i] * p.weight[i]);
      for (int j = 0; j < i; ++j) coarse_.addCoupling(p.point[i], p.point[j], block, p.weight[i] * p.weight[j]);
    }
  }
  void coupling(std::size_t a, std::size_t b, const Matrix3& block) {
    const Parents p = interpolation_.parents(a), q = interpolation_.parents(b);
    const auto& m = block.m;
    const Symmetric3 both{2 * m[0][0], m[0][1] + m[1][0], m[0][2] + m[2][0], 2 * m[1][1], m[1][2] + m[2][1], 2 * m[2][2]};
    for (int i = 0; i < p.count; ++i)
      for (int j = 0; j < q.count; ++j) {
        const double weight = p.weight[i] * q.weight[j];
        if (p.point[i] == q.point[j]) coarse_.addDiagonal(p.point[i], both, weight);
        else coarse_.addCoupling(p.point[i], q.point[j], block, weight);
      }
  }

 private:
  Interpolation interpolation_;
  GridMatrix& coarse_;
};

// y = a x + b y, over fixed pieces.
void combine(float a, const SingleVectors& x, float b, SingleVectors& y) {
  constexpr std::size_t kPiece = 16384;
  parallelFor((x.size() + kPiece - 1) / kPiece, [&](std::size_t piece) {
    const std::size_t begin = piece * kPiece, end = std::min(x.size(), begin + kPiece);
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

}  // namespace

struct Hierarchy::Level {
  explicit Level(GridShape shape) : matrix(shape), x(0), b(0), residual(shape.points()), step(shape.points()) {}
  GridMatrix matrix;
  SingleVectors x, b, residual, step;   // x and b of coarse grids only
  float highest = 2;                  // of the spectrum of D^-1 A
};

// The inverse of the coarsest matrix.
struct Hierarchy::Coarsest {
  explicit Coarsest(const GridMatrix& matrix) {
    const Eigen::Index n = 3 * Eigen::Index(matrix.shape().points());
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
    matrix.forEach(
        [&](std::size_t p, const Symmetric3& d) {
          full.block<3, 3>(3 * Eigen::Index(p), 3 * Eigen::Index(p)) << d.xx, d.xy, d.xz, d.xy, d.yy, d.yz, d.xz, d.yz, d.zz;
        },
        [&](std::size_t a, std::size_t b, const Matrix3& block) {
          const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> m(&block.m[0][0]);
          full.block<3, 3>(3 * Eigen::Index(a), 3 * Eigen::Index(b)) = m;
          full.block<3, 3>(3 * Eigen::Index(b), 3 * Eigen::Index(a)) = m.transpose();
        });
    // Coarse points beyond the fine grid's edge may hold nothing, and rounding must not make it indefinite.
    full.diagonal().array() += 1e-6 * full.diagonal().maxCoeff();
    inverse = full.llt().solve(Eigen::MatrixXd::Identity(n, n)).cast<float>();
  }
  Eigen::MatrixXf inverse;
};

Hierarchy::Hierarchy(GridShape fine) : fine_(fine) {}
Hierarchy::~Hierarchy() = default;

void Hierarchy::build(const Hessian& hessian, std::size_t nodes, const Product& multiply) {
  levels_.clear();
  levels_.push_back(std::make_unique<Level>(fine_));
  // The diagonal of the fine grid.
  std::vector<Symmetric3> diagonal(nodes);
  hessian.addDiagonal(diagonal);
  for (std::size_t i = 0; i < fine_.points(); ++i) levels_[0]->matrix.addDiagonal(i, diagonal[i], 1);
  levels_[0]->matrix.finish();

  // Coarser and coarser.
  for (GridShape shape = fine_; coarser(shape.rows) < shape.rows || coarser(shape.columns) < shape.columns;) {
    const GridShape next{shape.layers, coarser(shape.rows), coarser(shape.columns)};
    auto level = std::make_unique<Level>(next);
    level->x = level->b = SingleVectors(next.points());
    Collector collector(shape, level->matrix);
    const auto addDiagonal = [&](std::size_t p, const Symmetric3& d) { collector.diagonal(p, d); };
    const auto addCoupling = [&](std::size_t a, std::size_t b, const Matrix3& m) {
      if (a < shape.points() && b < shape.points()) collector.coupling(a, b, m);
    };
    if (levels_.size() == 1) {
      for (std::size_t i = 0; i < fine_.points(); ++i) addDiagonal(i, diagonal[i]);
      hessian.forEachCoupling(addCoupling);
    } else {
      levels_.back()->matrix.forEach(addDiagonal, addCoupling);
    }
    level->matrix.finish();
    levels_.push_back(std::move(level));
    shape = next;
  }
  coarsest_ = std::make_unique<Coarsest>(levels_.back()->matrix);

  // The upper ends of the spectra, by power iteration from a start that is rough everywhere.
  for (auto& level : levels_) {
    SingleVectors& v = level->residual;
    unsigned random = 1;
    const auto next = [&] { return float(int((random = random * 1664525u + 1013904223u) >> 8)) / float(1 << 23) - 1; };
    for (std::size_t i = 0; i < v.size(); ++i) v.x[i] = next(), v.y[i] = next(), v.z[i] = next();
    double factor = 2;
    for (int n = 0; n < kPowerSteps; ++n) {
      const double before = largest(v);
      SingleVectors product(v.size());
      if (level == levels_.front()) multiply(v, product);
      else level->matrix.multiply(v, product);
      level->matrix.multiplyInverseDiagonal(product, v);
      factor = largest(v) / before;
      if (!(factor > 0 && std::isfinite(factor))) break;
      combine(0, v, float(1 / (factor * before)), v);
    }
    level->highest = 1.1f * float(std::isfinite(factor) ? factor : 2);
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
  const Interpolation interpolation(level.matrix.shape(), coarse.matrix.shape());
  interpolation.restrict(isAdditive ? b : level.residual, coarse.b);
  cycle(index + 1, coarse.b, coarse.x);
  interpolation.prolongate(coarse.x, x);
  if (isAdditive) return;
  // And once more, so that the cycle is symmetric.
  level.matrix.multiply(x, level.residual);
  combine(1, b, -1, level.residual);
  level.matrix.multiplyInverseDiagonal(level.residual, level.step);
  combine(weight, level.step, 1, x);
}

}  // namespace pectora
