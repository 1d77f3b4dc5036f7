#include "kernel/physics/springs.h"

#include "kernel/physics/hessian.h"

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

SpringPull pull(Vec3 near, Vec3 far, double restLength, Vec3 restDirection, double stiffness) {
  const Vec3 d = far - near;
  const double length = norm(d);
  const Vec3 direction = length > kDegenerate * restLength && length > 0 ? d / length : restDirection;
  const double tension = stiffness * (length - restLength);
  return {direction * tension, 0.5 * tension * (length - restLength), std::abs(tension)};
}

// Second derivative of one spring: a I + m m^T.
struct SpringCurvature {
  Vec3 m;
  double a;
};

SpringCurvature curvatureOf(Vec3 near, Vec3 far, double restLength, Vec3 restDirection, double stiffness, bool projected) {
  const Vec3 d = far - near;
  const double length = norm(d);
  if (!(length > kDegenerate * restLength && length > 0))
    return restLength > 0 ? SpringCurvature{restDirection * std::sqrt(stiffness), 0} : SpringCurvature{{}, stiffness};
  const double across = stiffness * (1 - restLength / length);
  const double a = projected ? std::max(0.0, across) : across;
  return {d * (std::sqrt(stiffness - a) / length), a};
}

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

  bool hasHessian() const override { return true; }
  std::unique_ptr<Hessian> makeHessian() const override;
  bool hasSprings() const override { return true; }
  void forEachSpring(const std::function<void(const Spring&)>& visit) const override {
    for (std::size_t i = 0; i < springs_.size(); ++i)
      visit({springs_[i].a, springs_[i].b, springs_[i].stiffnessNPerMm, restLengths_[i], 1});
  }

  const std::vector<NodeSpring>& springs() const { return springs_; }
  SpringCurvature curvature(std::size_t i, const NodeVectors& positions, bool projected) const {
    return curvatureOf(positions[springs_[i].a], positions[springs_[i].b], restLengths_[i], restDirections_[i],
                       springs_[i].stiffnessNPerMm, projected);
  }

 private:
  SpringPull at(std::size_t i, const NodeVectors& positions) const {
    return pull(positions[springs_[i].a], positions[springs_[i].b], restLengths_[i], restDirections_[i],
                springs_[i].stiffnessNPerMm);
  }

  std::string name_;
  std::size_t freeNodes_;
  std::vector<NodeSpring> springs_;
  std::vector<double> restLengths_;
  std::vector<Vec3> restDirections_;
};

class SpringHessian final : public Hessian {
 public:
  explicit SpringHessian(const SpringTerm& term) : term_(term), curvatures_(term.springs().size()) {}
  void linearise(const NodeVectors& positions, bool projected) override {
    for (std::size_t i = 0; i < curvatures_.size(); ++i) curvatures_[i] = term_.curvature(i, positions, projected);
  }
  void multiply(const NodeVectors& v, NodeVectors& y) const override {
    for (std::size_t i = 0; i < curvatures_.size(); ++i) {
      const NodeSpring& s = term_.springs()[i];
      const SpringCurvature& c = curvatures_[i];
      const Vec3 d = v[s.b] - v[s.a];
      const Vec3 pull = d * c.a + c.m * dot(c.m, d);
      y.add(s.a, -pull);
      y.add(s.b, pull);
    }
  }
  void addDiagonal(std::vector<Symmetric3>& blocks) const override {
    for (std::size_t i = 0; i < curvatures_.size(); ++i) {
      const auto& [m, a] = curvatures_[i];
      const Symmetric3 block{a + m.x * m.x, m.x * m.y, m.x * m.z, a + m.y * m.y, m.y * m.z, a + m.z * m.z};
      blocks[term_.springs()[i].a] += block;
      blocks[term_.springs()[i].b] += block;
    }
  }

 private:
  const SpringTerm& term_;
  std::vector<SpringCurvature> curvatures_;
};

std::unique_ptr<Hessian> SpringTerm::makeHessian() const { return std::make_unique<SpringHessian>(*this); }

}  // namespace

std::unique_ptr<Term> makeSpringTerm(std::string name, const System& system, std::vector<NodeSpring> springs) {
  return std::make_unique<SpringTerm>(std::move(name), system, std::move(springs));
}

}  // namespace pectora
