#include "kernel/physics/lattice_hessian.h"

namespace pectora::lattice {

LatticeHessian::LatticeHessian(const RestLattice& rest) : rest_(rest), moved_(rest.grid.nodes()) {}

void LatticeHessian::linearise(const NodeVectors& positions, bool projected) {
  constexpr std::size_t kPiece = 4096;
  forEachPiece(moved_.size(), kPiece, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) moved_.set(i, positions[i] - rest_.nodes[i]);
  });
  projected_ = projected;
}

RowSprings<float> LatticeHessian::springs(const Grid::Run& r, std::size_t entry) const {
  const StencilSpring& s = rest_.grid.stencil()[entry];
  return {r.count, rowOf(moved_, r.near), rowOf(moved_, r.far), rowOf(rest_.single, r.near), rowOf(rest_.single, r.far), float(s.stiffnessNPerMm), float(s.compression)};
}

bool LatticeHessian::isDegenerate(const Grid::Run& r, std::size_t i) const {
  // In the same steps as the rows do it.
  const SingleVectors& rest = rest_.single;
  const float x0 = rest.x[r.far + i] - rest.x[r.near + i], y0 = rest.y[r.far + i] - rest.y[r.near + i], z0 = rest.z[r.far + i] - rest.z[r.near + i];
  const float x = x0 + (moved_.x[r.far + i] - moved_.x[r.near + i]), y = y0 + (moved_.y[r.far + i] - moved_.y[r.near + i]),
              z = z0 + (moved_.z[r.far + i] - moved_.z[r.near + i]);
  return x * x + y * y + z * z <= kDegenerateSingle * kDegenerateSingle * (x0 * x0 + y0 * y0 + z0 * z0);
}

// It counts as projected: k along the direction at rest, or, if it has no length at rest, in any direction.
Symmetric3 LatticeHessian::degenerateBlock(const Grid::Run& r, std::size_t entry, std::size_t i) const {
  const StencilSpring& s = rest_.grid.stencil()[entry];
  const Vec3 d = rest_.nodes[r.far + i] - rest_.nodes[r.near + i], n = normalized(d);
  Symmetric3 block;
  if (norm(d) > 0) {
    const double k = s.stiffnessNPerMm * s.compression;
    block = {k * n.x * n.x, k * n.x * n.y, k * n.x * n.z, k * n.y * n.y, k * n.y * n.z, k * n.z * n.z};
  } else {
    block.addIdentity(s.stiffnessNPerMm);
  }
  return block;
}

void LatticeHessian::multiply(const NodeVectors& v, NodeVectors& y) const {
  SingleVectors in(rest_.grid.nodes()), out(in);
  take(v, {}, in);
  multiplySingle(in, out);
  for (std::size_t i = 0; i < out.size(); ++i) y.x[i] += double(out.x[i]);
  for (std::size_t i = 0; i < out.size(); ++i) y.y[i] += double(out.y[i]);
  for (std::size_t i = 0; i < out.size(); ++i) y.z[i] += double(out.z[i]);
}

void LatticeHessian::multiplySingle(const SingleVectors& v, SingleVectors& y) const {
  const Grid& grid = rest_.grid;
  const std::size_t columns = grid.columns();
  grid.forEachBlock([&](std::size_t, int begin, int end) {
    std::vector<float> work(3 * columns);
    const Row<float> pull{&work[0], &work[columns], &work[2 * columns]};
    grid.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      if (curvatureProducts(springs(r, entry), projected_, rowOf(v, r.near), rowOf(v, r.far), rowOf(y, r.near), pull))
        for (std::size_t i = 0; i < r.count; ++i)
          if (isDegenerate(r, i)) {
            const Vec3 p = degenerateBlock(r, entry, i) * (v[r.far + i] - v[r.near + i]);
            pull.x[i] = float(p.x), pull.y[i] = float(p.y), pull.z[i] = float(p.z);
            y.set(r.near + i, y[r.near + i] - p);
          }
      addRow(r.count, constant(pull), rowOf(y, r.far));
    });
  });
}

void LatticeHessian::fill(const Grid::Run& r, std::size_t entry, Blocks& blocks) const {
  if (!springBlocks(springs(r, entry), projected_, blocks.entries)) return;
  for (std::size_t i = 0; i < r.count; ++i)
    if (isDegenerate(r, i)) blocks.set(i, -degenerateBlock(r, entry, i));
}

void LatticeHessian::addDiagonal(std::vector<Symmetric3>& diagonal) const {
  const Grid& grid = rest_.grid;
  grid.forEachBlock([&](std::size_t, int begin, int end) {
    Blocks blocks(grid.columns());
    grid.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      fill(r, entry, blocks);
      for (std::size_t i = 0; i < r.count; ++i) {
        const Symmetric3 own = -blocks[i];
        diagonal[r.near + i] += own;
        diagonal[r.far + i] += own;
      }
    });
  });
}

void LatticeHessian::forEachCoupling(const Coupling& visit) const {
  Blocks blocks(rest_.grid.columns());
  rest_.grid.forEachRun([&](const Grid::Run& r, std::size_t entry) {
    fill(r, entry, blocks);
    for (std::size_t i = 0; i < r.count; ++i) {
      const Symmetric3 b = blocks[i];
      visit(r.near + i, r.far + i, {{{b.xx, b.xy, b.xz}, {b.xy, b.yy, b.yz}, {b.xz, b.yz, b.zz}}});
    }
  });
}

void LatticeHessian::forEachCouplingRun(const CouplingRun& run, const Coupling&) const {
  const Grid& grid = rest_.grid;
  grid.forEachBlock([&](std::size_t, int begin, int end) {
    Blocks blocks(grid.columns());
    float* const* e = blocks.entries;
    const float* const entries[9] = {e[0], e[1], e[2], e[1], e[3], e[4], e[2], e[4], e[5]};
    grid.forEachRun(begin, end, [&](const Grid::Run& r, std::size_t entry) {
      fill(r, entry, blocks);
      run(r.near, r.far, r.count, entries);
    });
  });
}

}  // namespace pectora::lattice
