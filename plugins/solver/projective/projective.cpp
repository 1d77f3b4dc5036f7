#include "plugins/solver/projective/projective.h"

#include "kernel/stage/error.h"

#include <Eigen/SparseCholesky>

namespace pectora {
namespace {

class ProjectiveMetric final : public Metric {
 public:
  explicit ProjectiveMetric(const System& system) : free_(Eigen::Index(system.freeNodes)) {
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& term : system.terms)
      term->forEachSpring([&](const Spring& s) {
        const auto a = Eigen::Index(s.a), b = Eigen::Index(s.b);
        if (a < free_) entries.emplace_back(a, a, s.stiffnessNPerMm);
        if (b < free_) entries.emplace_back(b, b, s.stiffnessNPerMm);
        // The lower triangle is all that is read.
        if (a < free_ && b < free_) entries.emplace_back(std::max(a, b), std::min(a, b), -s.stiffnessNPerMm);
      });
    Eigen::SparseMatrix<double> matrix(free_, free_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factors_.compute(matrix);
    const bool isRegular = factors_.info() == Eigen::Success && factors_.vectorD().minCoeff() > 1e-12 * factors_.vectorD().maxCoeff();
    if (!isRegular) throw Error("some points hang together, but on nothing that holds them").advise("Call effect.attachment and effect.cross in the scene");
  }

  bool refresh(const NodeVectors&) override { return false; }
  void apply(const SingleVectors& g, SingleVectors& d) const override {
    // The three axes at once.
    Eigen::MatrixX3d right(free_, 3);
    right << Eigen::Map<const Eigen::VectorXf>(g.x.data(), free_).cast<double>(), Eigen::Map<const Eigen::VectorXf>(g.y.data(), free_).cast<double>(),
        Eigen::Map<const Eigen::VectorXf>(g.z.data(), free_).cast<double>();
    const Eigen::MatrixX3d solved = factors_.solve(right);
    Eigen::Map<Eigen::VectorXf>(d.x.data(), free_) = solved.col(0).cast<float>();
    Eigen::Map<Eigen::VectorXf>(d.y.data(), free_) = solved.col(1).cast<float>();
    Eigen::Map<Eigen::VectorXf>(d.z.data(), free_) = solved.col(2).cast<float>();
  }

 private:
  Eigen::Index free_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace

std::unique_ptr<Metric> makeProjectiveMetric(const System& system) { return std::make_unique<ProjectiveMetric>(system); }

}  // namespace pectora
