#include "plugins/common/surface/triangle_bvh.h"

#include "plugins/common/surface/closest.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>
#include <cstring>

// Eight lanes at a time in whatever the processor has. Without fused operations every version gives the same bits.
// (Sanitizers cannot look into functions that are resolved while the program is loaded.)
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PECTORA_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define PECTORA_CLONES
#endif

namespace pectora {
namespace {

constexpr int kWide = TriangleBvh::kWide;
typedef float Floats __attribute__((vector_size(sizeof(float) * kWide)));
typedef double Doubles __attribute__((vector_size(sizeof(double) * kWide)));

// A centre and its triangle, to be sorted.
struct Item {
  float center[3];
  std::int32_t id;
};

// Puts the items into the tree's order: halved along the longest side, at a power of two times a block, so that
// every aligned run of 8^k blocks is one node.
std::size_t splitAt(std::size_t count) {
  std::size_t unit = kWide;
  while (2 * unit < count) unit *= 2;
  return unit;
}

std::size_t halve(Item* items, std::size_t count) {
  float low[3], high[3];
  std::copy_n(items->center, 3, low);
  std::copy_n(items->center, 3, high);
  for (std::size_t i = 1; i < count; ++i)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], items[i].center[a]), high[a] = std::max(high[a], items[i].center[a]);
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
  const std::size_t middle = splitAt(count);
  std::nth_element(items, items + middle, items + count, [axis](const Item& l, const Item& r) {
    return l.center[axis] != r.center[axis] ? l.center[axis] < r.center[axis] : l.id < r.id;
  });
  return middle;
}

void sortItems(Item* items, std::size_t count) {
  if (count <= std::size_t(kWide)) return;
  const std::size_t middle = halve(items, count);
  constexpr std::size_t kTask = 1 << 14;
  if (count <= kTask) {
    sortItems(items, middle);
    sortItems(items + middle, count - middle);
  } else {
    parallelFor(2, [&](std::size_t half) { half == 0 ? sortItems(items, middle) : sortItems(items + middle, count - middle); });
  }
}

void parallelBlocks(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
  constexpr std::size_t kChunk = 8192;
  parallelFor((count + kChunk - 1) / kChunk, [&](std::size_t c) { body(c * kChunk, std::min(count, (c + 1) * kChunk)); });
}

template <class Wide, class T>
__attribute__((always_inline)) inline void load(Wide& wide, const T* values) {
  std::memcpy(&wide, values, sizeof wide);
}

// Squared distances from p to eight boxes, never too large: `slack` covers the rounding of p and of the boxes.
__attribute__((always_inline)) inline void boxDistances(const TriangleBvh::Node& node, const float p[3], float slack, float squared[kWide]) {
  Floats sum{};
  for (int a = 0; a < 3; ++a) {
    Floats below, above;
    load(below, node.low[a]);
    load(above, node.high[a]);
    below -= p[a];
    above = p[a] - above;
    Floats d = (below > above ? below : above) - slack;
    d = d > 0.0f ? d : Floats{};
    sum += d * d;
  }
  sum *= 1 - 1e-6f;
  std::memcpy(squared, &sum, sizeof sum);
}

// The same to eight flat cylinders.
__attribute__((always_inline)) inline void discDistances(const TriangleBvh::Discs& discs, const float p[3], float slack, float squared[kWide]) {
  Floats along{}, whole{}, radius, half;
  for (int a = 0; a < 3; ++a) {
    Floats d, axis;
    load(d, discs.center[a]);
    load(axis, discs.axis[a]);
    d = p[a] - d;
    along += d * axis;
    whole += d * d;
  }
  load(radius, discs.radius);
  load(half, discs.half);
  // across^2 = whole - along^2 errs by some 1e-7 of whole.
  const Floats error = whole * 2e-6f;
  Floats high = (along > 0.0f ? along : -along) - half - slack, across = whole - along * along - error;
  high = high > 0.0f ? high : Floats{};
  across = across > 0.0f ? across : Floats{};
  Floats root{};
  for (int i = 0; i < kWide; ++i) root[i] = std::sqrt(across[i]);
  root = root - radius - slack;
  root = root > 0.0f ? root : Floats{};
  const Floats sum = high * high + root * root - error;
  Floats before;
  load(before, squared);
  before = sum > before ? sum : before;
  std::memcpy(squared, &before, sizeof before);
}

// Squared distances from p to a block's triangles (Ericson 2005, 5.1.5, all regions at once, the first that holds chosen last).
__attribute__((always_inline)) inline void triangleDistances(const TriangleBvh::Block& block, const double p[3], double squared[kWide]) {
  Doubles ap[3], ab[3], ac[3], d1{}, d2{}, abab{}, abac{}, acac{};
  for (int a = 0; a < 3; ++a) {
    load(ap[a], block.a[a]);
    load(ab[a], block.ab[a]);
    load(ac[a], block.ac[a]);
    ap[a] = p[a] - ap[a];
    d1 += ab[a] * ap[a];
    d2 += ac[a] * ap[a];
    abab += ab[a] * ab[a];
    abac += ab[a] * ac[a];
    acac += ac[a] * ac[a];
  }
  const Doubles d3 = d1 - abab, d4 = d2 - abac, d5 = d1 - abac, d6 = d2 - acac;
  const Doubles vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  const Doubles zero{}, one = zero + 1, sum = va + vb + vc, e = d4 - d3, f = d5 - d6;
  Doubles v = vb / sum, w = vc / sum;
  const auto choose = [&](auto region, Doubles newV, Doubles newW) {
    v = region ? newV : v;
    w = region ? newW : w;
  };
  const Doubles onBc = e / (e + f), onCa = d2 / (d2 - d6), onAb = d1 / (d1 - d3);
  choose((va <= 0) & (e >= 0) & (f >= 0), one - onBc, onBc);
  choose((vb <= 0) & (d2 >= 0) & (d6 <= 0), zero, onCa);
  choose((vc <= 0) & (d1 >= 0) & (d3 <= 0), onAb, zero);
  choose((d6 >= 0) & (d5 <= d6), zero, one);
  choose((d3 >= 0) & (d4 <= d3), one, zero);
  choose((d1 <= 0) & (d2 <= 0), zero, zero);
  Doubles total{};
  for (int a = 0; a < 3; ++a) {
    const Doubles d = ap[a] - ab[a] * v - ac[a] * w;
    total += d * d;
  }
  std::memcpy(squared, &total, sizeof total);
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

struct Entry {
  float squared;
  std::int32_t level;   // 0: a block
  std::int32_t index;
};

PECTORA_CLONES
void searchTree(const std::vector<TriangleBvh::Node>* levels, int top, const std::vector<TriangleBvh::Discs>* discs, int discLevels, const TriangleBvh::Block* blocks, std::int32_t blockCount,
                const double p[3], const float pf[3], float slack, NearestTriangle* found) {
  NearestTriangle best = *found;
  Entry stack[128];
  int size = 0;
  stack[size++] = {0, top, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (double(entry.squared) > best.squared) continue;
    if (entry.level == 0) {
      const TriangleBvh::Block& block = blocks[entry.index];
      double squared[kWide];
      if (block.hasThin) thinDistances(block, p, squared);
      else triangleDistances(block, p, squared);
      for (int i = 0; i < kWide; ++i)
        if (squared[i] < best.squared || (squared[i] == best.squared && block.id[i] < best.triangle)) best = {squared[i], block.id[i]};
      continue;
    }
    float squared[kWide];
    boxDistances(levels[entry.level - 1][entry.index], pf, slack, squared);
    if (entry.level <= discLevels) discDistances(discs[entry.level - 1][entry.index], pf, slack, squared);
    const std::int32_t below = entry.level - 1, count = below == 0 ? blockCount : std::int32_t(levels[below - 1].size());
    const std::int32_t first = kWide * entry.index;
    const int children = std::min<std::int32_t>(kWide, count - first), base = size;
    // The nearest comes to lie on top.
    for (int i = 0; i < children; ++i) {
      if (double(squared[i]) > best.squared) continue;
      int at = size++;
      for (; at > base && stack[at - 1].squared < squared[i]; --at) stack[at] = stack[at - 1];
      stack[at] = {squared[i], below, first + i};
    }
  }
  *found = best;
}

}  // namespace

TriangleBvh::TriangleBvh(const Mesh& mesh) {
  std::vector<std::int32_t> sorted;
  order(mesh, sorted);
  if (sorted.empty()) return;
  fillBlocks(mesh, sorted);
  fillNodes();
  fillDiscs();
}

void TriangleBvh::order(const Mesh& mesh, std::vector<std::int32_t>& sorted) {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (const auto& t : mesh.triangles)
    for (int corner : t)
      for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], mesh.points[corner][a]), high[a] = std::max(high[a], mesh.points[corner][a]);
  if (mesh.triangles.empty()) return;
  center_ = (low + high) / 2;
  const Vec3 half = (high - low) / 2;
  extent_ = std::nextafterf(float(std::max({half.x, half.y, half.z})), INFINITY);

  std::vector<Item> items(mesh.triangles.size());
  parallelBlocks(items.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& t = mesh.triangles[i];
      const Vec3 a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
      const Vec3 middle = (a - center_ + (b - center_) + (c - center_)) / 3;
      const bool hasArea = norm(cross(b - a, c - a)) > 0;
      items[i] = {{float(middle.x), float(middle.y), float(middle.z)}, hasArea ? std::int32_t(i) : -1};
    }
  });
  std::erase_if(items, [](const Item& item) { return item.id < 0; });
  sortItems(items.data(), items.size());
  for (const Item& item : items) sorted.push_back(item.id);
}

void TriangleBvh::fillBlocks(const Mesh& mesh, const std::vector<std::int32_t>& sorted) {
  blocks_.resize((sorted.size() + kWide - 1) / kWide);
  parallelBlocks(blocks_.size(), [&](std::size_t begin, std::size_t end) {
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
  for (std::size_t count = blocks_.size();;) {
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
              low[a] = std::min(low[a], std::nextafterf(float(corner + std::min({0.0, block.ab[a][k], block.ac[a][k]})), -INFINITY));
              high[a] = std::max(high[a], std::nextafterf(float(corner + std::max({0.0, block.ab[a][k], block.ac[a][k]})), INFINITY));
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
          const std::size_t first = std::min(blocks_.size(), (kWide * j + i) * perChild), last = std::min(blocks_.size(), first + perChild);
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

void TriangleBvh::search(Vec3 p, NearestTriangle& best) const {
  const Vec3 local = p - center_;
  const double here[3] = {p.x, p.y, p.z};
  const float about[3] = {float(local.x), float(local.y), float(local.z)};
  // Rounding p, the boxes and their difference errs by less than four units in the last place of the largest coordinate.
  const float largest = std::max({extent_, std::abs(about[0]), std::abs(about[1]), std::abs(about[2])});
  searchTree(levels_.data(), int(levels_.size()), discs_.data(), int(discs_.size()), blocks_.data(), std::int32_t(blocks_.size()), here, about, largest * 5e-7f, &best);
}

}  // namespace pectora
