#include "plugins/register/landmarks/fit.h"

#include "kernel/stage/error.h"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

namespace pectora {
namespace {

// The cloud must reach at least this far across its n-th direction, mm RMS.
constexpr double kLeastExtent = 1.0;

Eigen::Matrix3Xd columns(const std::vector<LandmarkPair>& pairs, bool moving) {
  Eigen::Matrix3Xd m(3, Eigen::Index(pairs.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Vec3 p = moving ? pairs[i].moving : pairs[i].fixed;
    m.col(Eigen::Index(i)) << p.x, p.y, p.z;
  }
  return m;
}

// RMS extents of the cloud along its principal axes, largest first, mm.
Eigen::Vector3d extents(const Eigen::Matrix3Xd& points) {
  const Eigen::Matrix3Xd centered = points.colwise() - points.rowwise().mean();
  return Eigen::JacobiSVD<Eigen::Matrix3Xd>(centered).singularValues() / std::sqrt(double(points.cols()));
}

// Why these pairs cannot determine the map, or nothing.
std::optional<Error> unfit(const std::vector<LandmarkPair>& pairs, MapKind kind) {
  const std::size_t needed = kind == MapKind::affine ? 4 : 3;
  if (pairs.size() < needed)
    return Error("too few landmarks are on both surfaces").given(std::to_string(pairs.size())).allowed(fmt::format("{} or more", needed))
        .advise(kind == MapKind::affine ? "Use method = \"rigid\", or place more landmarks" : "Place the same landmarks on both surfaces");
  for (const bool moving : {true, false}) {
    const Eigen::Matrix3Xd points = columns(pairs, moving);
    if (!points.allFinite()) return Error("a landmark has a coordinate that is not a finite number");
    const Eigen::VectorXd extent = extents(points);
    if (extent(1) < kLeastExtent)
      return Error("the landmarks lie on one line, which leaves a rotation undetermined").given(fmt::format("{:.2g} mm RMS across it", extent(1)))
          .allowed(fmt::format("{:g} mm or more", kLeastExtent)).advise("Place one away from the line");
    if (kind == MapKind::affine && (extent.size() < 3 || extent(2) < kLeastExtent))
      return Error("the landmarks lie in one plane, which leaves an affine map undetermined").given(fmt::format("{:.2g} mm RMS across it", extent.size() < 3 ? 0.0 : extent(2)))
          .allowed(fmt::format("{:g} mm or more", kLeastExtent)).advise("Use method = \"rigid\"");
  }
  return std::nullopt;
}

AffineMap solve(const std::vector<LandmarkPair>& pairs, MapKind kind) {
  const Eigen::Matrix3Xd from = columns(pairs, true), to = columns(pairs, false);
  Eigen::Matrix3d linear;
  Eigen::Vector3d translation;
  if (kind == MapKind::affine) {
    // Least squares of [p 1] on q, about the centroids.
    const Eigen::Vector3d fromCenter = from.rowwise().mean(), toCenter = to.rowwise().mean();
    const Eigen::Matrix3Xd p = from.colwise() - fromCenter, q = to.colwise() - toCenter;
    linear = (p * p.transpose()).ldlt().solve(p * q.transpose()).transpose();
    translation = toCenter - linear * fromCenter;
  } else {
    const Eigen::Matrix4d m = Eigen::umeyama(from, to, kind == MapKind::similarity);
    linear = m.topLeftCorner<3, 3>();
    translation = m.topRightCorner<3, 1>();
  }
  AffineMap map;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) map.linear[r][c] = linear(r, c);
  map.translation = {translation(0), translation(1), translation(2)};
  return map;
}

double determinant(const AffineMap& map) {
  const auto& m = map.linear;
  return dot({m[0][0], m[0][1], m[0][2]}, cross({m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}));
}

}  // namespace

std::vector<LandmarkPair> pairLandmarks(const Landmarks& moving, const Landmarks& fixed) {
  std::vector<LandmarkPair> pairs;
  for (const Landmark& f : fixed.points)
    if (const Landmark* m = moving.find(f.name)) pairs.push_back({f.name, m->position, f.position});
  return pairs;
}

Registration fitLandmarks(const std::vector<LandmarkPair>& pairs, MapKind kind) {
  if (auto error = unfit(pairs, kind)) throw *error;
  Registration registration;
  registration.method = kind == MapKind::rigid ? "rigid" : kind == MapKind::similarity ? "similarity" : "affine";
  registration.map = solve(pairs, kind);
  registration.scale = std::cbrt(determinant(registration.map));
  double squares = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    LandmarkResidual residual{pairs[i].name, distance(registration.map(pairs[i].moving), pairs[i].fixed), std::numeric_limits<double>::quiet_NaN()};
    squares += residual.residual * residual.residual;
    // What the map would have said of this landmark without it.
    std::vector<LandmarkPair> others = pairs;
    others.erase(others.begin() + std::ptrdiff_t(i));
    if (!unfit(others, kind)) residual.leaveOneOut = distance(solve(others, kind)(pairs[i].moving), pairs[i].fixed);
    registration.residuals.push_back(residual);
  }
  registration.rms = std::sqrt(squares / double(pairs.size()));
  return registration;
}

}  // namespace pectora
