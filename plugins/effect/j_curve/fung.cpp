#include "plugins/effect/j_curve/fung.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

class FungLaw final : public PairLaw {
 public:
  FungLaw(std::vector<FungSpring> springs, double b, double mostRatio) : springs_(std::move(springs)), b_(b), most_(mostRatio - 1) {}

  Pull pull(std::size_t i, Vec3 d) const override {
    const At at = strained(i, d);
    return at.length > 0 ? Pull{at.energy, d * (at.tension / at.length)} : Pull{};
  }
  Symmetric3 curvature(std::size_t i, Vec3 d, bool) const override {
    // Along the spring its stiffness, across it tension over length; neither is ever negative.
    const At at = strained(i, d);
    if (!(at.length > 0)) return {};
    const Vec3 n = d / at.length;
    const double across = at.tension / at.length, along = at.stiffness - across;
    return {across + along * n.x * n.x, along * n.x * n.y, along * n.x * n.z, across + along * n.y * n.y, along * n.y * n.z, across + along * n.z * n.z};
  }
  double stiffnessBound(std::size_t i) const override { return springs_[i].stiffnessNPerMm * most_; }

 private:
  struct At {
    double length = 0, energy = 0, tension = 0, stiffness = 0;
  };
  // All zero for a spring that is not stretched.
  At strained(std::size_t i, Vec3 d) const {
    const auto& [k, l0] = springs_[i];
    const double length = norm(d), strain = l0 > 0 ? length / l0 - 1 : 0;
    if (!(strain > 0)) return {};
    // Up to the last strain of growth by the exponential, and beyond it straight on.
    const double last = std::log(most_ + 1) / b_, e = std::min(strain, last), beyond = strain - e;
    const double grown = std::expm1(b_ * e), tension = k * l0 * (grown / b_ - e);
    const double energy = k * l0 * l0 * ((grown - b_ * e) / (b_ * b_) - 0.5 * e * e);
    const double way = beyond * l0, stiffness = k * grown;
    return {length, energy + tension * way + 0.5 * stiffness * way * way, tension + stiffness * way, stiffness};
  }

  std::vector<FungSpring> springs_;
  double b_, most_;
};

}  // namespace

std::unique_ptr<PairLaw> makeFungLaw(std::vector<FungSpring> springs, double b, double mostRatio) {
  return std::make_unique<FungLaw>(std::move(springs), b, mostRatio);
}

}  // namespace pectora
