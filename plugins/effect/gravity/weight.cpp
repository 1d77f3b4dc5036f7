#include "plugins/effect/gravity/weight.h"

#include "kernel/physics/hessian.h"

namespace pectora {
namespace {

// A force that never changes has no second derivative.
class NoCurvature final : public Hessian {
 public:
  void linearise(const NodeVectors&, bool) override {}
  void multiply(const NodeVectors&, NodeVectors&) const override {}
  void multiplySingle(const SingleVectors&, SingleVectors&) const override {}
  void addDiagonal(std::vector<Symmetric3>&) const override {}
  void forEachCoupling(const Coupling&) const override {}
};

class WeightTerm final : public Term {
 public:
  WeightTerm(const System& system, Vec3 acceleration) : mass_(system.mass), acceleration_(acceleration) {
    for (std::size_t i = 0; i < mass_.size(); ++i) energyAtRest_ += mass_[i] * dot(acceleration_, system.rest[i]);
  }
  std::string name() const override { return "gravity"; }
  double energy(const NodeVectors& positions) const override {
    double total = energyAtRest_;
    for (std::size_t i = 0; i < mass_.size(); ++i) total -= mass_[i] * dot(acceleration_, positions[i]);
    return total;
  }
  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double&) const override {
    for (std::size_t i = 0; i < mass_.size(); ++i) gradient.add(i, acceleration_ * -mass_[i]);
    return energy(positions);
  }
  void addStiffnessBound(std::vector<double>&) const override {}
  bool holds() const override { return false; }
  bool hasHessian() const override { return true; }
  std::unique_ptr<Hessian> makeHessian() const override { return std::make_unique<NoCurvature>(); }
  bool hasSprings() const override { return true; }

 private:
  std::vector<double> mass_;
  Vec3 acceleration_;
  double energyAtRest_ = 0;
};

}  // namespace

std::unique_ptr<Term> makeWeightTerm(const System& system, Vec3 acceleration) { return std::make_unique<WeightTerm>(system, acceleration); }

}  // namespace pectora
