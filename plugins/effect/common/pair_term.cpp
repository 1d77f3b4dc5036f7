#include "plugins/effect/common/pair_term.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pectora {
namespace {

// Pairs of a free node and a driven one come first, node by node, so that pieces of them share no free node and can be evaluated side by
// side. The others follow.
class PairTerm final : public Term {
 public:
  PairTerm(std::string name, std::size_t freeNodes, std::vector<NodePair> pairs, std::unique_ptr<PairLaw> law, bool holds)
      : name_(std::move(name)), freeNodes_(freeNodes), pairs_(std::move(pairs)), law_(std::move(law)), holds_(holds), order_(pairs_.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t(0));
    const auto isHeld = [&](std::size_t i) { return pairs_[i].far >= freeNodes_; };
    const auto end = std::stable_partition(order_.begin(), order_.end(), isHeld);
    std::stable_sort(order_.begin(), end, [&](std::size_t i, std::size_t j) { return pairs_[i].near < pairs_[j].near; });
    const std::size_t held = std::size_t(end - order_.begin());
    for (std::size_t n = 0; n < held; ++n)
      if (pieces_.empty() || (n >= pieces_.back() + kPiece && pairs_[order_[n]].near != pairs_[order_[n - 1]].near)) pieces_.push_back(n);
    pieces_.push_back(held);
  }

  std::string name() const override { return name_; }

  double energy(const NodeVectors& positions) const override {
    double total = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) total += law_->pull(i, way(i, positions)).energy;
    return total;
  }

  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const override {
    std::vector<double> energies(pieces_.size()), largest(energies);
    const auto evaluatePiece = [&](std::size_t piece, std::size_t end) {
      double squared = 0;
      for (std::size_t n = pieces_[piece]; n < end; ++n) {
        const std::size_t i = order_[n];
        const auto [energy, force] = law_->pull(i, way(i, positions));
        energies[piece] += energy;
        squared = std::max(squared, dot(force, force));
        gradient.add(pairs_[i].near, -force);
        if (pairs_[i].far < freeNodes_) gradient.add(pairs_[i].far, force);
      }
      largest[piece] = std::sqrt(squared);
    };
    parallelFor(pieces_.size() - 1, [&](std::size_t piece) { evaluatePiece(piece, pieces_[piece + 1]); });
    evaluatePiece(pieces_.size() - 1, order_.size());
    double total = 0;
    for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
      total += energies[piece];
      largestForce = std::max(largestForce, largest[piece]);
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

  static constexpr std::size_t kPiece = 4096;
  std::vector<std::size_t> order_, pieces_;   // pairs in the order of their evaluation; where pieces of them begin, the last with two free nodes
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
  explicit ObstacleLaw(const std::vector<Obstacle>& obstacles) {
    kept_.reserve(obstacles.size());
    for (const Obstacle& o : obstacles) kept_.push_back({float(o.away.x), float(o.away.y), float(o.away.z), float(o.clearance), float(o.stiffnessNPerMm)});
  }

  Pull pull(std::size_t i, Vec3 d) const override {
    const double depth = into(i, d);
    if (depth <= 0) return {};
    const double k = stiffnessBound(i);
    return {0.5 * k * depth * depth, away(i) * (k * depth)};
  }
  Symmetric3 curvature(std::size_t i, Vec3 d, bool) const override {
    if (into(i, d) <= 0) return {};
    const Vec3 n = away(i);
    const double k = stiffnessBound(i);
    return {k * n.x * n.x, k * n.x * n.y, k * n.x * n.z, k * n.y * n.y, k * n.y * n.z, k * n.z * n.z};
  }
  double stiffnessBound(std::size_t i) const override { return double(kept_[i].stiffness); }

 private:
  // An obstacle as it is kept; there are several for every point of the pleura.
  struct Kept {
    float x, y, z, clearance, stiffness;
  };
  Vec3 away(std::size_t i) const { return {double(kept_[i].x), double(kept_[i].y), double(kept_[i].z)}; }
  // How deep the near node is in the wall, mm.
  double into(std::size_t i, Vec3 d) const { return double(kept_[i].clearance) + dot(away(i), d); }
  std::vector<Kept> kept_;
};

}  // namespace

std::unique_ptr<Term> makePairTerm(std::string name, const System& system, std::vector<NodePair> pairs, std::unique_ptr<PairLaw> law, bool holds) {
  return std::make_unique<PairTerm>(std::move(name), system.freeNodes, std::move(pairs), std::move(law), holds);
}

std::unique_ptr<PairLaw> makeObstacleLaw(const std::vector<Obstacle>& obstacles) { return std::make_unique<ObstacleLaw>(obstacles); }

}  // namespace pectora
