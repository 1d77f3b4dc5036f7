#include "kernel/physics/springs.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// A spring shorter than this part of its rest length has no direction of its own.
constexpr double kDegenerate = 1e-12;

// Force on the near end of a spring and its energy.
struct SpringPull {
  Vec3 force;
  double energy;
  double magnitude;
};

SpringPull pull(Vec3 near, Vec3 far, double restLength, Vec3 restDirection, double stiffness, double compression) {
  const Vec3 d = far - near;
  const double length = norm(d);
  const Vec3 direction = length > kDegenerate * restLength && length > 0 ? d / length : restDirection;
  const double tension = (length < restLength ? compression * stiffness : stiffness) * (length - restLength);
  return {direction * tension, 0.5 * tension * (length - restLength), std::abs(tension)};
}

class LatticeTerm final : public Term {
 public:
  LatticeTerm(std::string name, const System& system, std::vector<StencilSpring> stencil)
      : name_(std::move(name)), rows_(system.rows), columns_(system.columns), rest_(system.rest) {
    // Every spring is seen from both of its ends, so that points can be evaluated independently.
    for (const StencilSpring& s : stencil) {
      arms_[int(s.from)].push_back({int(s.to), s.rows, s.columns, s.stiffnessNPerMm, s.compression});
      arms_[int(s.to)].push_back({int(s.from), -s.rows, -s.columns, s.stiffnessNPerMm, s.compression});
    }
    const std::size_t points = std::size_t(rows_) * columns_;
    for (int layer = 0; layer < 2; ++layer) {
      restLengths_[layer].assign(points * arms_[layer].size(), 0.0);
      forEachSpring(layer, 0, rows_, [&](std::size_t node, std::size_t other, std::size_t slot, const Arm&) {
        restLengths_[layer][slot] = distance(rest_[node], rest_[other]);
      });
    }
  }

  std::string name() const override { return name_; }

  double energy(const NodeVectors& positions) const override {
    return sum(positions, nullptr, nullptr);
  }

  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const override {
    return sum(positions, &gradient, &largestForce);
  }

  void addStiffnessBound(std::vector<double>& bound) const override {
    for (int layer = 0; layer < 2; ++layer)
      forEachSpring(layer, 0, rows_, [&](std::size_t node, std::size_t, std::size_t, const Arm& arm) {
        bound[node] += 2 * arm.stiffness;
      });
  }

 private:
  // One spring as seen from a point.
  struct Arm {
    int layer, rows, columns;
    double stiffness, compression;
  };

  // Calls f(node, other node, slot of the rest length, arm) for every spring end in some rows of a layer.
  template <class F>
  void forEachSpring(int layer, int rowBegin, int rowEnd, F&& f) const {
    const std::size_t layerPoints = std::size_t(rows_) * columns_;
    for (int r = rowBegin; r < rowEnd; ++r) {
      for (int c = 0; c < columns_; ++c) {
        const std::size_t point = std::size_t(r) * columns_ + c;
        std::size_t slot = point * arms_[layer].size();
        for (const Arm& arm : arms_[layer]) {
          const int row = r + arm.rows, column = c + arm.columns;
          if (row >= 0 && row < rows_ && column >= 0 && column < columns_)
            f(layer * layerPoints + point, arm.layer * layerPoints + std::size_t(row) * columns_ + column, slot, arm);
          ++slot;
        }
      }
    }
  }

  // One task a block of rows of one layer. Blocks and the order of their sums never depend on the threads.
  double sum(const NodeVectors& positions, NodeVectors* gradient, double* largestForce) const {
    constexpr int kBlock = 8;
    const std::size_t blocks = (rows_ + kBlock - 1) / kBlock;
    std::vector<double> energies(2 * blocks, 0.0), largest(2 * blocks, 0.0);
    parallelFor(2 * blocks, [&](std::size_t task) {
      const int layer = task >= blocks;
      const int begin = int(task % blocks) * kBlock, end = std::min(rows_, begin + kBlock);
      forEachSpring(layer, begin, end, [&](std::size_t node, std::size_t other, std::size_t slot, const Arm& arm) {
        const Vec3 restDirection = normalized(rest_[other] - rest_[node]);
        const SpringPull p = pull(positions[node], positions[other], restLengths_[layer][slot], restDirection,
                                  arm.stiffness, arm.compression);
        energies[task] += 0.5 * p.energy;  // the other end has the other half
        if (!gradient) return;
        gradient->add(node, -p.force);
        largest[task] = std::max(largest[task], p.magnitude);
      });
    });
    double total = 0;
    for (std::size_t task = 0; task < 2 * blocks; ++task) {
      total += energies[task];
      if (largestForce) *largestForce = std::max(*largestForce, largest[task]);
    }
    return total;
  }

  std::string name_;
  int rows_, columns_;
  NodeVectors rest_;
  std::vector<Arm> arms_[2];
  std::vector<double> restLengths_[2];
};

class SpringTerm final : public Term {
 public:
  SpringTerm(std::string name, const System& system, std::vector<NodeSpring> springs)
      : name_(std::move(name)), freeNodes_(system.freeNodes), springs_(std::move(springs)) {
    for (const NodeSpring& s : springs_) {
      const Vec3 d = system.rest[s.b] - system.rest[s.a];
      restLengths_.push_back(norm(d));
      // A spring of no length at rest pulls towards its other end in any direction.
      restDirections_.push_back(normalized(d));
    }
  }

  std::string name() const override { return name_; }

  double energy(const NodeVectors& positions) const override {
    double total = 0;
    for (std::size_t i = 0; i < springs_.size(); ++i) total += at(i, positions).energy;
    return total;
  }

  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const override {
    double total = 0;
    for (std::size_t i = 0; i < springs_.size(); ++i) {
      const SpringPull p = at(i, positions);
      total += p.energy;
      gradient.add(springs_[i].a, -p.force);
      gradient.add(springs_[i].b, p.force);
      largestForce = std::max(largestForce, p.magnitude);
    }
    return total;
  }

  void addStiffnessBound(std::vector<double>& bound) const override {
    for (const NodeSpring& s : springs_) {
      const bool driven = s.a >= freeNodes_ || s.b >= freeNodes_;
      bound[s.a] += (driven ? 1 : 2) * s.stiffnessNPerMm;
      bound[s.b] += (driven ? 1 : 2) * s.stiffnessNPerMm;
    }
  }

 private:
  SpringPull at(std::size_t i, const NodeVectors& positions) const {
    return pull(positions[springs_[i].a], positions[springs_[i].b], restLengths_[i], restDirections_[i],
                springs_[i].stiffnessNPerMm, 1);
  }

  std::string name_;
  std::size_t freeNodes_;
  std::vector<NodeSpring> springs_;
  std::vector<double> restLengths_;
  std::vector<Vec3> restDirections_;
};

}  // namespace

std::unique_ptr<Term> makeLatticeTerm(std::string name, const System& system, std::vector<StencilSpring> stencil) {
  return std::make_unique<LatticeTerm>(std::move(name), system, std::move(stencil));
}

std::unique_ptr<Term> makeSpringTerm(std::string name, const System& system, std::vector<NodeSpring> springs) {
  return std::make_unique<SpringTerm>(std::move(name), system, std::move(springs));
}

}  // namespace pectora
