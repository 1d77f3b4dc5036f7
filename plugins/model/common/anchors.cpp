#include "plugins/model/common/anchors.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr int kAnchorsPerPoint = 3;
constexpr int kSamples = 96;
constexpr double kTouching = 5;   // mm: a spring as short as this would swing over, so the point is glued to the body instead

// A body as points that stand for it.
struct BodyPoints {
  BodyKind kind;
  int index;
  std::vector<Vec3> points;
  const Curve* curve;   // nullptr for the sternum
};

std::vector<BodyPoints> collectBodies(const RibCage& cage) {
  std::vector<BodyPoints> bodies;
  for (std::size_t i = 0; i < cage.ribs.size(); ++i)
    bodies.push_back({BodyKind::rib, int(i), cage.ribs[i].curve.sample(kSamples), &cage.ribs[i].curve});
  for (std::size_t i = 0; i < cage.cartilages.size(); ++i)
    bodies.push_back({BodyKind::cartilage, int(i), cage.cartilages[i].curve.sample(kSamples), &cage.cartilages[i].curve});
  BodyPoints sternum{BodyKind::sternum, 0, {}, nullptr};
  for (const auto& contour : cage.anatomy->sternum.contours)
    sternum.points.insert(sternum.points.end(), contour.begin(), contour.end());
  if (!sternum.points.empty()) bodies.push_back(std::move(sternum));
  return bodies;
}

// The point of a curve nearest to p, searched around the nearest sample.
Anchor refine(const BodyPoints& body, int sample, Vec3 p) {
  if (!body.curve) return {0, body.kind, body.index, 0, body.points[sample], false};
  double low = std::max(0.0, double(sample - 1) / (kSamples - 1)), high = std::min(1.0, double(sample + 1) / (kSamples - 1));
  for (int i = 0; i < 40; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (distance(p, body.curve->at(a)) < distance(p, body.curve->at(b))) high = b;
    else low = a;
  }
  const double u = 0.5 * (low + high);
  return {0, body.kind, body.index, u, body.curve->at(u), false};
}

}  // namespace

std::vector<Anchor> findAnchors(const Scene& scene, double reach) {
  const std::vector<BodyPoints> bodies = collectBodies(*scene.cage);
  std::vector<std::vector<Anchor>> found(scene.inner.size());
  parallelFor(scene.rows, [&](std::size_t row) {
    for (int c = 0; c < scene.columns; ++c) {
      const int point = scene.index(int(row), c);
      const Vec3 p = scene.inner[point];
      // Distance to each body's nearest sample; then the best three, refined.
      struct Near {
        double squared;
        std::size_t body;
        int sample;
      };
      std::vector<Near> near;
      for (std::size_t b = 0; b < bodies.size(); ++b) {
        Near best{INFINITY, b, 0};
        for (std::size_t s = 0; s < bodies[b].points.size(); ++s) {
          const Vec3 d = bodies[b].points[s] - p;
          if (dot(d, d) < best.squared) best.squared = dot(d, d), best.sample = int(s);
        }
        near.push_back(best);
      }
      const std::size_t count = std::min<std::size_t>(kAnchorsPerPoint, near.size());
      std::partial_sort(near.begin(), near.begin() + count, near.end(), [](const Near& a, const Near& b) {
        return a.squared != b.squared ? a.squared < b.squared : a.body < b.body;
      });
      if (count == 0 || near.front().squared > reach * reach) {
        found[point].push_back({point, BodyKind::still, 0, 0, p, false});
        continue;
      }
      for (std::size_t i = 0; i < count; ++i) {
        Anchor anchor = refine(bodies[near[i].body], near[i].sample, p);
        anchor.point = point;
        if (distance(anchor.rest, p) < kTouching) anchor.rest = p;
        found[point].push_back(anchor);
      }
    }
  });
  std::vector<Anchor> anchors;
  for (const auto& list : found) anchors.insert(anchors.end(), list.begin(), list.end());
  for (int point = 0; point < scene.points(); ++point) {
    const int r = point / scene.columns, c = point % scene.columns;
    const bool isEdge = r == 0 || c == 0 || r == scene.rows - 1 || c == scene.columns - 1;
    if (isEdge) anchors.push_back({point, BodyKind::still, 0, 0, scene.outer[point], true});
  }
  return anchors;
}

}  // namespace pectora
