#include "plugins/effect/common/volume_hessian.h"

#include <cmath>

namespace pectora::cells {
namespace {

std::size_t nodeOf(const CellRowPlace& p, int corner) { return p.nodes[corner >> 1] + std::size_t(corner & 1); }

}  // namespace

// Of a row of cells: what is on the diagonals, at the corners.
class VolumeHessian::CornerGradients {
 public:
  explicit CornerGradients(std::size_t count) : count_(count), room_(24 * count) {}
  float* row(int corner, int axis) { return &room_[std::size_t(3 * corner + axis) * count_]; }
  void take(CellNumbers<const float> g) {
    enum { P, Q, R, S, T, U };
    for (int axis = 0; axis < 3; ++axis) {
      const auto on = [&](int diagonal) { return g.row(3 * diagonal + axis); };
      for (std::size_t i = 0; i < count_; ++i) {
        row(0, axis)[i] = -(on(P)[i] + on(S)[i] + on(U)[i]);
        row(1, axis)[i] = -on(Q)[i];
        row(2, axis)[i] = -on(R)[i];
        row(3, axis)[i] = on(U)[i];
        row(4, axis)[i] = -on(T)[i];
        row(5, axis)[i] = on(S)[i];
        row(6, axis)[i] = on(P)[i];
        row(7, axis)[i] = on(Q)[i] + on(R)[i] + on(T)[i];
      }
    }
  }

 private:
  std::size_t count_;
  std::vector<float> room_;
};

// The blocks between the corners of rows of cells.
class VolumeHessian::Pairs {
 public:
  explicit Pairs(const VolumeHessian& hessian) : hessian_(hessian), count_(hessian.rest_.rows.count()), gradients_(count_), room_(9 * count_) {}
  template <class F>
  void forEach(const CellRowPlace& p, F&& run) {
    gradients_.take(hessian_.gradientsOf(p));
    const float* entries[9];
    for (std::size_t e = 0; e < 9; ++e) entries[e] = &room_[e * count_];
    for (int a = 0; a < 8; ++a)
      for (int b = a + 1; b < 8; ++b) {
        for (int e = 0; e < 9; ++e)
          for (std::size_t i = 0; i < count_; ++i) room_[std::size_t(e) * count_ + i] = gradients_.row(a, e / 3)[i] * gradients_.row(b, e % 3)[i];
        if (!hessian_.projected_) addTurnedBlocks(p, a, b);
        run(nodeOf(p, a), nodeOf(p, b), count_, entries);
      }
  }

 private:
  void addTurnedBlocks(const CellRowPlace& p, int a, int b);

  const VolumeHessian& hessian_;
  std::size_t count_;
  CornerGradients gradients_;
  std::vector<float> room_;
};

VolumeHessian::VolumeHessian(const RestVolumes& rest) : rest_(rest), gradients_(kOnDiagonals * rest.rows.cells()) {}

void VolumeHessian::linearise(const NodeVectors& positions, bool projected) {
  projected_ = projected;
  if (!projected) {
    diagonals_.resize(gradients_.size());
    pressure_.resize(rest_.rows.cells());
  }
  const std::size_t count = rest_.rows.count();
  rest_.rows.grid().forEachBlock([&](int, int begin, int end) {
    std::vector<double> room((kOnDiagonals + 1) * count);
    const CellNumbers<double> derivatives{&room[count], count};
    rest_.rows.forEachRow(begin, end, [&](const CellRowPlace& p) {
      const auto x = CellRows::corners(positions, p);
      volumes(count, x, room.data(), derivatives);
      float* g = &gradients_[kOnDiagonals * p.cell];
      for (int n = 0; n < kOnDiagonals; ++n)
        for (std::size_t i = 0; i < count; ++i) *g++ = float(std::sqrt(rest_.stiffness[p.cell + i]) * derivatives.row(n)[i]);
      if (projected) return;
      diagonalsOf(count, x, {&diagonals_[kOnDiagonals * p.cell], count});
      for (std::size_t i = 0; i < count; ++i) pressure_[p.cell + i] = float(rest_.stiffness[p.cell + i] * (room[i] - rest_.volume[p.cell + i]));
    });
  });
}

void VolumeHessian::addDiagonal(std::vector<Symmetric3>& blocks) const {
  rest_.rows.grid().forEachBlock([&](int, int begin, int end) {
    CornerGradients gradients(rest_.rows.count());
    rest_.rows.forEachRow(begin, end, [&](const CellRowPlace& p) {
      gradients.take(gradientsOf(p));
      for (int a = 0; a < 8; ++a)
        for (std::size_t i = 0; i < rest_.rows.count(); ++i) {
          const double x = double(gradients.row(a, 0)[i]), y = double(gradients.row(a, 1)[i]), z = double(gradients.row(a, 2)[i]);
          blocks[nodeOf(p, a) + i] += {x * x, x * y, x * z, y * y, y * z, z * z};
        }
    });
  });
}

void VolumeHessian::addBound(const NodeVectors& positions, std::vector<double>& bound) {
  linearise(positions, true);
  const std::size_t count = rest_.rows.count();
  CornerGradients gradients(count);
  rest_.rows.forEachRow(0, rest_.rows.grid().rows(), [&](const CellRowPlace& p) {
    gradients.take(gradientsOf(p));
    for (std::size_t i = 0; i < count; ++i) {
      double norms[8], sum = 0;
      for (int a = 0; a < 8; ++a) {
        norms[a] = norm(Vec3{double(gradients.row(a, 0)[i]), double(gradients.row(a, 1)[i]), double(gradients.row(a, 2)[i])});
        sum += norms[a];
      }
      for (int a = 0; a < 8; ++a) bound[nodeOf(p, a) + i] += norms[a] * sum;
    }
  });
}

void VolumeHessian::forEachCoupling(const Coupling& visit) const {
  Pairs pairs(*this);
  rest_.rows.forEachRow(0, rest_.rows.grid().rows(), [&](const CellRowPlace& p) {
    pairs.forEach(p, [&](std::size_t a, std::size_t b, std::size_t count, const float* const entries[9]) {
      for (std::size_t i = 0; i < count; ++i) {
        Matrix3 block;
        for (int e = 0; e < 9; ++e) block.m[e / 3][e % 3] = double(entries[e][i]);
        visit(a + i, b + i, block);
      }
    });
  });
}

// Blocks of the grid at work at one time are four rows apart, and reach one row on.
void VolumeHessian::forEachCouplingRun(const CouplingRun& run, const Coupling&) const {
  rest_.rows.grid().forEachBlock([&](int, int begin, int end) {
    Pairs pairs(*this);
    rest_.rows.forEachRow(begin, end, [&](const CellRowPlace& p) { pairs.forEach(p, run); });
  });
}

template <class Vectors>
void VolumeHessian::multiplyAny(const Vectors& v, Vectors& y) const {
  const std::size_t count = rest_.rows.count();
  rest_.rows.grid().forEachBlock([&](int, int begin, int end) {
    std::vector<double> room(kOnDiagonals * count);
    const CellNumbers<double> numbers{room.data(), count};
    rest_.rows.forEachRow(begin, end, [&](const CellRowPlace& p) {
      const auto corners = CellRows::corners(v, p);
      projectOnto(count, gradientsOf(p), corners, numbers);
      if (!projected_) addTurned(count, &pressure_[p.cell], {&diagonals_[kOnDiagonals * p.cell], count}, corners, numbers);
      rest_.rows.addToCorners(p, numbers, y);
    });
  });
}

// Between corners a and b the pressure turns forces by the matrix [0 t2 -t1; -t2 0 t0; t1 -t0 0], with t the sum of diagonals that follows
// from the three determinants of the volume.
void VolumeHessian::Pairs::addTurnedBlocks(const CellRowPlace& place, int a, int b) {
  // At which corners the diagonals p to u end and begin, and of which of them the columns of the determinants are made.
  constexpr int kEnds[kDiagonals][2] = {{6, 0}, {7, 1}, {7, 2}, {5, 0}, {7, 4}, {3, 0}};
  constexpr bool kColumns[3][3][kDiagonals] = {{{1, 1, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0}, {0, 0, 0, 0, 0, 1}},
                                               {{1, 0, 0, 0, 0, 0}, {0, 0, 1, 1, 0, 0}, {0, 0, 0, 0, 1, 0}},
                                               {{0, 1, 0, 0, 0, 0}, {0, 0, 0, 1, 0, 0}, {0, 0, 0, 0, 1, 1}}};
  int parts[kDiagonals] = {};
  for (const auto& columns : kColumns) {
    int of[3][2] = {};   // what corners a and b are in each column
    for (int m = 0; m < 3; ++m)
      for (int n = 0; n < kDiagonals; ++n)
        for (int side = 0; side < 2; ++side) {
          const int corner = side == 0 ? a : b;
          of[m][side] += int(columns[m][n]) * (int(kEnds[n][0] == corner) - int(kEnds[n][1] == corner));
        }
    for (int m = 0; m < 3; ++m) {
      const int next = (m + 1) % 3, last = (m + 2) % 3, share = of[next][0] * of[last][1] - of[last][0] * of[next][1];
      for (int n = 0; n < kDiagonals; ++n) parts[n] += share * int(columns[m][n]);
    }
  }
  const CellNumbers<const float> diagonals{&hessian_.diagonals_[kOnDiagonals * place.cell], count_};
  const float* pressure = &hessian_.pressure_[place.cell];
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < count_; ++i) {
      float t = 0;
      for (int n = 0; n < kDiagonals; ++n) t += float(parts[n]) * diagonals.row(3 * n + axis)[i];
      t *= -pressure[i] / 12;
      const int j = (axis + 1) % 3, k = (axis + 2) % 3;
      room_[std::size_t(3 * j + k) * count_ + i] += t;
      room_[std::size_t(3 * k + j) * count_ + i] -= t;
    }
}

}  // namespace pectora::cells
