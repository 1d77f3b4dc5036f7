#include "kernel/physics/springs.h"

#include "kernel/physics/hessian.h"
#include "kernel/physics/rows.h"
#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pectora {
namespace {

// A spring shorter than this part of its rest length has no direction of its own.
constexpr double kDegenerate = 1e-12;

// Three numbers that need no more digits.
struct SingleVec3 {
  float x, y, z;
  explicit SingleVec3(Vec3 v = {}) : x(float(v.x)), y(float(v.y)), z(float(v.z)) {}
  operator Vec3() const { return {double(x), double(y), double(z)}; }
};

// Some springs side by side, and what all that came there add up.
struct Batch {
  static constexpr std::size_t kSize = 64;
  double x[kSize], y[kSize], z[kSize];   // from end to end; then the force on the near end
  double stiffness[kSize], restLength[kSize], tension[kSize], degenerate[kSize];
  double twiceEnergy[kSize] = {}, largest[kSize] = {};

  void set(std::size_t i, Vec3 d, double k, double l0) { x[i] = d.x, y[i] = d.y, z[i] = d.z, stiffness[i] = k, restLength[i] = l0; }
  void pull(std::size_t count);
};

PECTORA_WIDE void Batch::pull(std::size_t count) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const double l = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]), longer = l - restLength[i], t = stiffness[i] * longer;
    const bool hasDirection = l > kDegenerate * restLength[i] && l > 0;
    const double scale = t / l, size = std::abs(t);
    x[i] *= scale, y[i] *= scale, z[i] *= scale;
    tension[i] = t, degenerate[i] = hasDirection ? 0.0 : 1.0;
    twiceEnergy[i] += t * longer;
    largest[i] = largest[i] < size ? size : largest[i];
  }
}

// A spring as the term keeps it; there are several for every point of the pleura.
struct KeptSpring {
  std::uint32_t a, b;
  double stiffnessNPerMm, restLength;
};

// Second derivative of one spring: a I + m m^T.
struct SpringCurvature {
  SingleVec3 m;
  float a = 0;
};

SpringCurvature curvatureOf(Vec3 near, Vec3 far, double restLength, const SingleVec3& restDirection, double stiffness, bool projected) {
  const Vec3 d = far - near;
  const double length = norm(d);
  if (!(length > kDegenerate * restLength && length > 0))
    return restLength > 0 ? SpringCurvature{SingleVec3(Vec3(restDirection) * std::sqrt(stiffness)), 0} : SpringCurvature{SingleVec3(), float(stiffness)};
  const double across = stiffness * (1 - restLength / length);
  const double a = projected ? std::max(0.0, across) : across;
  return {SingleVec3(d * (std::sqrt(stiffness - a) / length)), float(a)};
}

// Springs that hold a free node to a driven one come first, node by node, so that pieces of them share no free node and can
// be evaluated side by side. The others follow.
class SpringTerm final : public Term {
 public:
  SpringTerm(std::string name, const System& system, std::vector<NodeSpring> springs)
      : name_(std::move(name)) {
    const std::size_t free = system.freeNodes;
    for (NodeSpring& s : springs)
      if (s.a >= free) std::swap(s.a, s.b);
    std::erase_if(springs, [&](const NodeSpring& s) { return s.a >= free; });
    const auto end = std::stable_partition(springs.begin(), springs.end(), [&](const NodeSpring& s) { return s.b >= free; });
    std::stable_sort(springs.begin(), end, [](const NodeSpring& s, const NodeSpring& t) { return s.a < t.a; });
    held_ = std::size_t(end - springs.begin());
    springs_.reserve(springs.size());
    restDirections_.reserve(springs.size());
    for (const NodeSpring& s : springs) {
      const Vec3 d = system.rest[s.b] - system.rest[s.a];
      springs_.push_back({std::uint32_t(s.a), std::uint32_t(s.b), s.stiffnessNPerMm, norm(d)});
      // A spring of no length at rest pulls towards its other end in any direction.
      restDirections_.push_back(SingleVec3(normalized(d)));
    }
    for (std::size_t i = 0; i < held_; ++i)
      if (pieces_.empty() || (i >= pieces_.back() + kPiece && springs_[i].a != springs_[i - 1].a)) pieces_.push_back(i);
    pieces_.push_back(held_);
  }

  std::string name() const override { return name_; }

  double energy(const NodeVectors& positions) const override {
    std::vector<double> energies(pieces());
    forEachPiece([&](std::size_t piece, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const KeptSpring& s = springs_[i];
        const double longer = distance(positions[s.b], positions[s.a]) - s.restLength;
        energies[piece] += 0.5 * s.stiffnessNPerMm * longer * longer;
      }
    });
    double total = 0;
    for (const double e : energies) total += e;
    return total;
  }

  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const override {
    std::vector<double> energies(pieces()), largest(pieces());
    forEachPiece([&](std::size_t piece, std::size_t begin, std::size_t end) {
      Batch batch;
      for (std::size_t first = begin; first < end; first += Batch::kSize) {
        const std::size_t count = std::min(Batch::kSize, end - first);
        for (std::size_t i = 0; i < count; ++i) {
          const KeptSpring& s = springs_[first + i];
          batch.set(i, positions[s.b] - positions[s.a], s.stiffnessNPerMm, s.restLength);
        }
        batch.pull(count);
        // Springs of one node follow each other.
        Vec3 sum;
        for (std::size_t i = 0; i < count; ++i) {
          const KeptSpring& s = springs_[first + i];
          const Vec3 force = batch.degenerate[i] != 0 ? Vec3(restDirections_[first + i]) * batch.tension[i] : Vec3{batch.x[i], batch.y[i], batch.z[i]};
          sum += force;
          if (first + i >= held_) gradient.add(s.b, force);
          if (i + 1 < count && springs_[first + i + 1].a == s.a) continue;
          gradient.add(s.a, -sum);
          sum = {};
        }
      }
      for (std::size_t i = 0; i < Batch::kSize; ++i) {
        energies[piece] += 0.5 * batch.twiceEnergy[i];
        largest[piece] = std::max(largest[piece], batch.largest[i]);
      }
    });
    double total = 0;
    for (std::size_t piece = 0; piece < pieces(); ++piece) {
      total += energies[piece];
      largestForce = std::max(largestForce, largest[piece]);
    }
    return total;
  }

  void addStiffnessBound(std::vector<double>& bound) const override {
    for (std::size_t i = 0; i < springs_.size(); ++i) {
      const KeptSpring& s = springs_[i];
      bound[s.a] += (i < held_ ? 1 : 2) * s.stiffnessNPerMm;
      if (i >= held_) bound[s.b] += 2 * s.stiffnessNPerMm;
    }
  }

  bool hasHessian() const override { return true; }
  std::unique_ptr<Hessian> makeHessian() const override;
  bool hasSprings() const override { return true; }
  void forEachSpring(const std::function<void(const Spring&)>& visit) const override {
    for (std::size_t i = 0; i < springs_.size(); ++i)
      visit({springs_[i].a, springs_[i].b, springs_[i].stiffnessNPerMm, springs_[i].restLength, 1});
  }

  const std::vector<KeptSpring>& springs() const { return springs_; }
  /// How many springs, the first ones, hold a free node to a driven one.
  std::size_t held() const { return held_; }
  SpringCurvature curvature(std::size_t i, const NodeVectors& positions, bool projected) const {
    const KeptSpring& s = springs_[i];
    return curvatureOf(positions[s.a], positions[s.b], s.restLength, restDirections_[i], s.stiffnessNPerMm, projected);
  }

  /// The pieces of the springs that hold, and one more with the others.
  std::size_t pieces() const { return pieces_.size(); }
  /// Calls f(piece, first spring, end): the first ones side by side, and the last one after them.
  template <class F>
  void forEachPiece(F&& f) const {
    parallelFor(pieces_.size() - 1, [&](std::size_t piece) { f(piece, pieces_[piece], pieces_[piece + 1]); });
    f(pieces_.size() - 1, held_, springs_.size());
  }

 private:
  static constexpr std::size_t kPiece = 4096;

  std::string name_;
  std::size_t held_ = 0;
  std::vector<KeptSpring> springs_;
  std::vector<SingleVec3> restDirections_;
  std::vector<std::size_t> pieces_;   // first springs, and the end of those that hold
};

// What the springs that hold do to a free node adds up to one block a node, as long as the driven ends stand still.
class SpringHessian final : public Hessian {
 public:
  explicit SpringHessian(const SpringTerm& term) : term_(term), curvatures_(term.springs().size()) {
    for (std::size_t i = 0; i < term_.held(); ++i)
      if (heldNodes_.empty() || heldNodes_.back() != term_.springs()[i].a) heldNodes_.push_back(term_.springs()[i].a), firstSpring_.push_back(i);
    firstSpring_.push_back(term_.held());
    heldBlocks_.resize(heldNodes_.size());
  }

  void linearise(const NodeVectors& positions, bool projected) override {
    term_.forEachPiece([&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) curvatures_[i] = term_.curvature(i, positions, projected);
    });
    constexpr std::size_t kPiece = 4096;
    forEachPiece(heldNodes_.size(), kPiece, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        heldBlocks_[n] = {};
        for (std::size_t i = firstSpring_[n]; i < firstSpring_[n + 1]; ++i) heldBlocks_[n] += block(i);
      }
    });
  }

  void multiply(const NodeVectors& v, NodeVectors& y) const override {
    multiplyStill(v, y);
    for (std::size_t i = 0; i < term_.held(); ++i) {
      const Vec3 far = v[term_.springs()[i].b];
      if (far.x != 0 || far.y != 0 || far.z != 0) y.add(term_.springs()[i].a, -(block(i) * far));
    }
  }
  void multiplySingle(const SingleVectors& v, SingleVectors& y) const override { multiplyStill(v, y); }

  void addDiagonal(std::vector<Symmetric3>& blocks) const override {
    for (std::size_t n = 0; n < heldNodes_.size(); ++n) blocks[heldNodes_[n]] += heldBlocks_[n];
    for (std::size_t i = term_.held(); i < curvatures_.size(); ++i) {
      blocks[term_.springs()[i].a] += block(i);
      blocks[term_.springs()[i].b] += block(i);
    }
  }

  void forEachCoupling(const Coupling& visit) const override {
    for (std::size_t i = 0; i < curvatures_.size(); ++i) {
      const Symmetric3 h = block(i);
      visit(term_.springs()[i].a, term_.springs()[i].b, {{{-h.xx, -h.xy, -h.xz}, {-h.xy, -h.yy, -h.yz}, {-h.xz, -h.yz, -h.zz}}});
    }
  }

 private:
  Symmetric3 block(std::size_t i) const {
    const Vec3 m = curvatures_[i].m;
    const double a = double(curvatures_[i].a);
    return {a + m.x * m.x, m.x * m.y, m.x * m.z, a + m.y * m.y, m.y * m.z, a + m.z * m.z};
  }
  template <class Vectors>
  void multiplyStill(const Vectors& v, Vectors& y) const {
    for (std::size_t n = 0; n < heldNodes_.size(); ++n) {
      const std::size_t node = heldNodes_[n];
      y.set(node, y[node] + heldBlocks_[n] * v[node]);
    }
    for (std::size_t i = term_.held(); i < curvatures_.size(); ++i) {
      const KeptSpring& s = term_.springs()[i];
      const Vec3 pull = block(i) * (v[s.b] - v[s.a]);
      y.set(s.a, y[s.a] - pull);
      y.set(s.b, y[s.b] + pull);
    }
  }

  const SpringTerm& term_;
  std::vector<SpringCurvature> curvatures_;
  std::vector<std::size_t> heldNodes_, firstSpring_;
  std::vector<Symmetric3> heldBlocks_;
};

std::unique_ptr<Hessian> SpringTerm::makeHessian() const { return std::make_unique<SpringHessian>(*this); }

}  // namespace

std::unique_ptr<Term> makeSpringTerm(std::string name, const System& system, std::vector<NodeSpring> springs) {
  return std::make_unique<SpringTerm>(std::move(name), system, std::move(springs));
}

}  // namespace pectora
