// The nearest triangle of a mesh: a balanced tree of boxes, eight children a node and eight triangles a leaf, both tested at once.
#pragma once

#include "kernel/value/mesh.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace pectora {

/// The nearest triangle found so far.
struct NearestTriangle {
  double squared = std::numeric_limits<double>::infinity();   ///< mm^2
  int triangle = -1;
};

class TriangleBvh {
 public:
  /// Triangles without an area are left out: their edges belong to others. The mesh's indices must be good, and its coordinates
  /// finite and below kHuge. Built on all threads, the same for any number of them.
  explicit TriangleBvh(const Mesh& mesh);

  bool empty() const { return blockCount_ == 0; }
  /// Where a search begins: nodes, or blocks, of one level.
  struct Start {
    static constexpr int kMost = 6;
    int level = 0, count = 0;
    std::int32_t nodes[kMost];
  };
  /// The whole tree.
  Start root() const { return {int(levels_.size()), 1, {0}}; }
  /// Nodes that hold every triangle that comes into the ball: a shorter way for points close together.
  Start startFor(Vec3 center, double radius) const;

  /// The nearest triangle below `start`, the first of the mesh among equally near ones; exact in double. `best` may hold a triangle to
  /// begin with: a near one makes the search shorter, and never changes what it finds. Coordinates of p are below kHuge.
  void search(Vec3 p, const Start& start, NearestTriangle& best) const;

  static constexpr double kHuge = 1e12;   ///< mm; its square still has a place in a float

  static constexpr int kWide = 8;
  struct Node {
    float low[3][kWide], high[3][kWide];   ///< boxes of the children, about the centre, rounded outwards
  };
  /// Flat cylinders around a node's children: a sheet that lies askew fills little of its box.
  struct Discs {
    float center[3][kWide], axis[3][kWide], radius[kWide], half[kWide];   ///< radius across, half height along the axis, rounded up
  };
  struct Block {
    double a[3][kWide], ab[3][kWide], ac[3][kWide];
    std::int32_t id[kWide];
    bool hasThin;                          ///< one of them is so thin that its barycentric coordinates mean nothing
  };

 private:
  struct Local;
  Local local(Vec3 p) const;
  std::vector<std::int32_t> order(const Mesh& mesh);
  void fillBlocks(const Mesh& mesh, const std::vector<std::int32_t>& sorted);
  void fillNodes();
  void fillDiscs();

  Vec3 center_;
  float extent_ = 0;                        // largest coordinate about the centre, mm
  std::size_t blockCount_ = 0;
  std::unique_ptr<Block[]> blocks_;         // leaves, in the tree's order
  std::vector<std::vector<Node>> levels_;   // node j of level l has the children 8 j ... 8 j + 7 of level l - 1 (of the blocks)
  std::vector<std::vector<Discs>> discs_;   // of the lowest levels, where the surface is nearly flat
};

}  // namespace pectora
