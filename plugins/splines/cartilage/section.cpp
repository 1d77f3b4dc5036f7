#include "plugins/splines/cartilage/section.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr double kUsualWidthMm = 250;   // of the chest
constexpr double kThinnedMm = 4;        // between the points of pleura that are asked
constexpr double kRibHalfHighMm = 6.5, kRibHalfThinMm = 3.5, kWidenedAt = 0.3;

}  // namespace

SectionSize sectionSize(double along, double scale) {
  const double widened = std::min(1.0, along / kWidenedAt);
  return {scale * std::lerp(kRibHalfHighMm, kHalfHighMm, widened), scale * std::lerp(kRibHalfThinMm, kHalfThinMm, widened)};
}

double chestScale(const std::vector<LayerSlice>& pleura) {
  double widest = 0;
  for (const LayerSlice& s : pleura)
    if (!s.points.empty() && !s.clipped) {
      const auto [right, left] = std::minmax_element(s.points.begin(), s.points.end(), [](Vec3 a, Vec3 b) { return a.x < b.x; });
      widest = std::max(widest, left->x - right->x);
    }
  return widest > 0 ? std::clamp(widest / kUsualWidthMm, 0.6, 1.3) : 1;
}

WallNormal::WallNormal(const std::vector<LayerSlice>& pleura) {
  for (const LayerSlice& slice : pleura) {
    if (slice.points.empty() || (!rows_.empty() && slice.z - rows_.back().front().z < kThinnedMm)) continue;
    rows_.push_back({slice.points.front()});
    for (const Vec3& p : slice.points)
      if (distance(p, rows_.back().back()) >= kThinnedMm) rows_.back().push_back(p);
  }
}

Vec3 WallNormal::operator()(Vec3 p) const {
  constexpr double kSigma = 20, kReach = 2.5 * kSigma;
  Vec3 first{};
  double weights = 0;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const std::vector<Vec3>& row : rows_) {
    if (std::abs(row.front().z - p.z) > kReach) continue;
    for (const Vec3& q : row) {
      const Vec3 d = q - p;
      const double square = dot(d, d);
      if (square > kReach * kReach) continue;
      const double weight = std::exp(-square / (2 * kSigma * kSigma));
      const Eigen::Vector3d e(d.x, d.y, d.z);
      weights += weight, first += d * weight, second += weight * e * e.transpose();
    }
  }
  const Vec3 inwards = weights > 0 ? first / weights : Vec3{};
  if (norm(inwards) < 1) return {0, -1, 0};
  const Eigen::Vector3d mean(inwards.x, inwards.y, inwards.z);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(second / weights - mean * mean.transpose());
  const Eigen::Vector3d least = axes.eigenvectors().col(0);
  const Vec3 normal{least.x(), least.y(), least.z()};
  return dot(normal, inwards) > 0 ? -normal : normal;
}

}  // namespace pectora
