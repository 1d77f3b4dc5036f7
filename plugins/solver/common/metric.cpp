#include "plugins/solver/common/metric.h"

#include "kernel/physics/hessian.h"

#include <algorithm>

namespace pectora {
namespace {

class BlockJacobi final : public Metric {
 public:
  explicit BlockJacobi(const System& system) : system_(system), hessian_(makeHessian(system)), blocks_(system.rest.size()) {
    if (hessian_) return;
    const std::vector<double> bound = system.stiffnessBound();
    for (std::size_t i = 0; i < bound.size(); ++i) blocks_[i].addIdentity(1 / bound[i]);
  }
  bool refresh(const NodeVectors& positions) override {
    if (!hessian_) return false;
    hessian_->linearise(positions, true);
    std::fill(blocks_.begin(), blocks_.end(), Symmetric3{});
    hessian_->addDiagonal(blocks_);
    for (std::size_t i = 0; i < system_.freeNodes; ++i) blocks_[i] = inverse(blocks_[i]);
    return true;
  }
  void apply(const SingleVectors& g, SingleVectors& d) const override {
    for (std::size_t i = 0; i < system_.freeNodes; ++i) d.set(i, blocks_[i] * g[i]);
  }

 private:
  const System& system_;
  std::unique_ptr<Hessian> hessian_;
  std::vector<Symmetric3> blocks_;
};

}  // namespace

std::unique_ptr<Metric> makeBlockJacobi(const System& system) { return std::make_unique<BlockJacobi>(system); }

}  // namespace pectora
