#include "plugins/common/surface/triangle_bvh.h"

#include "plugins/common/surface/balanced_order.h"
#include "plugins/common/surface/closest.h"

#include "kernel/physics/rows.h"
#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pectora {
namespace {

constexpr int kWide = TriangleBvh::kWide;

void parallelBlocks(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
  constexpr std::size_t kChunk = 8192;
  parallelFor((count + kChunk - 1) / kChunk, [&](std::size_t c) { body(c * kChunk, std::min(count, (c + 1) * kChunk)); });
}

// Squared distances from p to eight boxes, never too large: `slack` covers the rounding of p and of the boxes.
PECTORA_INLINE void boxDistances(const TriangleBvh::Node& node, const float p[3], float slack, float* __restrict squared) {
  const float px = p[0], py = p[1], pz = p[2];
  const auto outside = [slack](float below, float above) {
    const float d = (below > above ? below : above) - slack;
    return d > 0 ? d : 0.0f;
  };
#pragma GCC ivdep
  for (int i = 0; i < kWide; ++i) {
    const float x = outside(node.low[0][i] - px, px - node.high[0][i]);
    const float y = outside(node.low[1][i] - py, py - node.high[1][i]);
    const float z = outside(node.low[2][i] - pz, pz - node.high[2][i]);
    squared[i] = (x * x + y * y + z * z) * (1 - 1e-6f);
  }
}

// The same to eight flat cylinders; the larger one stays.
PECTORA_INLINE void discDistances(const TriangleBvh::Discs& discs, const float p[3], float slack, float* __restrict squared) {
  const float px = p[0], py = p[1], pz = p[2];
#pragma GCC ivdep
  for (int i = 0; i < kWide; ++i) {
    const float x = px - discs.center[0][i], y = py - discs.center[1][i], z = pz - discs.center[2][i];
    const float along = x * discs.axis[0][i] + y * discs.axis[1][i] + z * discs.axis[2][i], whole = x * x + y * y + z * z;
    // across^2 = whole - along^2 errs by some 1e-7 of whole.
    const float error = whole * 2e-6f;
    float high = std::abs(along) - discs.half[i] - slack, across = whole - along * along - error;
    high = high > 0 ? high : 0.0f;
    across = across > 0 ? across : 0.0f;
    float beside = std::sqrt(across) - discs.radius[i] - slack;
    beside = beside > 0 ? beside : 0.0f;
    const float sum = high * high + beside * beside - error;
    squared[i] = sum > squared[i] ? sum : squared[i];
  }
}

// Squared distances from p to a block's triangles (Ericson 2005, 5.1.5, all regions at once, the first that holds chosen last).
// A plain loop: compilers turn it into masks and blends, where comparisons of whole vectors come out lane by lane.
PECTORA_INLINE void triangleDistances(const TriangleBvh::Block& block, const double p[3], double* __restrict squared) {
  const double px = p[0], py = p[1], pz = p[2];
#pragma GCC ivdep
  for (int i = 0; i < kWide; ++i) {
    const double abx = block.ab[0][i], aby = block.ab[1][i], abz = block.ab[2][i], acx = block.ac[0][i], acy = block.ac[1][i], acz = block.ac[2][i];
    const double apx = px - block.a[0][i], apy = py - block.a[1][i], apz = pz - block.a[2][i];
    const double d1 = abx * apx + aby * apy + abz * apz, d2 = acx * apx + acy * apy + acz * apz;
    const double abab = abx * abx + aby * aby + abz * abz, abac = abx * acx + aby * acy + abz * acz, acac = acx * acx + acy * acy + acz * acz;
    const double d3 = d1 - abab, d4 = d2 - abac, d5 = d1 - abac, d6 = d2 - acac;
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    const double sum = va + vb + vc, e = d4 - d3, f = d5 - d6;
    const double onBc = e / (e + f), onCa = d2 / (d2 - d6), onAb = d1 / (d1 - d3);
    double v = vb / sum, w = vc / sum;
    const bool inBc = (va <= 0) & (e >= 0) & (f >= 0), inCa = (vb <= 0) & (d2 >= 0) & (d6 <= 0), inAb = (vc <= 0) & (d1 >= 0) & (d3 <= 0);
    const bool inC = (d6 >= 0) & (d5 <= d6), inB = (d3 >= 0) & (d4 <= d3), inA = (d1 <= 0) & (d2 <= 0);
    v = inBc ? 1 - onBc : v;
    w = inBc ? onBc : w;
    v = inCa ? 0.0 : v;
    w = inCa ? onCa : w;
    v = inAb ? onAb : v;
    w = inAb ? 0.0 : w;
    v = inC ? 0.0 : v;
    w = inC ? 1.0 : w;
    v = inB ? 1.0 : v;
    w = inB ? 0.0 : w;
    v = inA ? 0.0 : v;
    w = inA ? 0.0 : w;
    const double x = apx - abx * v - acx * w, y = apy - aby * v - acy * w, z = apz - abz * v - acz * w;
    squared[i] = x * x + y * y + z * z;
  }
}

// The same one by one, for triangles whose barycentric coordinates mean nothing.
void thinDistances(const TriangleBvh::Block& block, const double p[3], double squared[kWide]) {
  for (int i = 0; i < kWide; ++i) {
    const Vec3 a{block.a[0][i], block.a[1][i], block.a[2][i]}, here{p[0], p[1], p[2]};
    const Vec3 b = a + Vec3{block.ab[0][i], block.ab[1][i], block.ab[2][i]}, c = a + Vec3{block.ac[0][i], block.ac[1][i], block.ac[2][i]};
    const Vec3 d = here - closestOnTriangle(here, a, b, c).point;
    squared[i] = dot(d, d);
  }
}

// A float that is not below the value.
PECTORA_INLINE float roundedUp(double value) {
  const float near = float(value);
  return near + std::abs(near) * 2.4e-7f + std::numeric_limits<float>::min();
}

struct Entry {
  float squared;
  std::int32_t level;   // 0: a block
  std::int32_t index;
};

// What a search reads of the tree.
struct Tree {
  const std::vector<TriangleBvh::Node>* levels;
  const std::vector<TriangleBvh::Discs>* discs;
  int discLevels;
  const TriangleBvh::Block* blocks;
  std::int32_t blockCount;

  // Lower bounds for the children of a node, and how many it has; `below` is their level.
  __attribute__((always_inline)) int childDistances(std::int32_t below, std::int32_t node, const float p[3], float slack, float* squared) const {
    boxDistances(levels[below][node], p, slack, squared);
    if (below < discLevels) discDistances(discs[below][node], p, slack, squared);
    const std::int32_t count = below == 0 ? blockCount : std::int32_t(levels[below - 1].size());
    return std::min<std::int32_t>(kWide, count - kWide * node);
  }
};

PECTORA_WIDE void searchTree(const Tree& tree, const TriangleBvh::Start& start, const double p[3], const float pf[3], float slack, NearestTriangle* found) {
  NearestTriangle best = *found;
  float bound = roundedUp(best.squared);
  Entry stack[128];
  int size = 0;
  for (int i = 0; i < start.count; ++i) stack[size++] = {0, start.level, start.nodes[i]};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.squared > bound) continue;
    if (entry.level == 0) {
      const TriangleBvh::Block& block = tree.blocks[entry.index];
      double squared[kWide];
      if (block.hasThin) thinDistances(block, p, squared);
      else triangleDistances(block, p, squared);
      for (int i = 0; i < kWide; ++i)
        if (squared[i] < best.squared || (squared[i] == best.squared && block.id[i] < best.triangle)) best = {squared[i], block.id[i]};
      bound = roundedUp(best.squared);
      continue;
    }
    float squared[kWide];
    const std::int32_t below = entry.level - 1, first = kWide * entry.index;
    const int children = tree.childDistances(below, entry.index, pf, slack, squared), base = size;
    // The nearest comes to lie on top.
    for (int i = 0; i < children; ++i) {
      if (squared[i] > bound) continue;
      int at = size++;
      for (; at > base && stack[at - 1].squared < squared[i]; --at) stack[at] = stack[at - 1];
      stack[at] = {squared[i], below, first + i};
    }
  }
  *found = best;
}

// The nodes of `level` within a distance, below the node `index` of `from`; false if they are more than have a place.
PECTORA_WIDE bool collect(const Tree& tree, int from, std::int32_t index, const float pf[3], float slack, float bound, TriangleBvh::Start* start) {
  Entry stack[128];
  int size = 0;
  stack[size++] = {0, from, index};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.level == start->level) {
      if (start->count == TriangleBvh::Start::kMost) return false;
      start->nodes[start->count++] = entry.index;
      continue;
    }
    float squared[kWide];
    const std::int32_t below = entry.level - 1;
    const int children = tree.childDistances(below, entry.index, pf, slack, squared);
    for (int i = 0; i < children; ++i)
      if (squared[i] <= bound) stack[size++] = {squared[i], below, kWide * entry.index + i};
  }
  return true;
}

}  // namespace

TriangleBvh::TriangleBvh(const Mesh& mesh) {
  const std::vector<std::int32_t> sorted = order(mesh);
  if (sorted.empty()) return;
  fillBlocks(mesh, sorted);
  fillNodes();
  fillDiscs();
}

std::vector<std::int32_t> TriangleBvh::order(const Mesh& mesh) {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (const auto& t : mesh.triangles)
    for (int corner : t)
      for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], mesh.points[corner][a]), high[a] = std::max(high[a], mesh.points[corner][a]);
  if (mesh.triangles.empty()) return {};
  center_ = (low + high) / 2;
  const Vec3 half = (high - low) / 2;
  extent_ = roundedUp(std::max({half.x, half.y, half.z}));

  std::vector<TreeItem> items(mesh.triangles.size());
  parallelBlocks(items.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& t = mesh.triangles[i];
      const Vec3 a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
      const Vec3 middle = (a - center_ + (b - center_) + (c - center_)) / 3;
      const bool hasArea = norm(cross(b - a, c - a)) > 0;
      items[i] = {{float(middle.x), float(middle.y), float(middle.z)}, hasArea ? std::int32_t(i) : -1};
    }
  });
  std::erase_if(items, [](const TreeItem& item) { return item.id < 0; });
  // Every aligned run of 8^k blocks is one node.
  return balancedOrder(std::move(items), kWide);
}

void TriangleBvh::fillBlocks(const Mesh& mesh, const std::vector<std::int32_t>& sorted) {
  blockCount_ = (sorted.size() + kWide - 1) / kWide;
  blocks_ = std::make_unique_for_overwrite<Block[]>(blockCount_);   // most of the tree's memory, written once
  parallelBlocks(blockCount_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      Block& block = blocks_[b];
      block.hasThin = false;
      for (int i = 0; i < kWide; ++i) {
        // The last block repeats its last triangle.
        const std::int32_t id = sorted[std::min(kWide * b + i, sorted.size() - 1)];
        const auto& t = mesh.triangles[id];
        const Vec3 a = mesh.points[t[0]], ab = mesh.points[t[1]] - a, ac = mesh.points[t[2]] - a, bc = ac - ab, n = cross(ab, ac);
        for (int k = 0; k < 3; ++k) block.a[k][i] = a[k], block.ab[k][i] = ab[k], block.ac[k][i] = ac[k];
        block.id[i] = id;
        // Height over the longest side below 1e-6 of it: products of four lengths lose too many of their 16 digits.
        const double longest = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});
        block.hasThin = block.hasThin || !(dot(n, n) > 1e-12 * longest * longest);
      }
    }
  });
}

void TriangleBvh::fillNodes() {
  const auto enclose = [](Node& node, int child, const float low[3], const float high[3]) {
    for (int a = 0; a < 3; ++a) node.low[a][child] = low[a], node.high[a][child] = high[a];
  };
  for (std::size_t count = blockCount_;;) {
    const std::size_t level = levels_.size(), parents = (count + kWide - 1) / kWide;
    levels_.emplace_back(parents);
    parallelBlocks(parents, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) {
        Node& node = levels_[level][j];
        for (int i = 0; i < kWide; ++i) {
          float low[3], high[3];
          std::fill_n(low, 3, INFINITY);
          std::fill_n(high, 3, -INFINITY);
          const std::size_t child = kWide * j + i;
          for (int k = 0; k < kWide && child < count; ++k) {
            for (int a = 0; a < 3; ++a) {
              if (level > 0) {
                low[a] = std::min(low[a], levels_[level - 1][child].low[a][k]);
                high[a] = std::max(high[a], levels_[level - 1][child].high[a][k]);
                continue;
              }
              const Block& block = blocks_[child];
              const double corner = block.a[a][k] - center_[a];
              low[a] = std::min(low[a], -roundedUp(-(corner + std::min({0.0, block.ab[a][k], block.ac[a][k]}))));
              high[a] = std::max(high[a], roundedUp(corner + std::max({0.0, block.ab[a][k], block.ac[a][k]})));
            }
          }
          enclose(node, i, low, high);
        }
      }
    });
    if (parents == 1) return;
    count = parents;
  }
}

void TriangleBvh::fillDiscs() {
  constexpr std::size_t kDiscLevels = 2;
  discs_.resize(std::min(kDiscLevels, levels_.size()));
  std::size_t perChild = 1;   // blocks below one child
  for (auto& level : discs_) {
    level.resize(levels_[&level - discs_.data()].size());
    parallelBlocks(level.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j)
        for (int i = 0; i < kWide; ++i) {
          const std::size_t first = std::min(blockCount_, (kWide * j + i) * perChild), last = std::min(blockCount_, first + perChild);
          // The axis is the mean normal, the centre the middle of the first corners.
          Vec3 normal, middle;
          for (std::size_t b = first; b < last; ++b)
            for (int k = 0; k < kWide; ++k) {
              const Block& t = blocks_[b];
              normal += cross({t.ab[0][k], t.ab[1][k], t.ab[2][k]}, {t.ac[0][k], t.ac[1][k], t.ac[2][k]});
              middle += Vec3{t.a[0][k], t.a[1][k], t.a[2][k]} / double(kWide * (last - first));
            }
          normal = normalized(normal);
          Discs& discs = level[j];
          float axis[3], center[3];
          for (int a = 0; a < 3; ++a) discs.axis[a][i] = axis[a] = float(normal[a]), discs.center[a][i] = center[a] = float(middle[a] - center_[a]);
          const Vec3 n{axis[0], axis[1], axis[2]}, c{center[0] + center_.x, center[1] + center_.y, center[2] + center_.z};
          double half = 0, across = 0;
          for (std::size_t b = first; b < last; ++b)
            for (int k = 0; k < kWide; ++k) {
              const Block& t = blocks_[b];
              const Vec3 corner{t.a[0][k], t.a[1][k], t.a[2][k]};
              for (const Vec3& v : {corner, corner + Vec3{t.ab[0][k], t.ab[1][k], t.ab[2][k]}, corner + Vec3{t.ac[0][k], t.ac[1][k], t.ac[2][k]}}) {
                const double along = dot(v - c, n);
                half = std::max(half, std::abs(along));
                across = std::max(across, dot(v - c, v - c) - along * along);
              }
            }
          discs.half[i] = float(half * (1 + 1e-5));
          discs.radius[i] = float(std::sqrt(across) * (1 + 1e-5));
        }
    });
    perChild *= kWide;
  }
}

// A point as the search takes it.
struct TriangleBvh::Local {
  Tree tree;
  double exact[3];
  float about[3];   // the centre
  float slack;
};

TriangleBvh::Local TriangleBvh::local(Vec3 p) const {
  const Vec3 d = p - center_;
  const float about[3] = {float(d.x), float(d.y), float(d.z)};
  // Rounding p, the boxes and their difference errs by less than four units in the last place of the largest coordinate.
  const float largest = std::max({extent_, std::abs(about[0]), std::abs(about[1]), std::abs(about[2])});
  return {{levels_.data(), discs_.data(), int(discs_.size()), blocks_.get(), std::int32_t(blockCount_)}, {p.x, p.y, p.z}, {about[0], about[1], about[2]}, largest * 5e-7f};
}

TriangleBvh::Start TriangleBvh::startFor(Vec3 center, double radius) const {
  // Nodes of 64 blocks: lower ones would be too many.
  constexpr int kLevel = 2;
  Start start = root();
  if (start.level <= kLevel) return start;
  start = {kLevel, 0, {}};
  const Local p = local(center);
  return collect(p.tree, int(levels_.size()), 0, p.about, p.slack, roundedUp(radius * radius), &start) ? start : root();
}

void TriangleBvh::search(Vec3 p, const Start& start, NearestTriangle& best) const {
  const Local here = local(p);
  searchTree(here.tree, start, here.exact, here.about, here.slack, &best);
}

}  // namespace pectora
