// An effect with a term of its own that offers no Hessian: a constant force of 0.1 N on the first skin point.
#include "kernel/stage/effect.h"

namespace {
using namespace pectora;

class PullTerm final : public Term {
 public:
  std::string name() const override { return "pull"; }
  double energy(const NodeVectors& positions) const override { return 0.1 * positions.y[0]; }
  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double&) const override {
    gradient.y[0] += 0.1;
    return energy(positions);
  }
  void addStiffnessBound(std::vector<double>&) const override {}
};

class Pull final : public Effect {
 public:
  void describe(Visitor&) override {}
  Contribution contribute(const Scene&, const System&) override {
    Contribution part;
    part.terms.push_back(std::make_unique<PullTerm>());
    return part;
  }
};

}  // namespace

PECTORA_EFFECT(Pull, {.id = "effect.pull", .version = "1.0", .summary = "Pulls at a corner"})
