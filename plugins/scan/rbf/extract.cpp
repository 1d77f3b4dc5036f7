#include "plugins/scan/rbf/extract.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace pectora {
namespace {

using Place = std::array<std::int32_t, 3>;   // of a cell, or of a grid point: its lowest corner

std::uint64_t keyOf(const Place& p) {
  std::uint64_t key = 0;
  for (int a = 0; a < 3; ++a) key = key << 21 | (std::uint64_t(std::int64_t(p[a]) + (1 << 20)) & 0x1fffff);
  return key;
}

// Corner c of a cell has the bits of c as offsets. The six tetrahedra around the diagonal from corner 0 to 7, one for each order of the axes.
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};

class Extraction {
 public:
  Extraction(const std::function<double(Vec3)>& field, const std::function<double(Vec3)>& distance, const ExtractSettings& settings)
      : field_(field), distance_(distance), settings_(settings) {}

  Mesh run(const std::vector<Vec3>& seeds, const std::function<void(double)>& poll) {
    std::vector<Place> wave;
    for (const Vec3& seed : seeds) {
      Place place;
      for (int a = 0; a < 3; ++a) place[a] = std::int32_t(std::floor(seed[a] / settings_.cell));
      if (seen_.emplace(keyOf(place), true).second) wave.push_back(place);
    }
    while (!wave.empty()) {
      poll(0.5);
      evaluateCorners(wave);
      std::vector<Place> candidates;
      for (const Place& cell : wave) march(cell, candidates);
      wave = withinReach(candidates);
    }
    return std::move(mesh_);
  }

 private:
  Vec3 position(const Place& p) const { return Vec3{double(p[0]), double(p[1]), double(p[2])} * settings_.cell; }
  static Place corner(const Place& cell, int c) { return {cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)}; }

  // Values at the grid points that these cells have and no cell before them had.
  void evaluateCorners(const std::vector<Place>& cells) {
    std::vector<Place> fresh;
    for (const Place& cell : cells)
      for (int c = 0; c < 8; ++c) {
        const Place p = corner(cell, c);
        if (nodes_.emplace(keyOf(p), std::int32_t(values_.size() + fresh.size())).second) fresh.push_back(p);
      }
    const std::size_t first = values_.size();
    values_.resize(first + fresh.size());
    constexpr std::size_t kBlock = 64;
    parallelFor((fresh.size() + kBlock - 1) / kBlock, [&](std::size_t b) {
      for (std::size_t i = b * kBlock; i < std::min(fresh.size(), (b + 1) * kBlock); ++i) values_[first + i] = field_(position(fresh[i]));
    });
  }

  void march(const Place& cell, std::vector<Place>& candidates) {
    int node[8];
    bool inside[8];
    for (int c = 0; c < 8; ++c) {
      node[c] = nodes_.at(keyOf(corner(cell, c)));
      if (std::isnan(values_[node[c]])) return;
      inside[c] = values_[node[c]] < 0;
    }
    for (const auto& tetrahedron : kTetrahedra) triangles(cell, tetrahedron, node, inside);
    // On through every face whose corners differ.
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        int count = 0;
        for (int c = 0; c < 8; ++c) count += (c >> axis & 1) == side && inside[c];
        if (count == 0 || count == 4) continue;
        Place next = cell;
        next[axis] += side == 1 ? 1 : -1;
        if (seen_.emplace(keyOf(next), true).second) candidates.push_back(next);
      }
  }

  void triangles(const Place& cell, const int (&t)[4], const int (&node)[8], const bool (&inside)[8]) {
    int in[4], out[4], ins = 0, outs = 0;
    for (int c : t) inside[c] ? in[ins++] = c : out[outs++] = c;
    if (ins == 0 || outs == 0) return;
    Vec3 outwards;
    for (int k = 0; k < outs; ++k) outwards += position(corner(cell, out[k])) / double(outs);
    for (int k = 0; k < ins; ++k) outwards -= position(corner(cell, in[k])) / double(ins);
    const auto cut = [&](int a, int b) { return vertex(cell, a, b, node); };
    if (ins == 1) add({cut(in[0], out[0]), cut(in[0], out[1]), cut(in[0], out[2])}, outwards);
    else if (outs == 1) add({cut(out[0], in[0]), cut(out[0], in[1]), cut(out[0], in[2])}, outwards);
    else {
      const int a = cut(in[0], out[0]), b = cut(in[0], out[1]), c = cut(in[1], out[1]), d = cut(in[1], out[0]);
      add({a, b, c}, outwards);
      add({a, c, d}, outwards);
    }
  }

  // The point where an edge crosses zero, one for all tetrahedra that share the edge.
  int vertex(const Place& cell, int a, int b, const int (&node)[8]) {
    if (node[a] > node[b]) std::swap(a, b);
    const std::uint64_t key = std::uint64_t(node[a]) << 32 | std::uint32_t(node[b]);
    const auto [entry, isNew] = vertices_.emplace(key, int(mesh_.points.size()));
    if (isNew) {
      // Kept off the ends, so that no triangle loses its area.
      const double va = values_[node[a]], vb = values_[node[b]], t = std::clamp(va / (va - vb), 1e-3, 1 - 1e-3);
      mesh_.points.push_back(lerp(position(corner(cell, a)), position(corner(cell, b)), t));
    }
    return entry->second;
  }

  void add(std::array<int, 3> t, Vec3 outwards) {
    const Vec3 normal = cross(mesh_.points[t[1]] - mesh_.points[t[0]], mesh_.points[t[2]] - mesh_.points[t[0]]);
    if (dot(normal, outwards) < 0) std::swap(t[1], t[2]);
    mesh_.triangles.push_back(t);
  }

  std::vector<Place> withinReach(const std::vector<Place>& candidates) const {
    std::vector<char> isNear(candidates.size());
    constexpr std::size_t kBlock = 256;
    const Vec3 middle = Vec3{0.5, 0.5, 0.5} * settings_.cell;
    parallelFor((candidates.size() + kBlock - 1) / kBlock, [&](std::size_t b) {
      for (std::size_t i = b * kBlock; i < std::min(candidates.size(), (b + 1) * kBlock); ++i) isNear[i] = distance_(position(candidates[i]) + middle) <= settings_.reach;
    });
    std::vector<Place> kept;
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (isNear[i]) kept.push_back(candidates[i]);
    return kept;
  }

  const std::function<double(Vec3)>&field_, &distance_;
  const ExtractSettings& settings_;
  std::unordered_map<std::uint64_t, bool> seen_;
  std::unordered_map<std::uint64_t, std::int32_t> nodes_;
  std::unordered_map<std::uint64_t, int> vertices_;
  std::vector<double> values_;
  Mesh mesh_;
};

}  // namespace

Mesh extractSurface(const std::vector<Vec3>& seeds, const std::function<double(Vec3)>& field, const std::function<double(Vec3)>& distance,
                    const ExtractSettings& settings, const std::function<void(double)>& poll) {
  return Extraction(field, distance, settings).run(seeds, poll);
}

}  // namespace pectora
