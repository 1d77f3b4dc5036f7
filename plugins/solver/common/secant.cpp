#include "plugins/solver/common/secant.h"

#include "plugins/solver/common/node_algebra.h"

#include "kernel/physics/workers.h"

#include <cmath>

namespace pectora {
namespace {

// The driven nodes keep to their way if its cosine with the last one is at least so much, over all of them.
constexpr double kSameWay = 0.9;
// So many times the last movement are predicted, to and fro.
constexpr double kFarthest = 4;

// Of the last movement and this one, over the driven nodes.
struct Products {
  double lastLast = 0, lastNow = 0, nowNow = 0;
};

Products productsOf(const SingleVectors& last, const NodeVectors& from, const NodeVectors& to, std::size_t freeNodes) {
  constexpr std::size_t kPiece = 4096;
  const std::size_t driven = to.size() - freeNodes;
  std::vector<Products> parts(piecesOf(driven, kPiece));
  forEachPiece(driven, kPiece, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    Products& part = parts[piece];
    for (std::size_t i = freeNodes + begin; i < freeNodes + end; ++i) {
      const Vec3 before = last[i], now = to[i] - from[i];
      part.lastLast += dot(before, before), part.lastNow += dot(before, now), part.nowNow += dot(now, now);
    }
  });
  Products all;
  for (const Products& part : parts) all.lastLast += part.lastLast, all.lastNow += part.lastNow, all.nowNow += part.nowNow;
  return all;
}

}  // namespace

void Secant::remember(const NodeVectors& before, const NodeVectors& after, std::size_t freeNodes) {
  const auto moved = [&](std::size_t i) { const Vec3 way = after[i] - before[i]; return way.x != 0 || way.y != 0 || way.z != 0; };
  std::size_t i = freeNodes;
  while (i < after.size() && !moved(i)) ++i;
  if (i == after.size()) return;
  if (change_.size() != after.size()) change_ = SingleVectors(after.size());
  setSum(after, -1, before, change_, after.size());
}

void Secant::follow(const NodeVectors& from, NodeVectors& to, std::size_t freeNodes) const {
  if (change_.size() != to.size()) return;
  const Products of = productsOf(change_, from, to, freeNodes);
  if (of.nowNow == 0 || of.lastNow * of.lastNow < kSameWay * kSameWay * of.lastLast * of.nowNow) return;
  const double times = of.lastNow / of.lastLast;
  if (std::abs(times) <= kFarthest) setSum(to, times, change_, to, freeNodes);
}

}  // namespace pectora
