#include "kernel/physics/hessian.h"

namespace pectora {
namespace {

class SystemHessian final : public Hessian {
 public:
  explicit SystemHessian(std::vector<std::unique_ptr<Hessian>> parts) : parts_(std::move(parts)) {}
  void linearise(const NodeVectors& positions, bool projected) override {
    for (auto& part : parts_) part->linearise(positions, projected);
  }
  void multiply(const NodeVectors& v, NodeVectors& y) const override {
    for (const auto& part : parts_) part->multiply(v, y);
  }
  void multiplySingle(const SingleVectors& v, SingleVectors& y) const override {
    for (const auto& part : parts_) part->multiplySingle(v, y);
  }
  void addDiagonal(std::vector<Symmetric3>& blocks) const override {
    for (const auto& part : parts_) part->addDiagonal(blocks);
  }
  void forEachCoupling(const Coupling& visit) const override {
    for (const auto& part : parts_) part->forEachCoupling(visit);
  }
  void forEachCouplingRun(const CouplingRun& run, const Coupling& visit) const override {
    for (const auto& part : parts_) part->forEachCouplingRun(run, visit);
  }

 private:
  std::vector<std::unique_ptr<Hessian>> parts_;
};

}  // namespace

void Hessian::multiplySingle(const SingleVectors& v, SingleVectors& y) const {
  NodeVectors in(v.size()), out(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) in.set(i, v[i]);
  multiply(in, out);
  for (std::size_t i = 0; i < v.size(); ++i) y.set(i, y[i] + out[i]);
}

Symmetric3 inverse(Symmetric3 a) {
  const double trace = a.xx + a.yy + a.zz, least = 1e-9 * trace;
  if (!(trace > 0)) return {1, 0, 0, 1, 0, 1};
  for (double shift = 0;; shift = shift > 0 ? 10 * shift : least) {
    Symmetric3 m = a;
    m.addIdentity(shift);
    // Pivots of the LDL factorisation.
    if (!(m.xx > least) && shift < trace) continue;
    const double l21 = m.xy / m.xx, l31 = m.xz / m.xx;
    const double d2 = m.yy - l21 * m.xy;
    if (!(d2 > least) && shift < trace) continue;
    const double c = m.yz - l31 * m.xy, l32 = c / d2;
    const double d3 = m.zz - l31 * m.xz - l32 * c;
    if (!(d3 > least) && shift < trace) continue;
    if (shift >= trace) return {1 / trace, 0, 0, 1 / trace, 0, 1 / trace};
    // L^-1 has rows (1 0 0), (-l21 1 0), (p -l32 1).
    const double p = l21 * l32 - l31;
    const double i1 = 1 / m.xx, i2 = 1 / d2, i3 = 1 / d3;
    return {i1 + l21 * l21 * i2 + p * p * i3, -l21 * i2 - p * l32 * i3, p * i3, i2 + l32 * l32 * i3, -l32 * i3, i3};
  }
}

std::unique_ptr<Hessian> makeHessian(const System& system) {
  std::vector<std::unique_ptr<Hessian>> parts;
  for (const auto& term : system.terms) {
    parts.push_back(term->makeHessian());
    if (!parts.back()) return nullptr;
  }
  return std::make_unique<SystemHessian>(std::move(parts));
}

}  // namespace pectora
