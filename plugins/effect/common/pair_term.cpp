#include "plugins/effect/common/pair_term.h"

#include <algorithm>

namespace pectora {
namespace {

class PairTerm final : public Term {
 public:
  PairTerm(std::string name, std::size_t freeNodes, std::vector<NodePair> pairs, std::unique_ptr<PairLaw> law, bool holds)
      : name_(std::move(name)), freeNodes_(freeNodes), pairs_(std::move(pairs)), law_(std::move(law)), holds_(holds) {}

  std::string name() const override { return name_; }

  double energy(const NodeVectors& positions) const override {
    double total = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) total += law_->pull(i, way(i, positions)).energy;
    return total;
  }

  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const override {
    double total = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const PairLaw::Pull pull = law_->pull(i, way(i, positions));
      total += pull.energy;
      largestForce = std::max(largestForce, norm(pull.force));
      gradient.add(pairs_[i].near, -pull.force);
      gradient.add(pairs_[i].far, pull.force);
    }
    return total;
  }

  void addStiffnessBound(std::vector<double>& bound) const override {
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const bool isFree = pairs_[i].far < freeNodes_;
      bound[pairs_[i].near] += (isFree ? 2 : 1) * law_->stiffnessBound(i);
      if (isFree) bound[pairs_[i].far] += 2 * law_->stiffnessBound(i);
    }
  }

  bool holds() const override { return holds_; }
  bool hasHessian() const override { return true; }
  std::unique_ptr<Hessian> makeHessian() const override;

  const std::vector<NodePair>& pairs() const { return pairs_; }
  Symmetric3 curvature(std::size_t i, const NodeVectors& positions, bool projected) const {
    return law_->curvature(i, way(i, positions), projected);
  }

 private:
  Vec3 way(std::size_t i, const NodeVectors& positions) const { return positions[pairs_[i].far] - positions[pairs_[i].near]; }

  std::string name_;
  std::size_t freeNodes_;
  std::vector<NodePair> pairs_;
  std::unique_ptr<PairLaw> law_;
  bool holds_;
};

class PairHessian final : public Hessian {
 public:
  explicit PairHessian(const PairTerm& term) : term_(term), blocks_(term.pairs().size()) {}

  void linearise(const NodeVectors& positions, bool projected) override {
    for (std::size_t i = 0; i < blocks_.size(); ++i) blocks_[i] = term_.curvature(i, positions, projected);
  }
  void multiply(const NodeVectors& v, NodeVectors& y) const override { multiplyAll(v, y, v.size()); }
  void multiplySingle(const SingleVectors& v, SingleVectors& y) const override { multiplyAll(v, y, v.size()); }
  void addDiagonal(std::vector<Symmetric3>& blocks) const override {
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      blocks[term_.pairs()[i].near] += blocks_[i];
      blocks[term_.pairs()[i].far] += blocks_[i];
    }
  }
  void forEachCoupling(const Coupling& visit) const override {
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const Symmetric3& h = blocks_[i];
      visit(term_.pairs()[i].near, term_.pairs()[i].far, {{{-h.xx, -h.xy, -h.xz}, {-h.xy, -h.yy, -h.yz}, {-h.xz, -h.yz, -h.zz}}});
    }
  }

 private:
  // Nodes from `count` on stand still.
  template <class Vectors>
  void multiplyAll(const Vectors& v, Vectors& y, std::size_t count) const {
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const auto [near, far] = term_.pairs()[i];
      const Vec3 pull = blocks_[i] * ((far < count ? v[far] : Vec3{}) - v[near]);
      y.set(near, y[near] - pull);
      if (far < count) y.set(far, y[far] + pull);
    }
  }

  const PairTerm& term_;
  std::vector<Symmetric3> blocks_;
};

std::unique_ptr<Hessian> PairTerm::makeHessian() const { return std::make_unique<PairHessian>(*this); }

class ObstacleLaw final : public PairLaw {
 public:
  explicit ObstacleLaw(std::vector<Obstacle> obstacles) : obstacles_(std::move(obstacles)) {}

  Pull pull(std::size_t i, Vec3 d) const override {
    const double depth = into(i, d);
    if (depth <= 0) return {};
    const double k = obstacles_[i].stiffnessNPerMm;
    return {0.5 * k * depth * depth, obstacles_[i].away * (k * depth)};
  }
  Symmetric3 curvature(std::size_t i, Vec3 d, bool) const override {
    if (into(i, d) <= 0) return {};
    const Vec3 n = obstacles_[i].away;
    const double k = obstacles_[i].stiffnessNPerMm;
    return {k * n.x * n.x, k * n.x * n.y, k * n.x * n.z, k * n.y * n.y, k * n.y * n.z, k * n.z * n.z};
  }
  double stiffnessBound(std::size_t i) const override { return obstacles_[i].stiffnessNPerMm; }

 private:
  // How deep the near node is in the wall, mm.
  double into(std::size_t i, Vec3 d) const { return obstacles_[i].clearance + dot(obstacles_[i].away, d); }
  std::vector<Obstacle> obstacles_;
};

}  // namespace

std::unique_ptr<Term> makePairTerm(std::string name, const System& system, std::vector<NodePair> pairs, std::unique_ptr<PairLaw> law, bool holds) {
  return std::make_unique<PairTerm>(std::move(name), system.freeNodes, std::move(pairs), std::move(law), holds);
}

std::unique_ptr<PairLaw> makeObstacleLaw(std::vector<Obstacle> obstacles) { return std::make_unique<ObstacleLaw>(std::move(obstacles)); }

}  // namespace pectora
