// Open3D on the same surfaces: closest points with the primitive's normal for the sign, its own signed distance, and ICP.
#include "tests/bench/surfaces/figures.h"

#include <open3d/Open3D.h>
#include <open3d/t/geometry/RaycastingScene.h>

using namespace pectora;
using namespace pectora::bench;
namespace o3d = open3d;

namespace {

o3d::core::Tensor tensor(const std::vector<Vec3>& points) {
  std::vector<float> flat;
  for (const Vec3& p : points) flat.insert(flat.end(), {float(p.x), float(p.y), float(p.z)});
  return o3d::core::Tensor(flat, {std::int64_t(points.size()), 3}, o3d::core::Float32);
}

o3d::core::Tensor tensor(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::uint32_t> flat;
  for (const auto& t : triangles) flat.insert(flat.end(), t.begin(), t.end());
  return o3d::core::Tensor(flat, {std::int64_t(triangles.size()), 3}, o3d::core::UInt32);
}

void distanceOpen3d(benchmark::State& state, bool byParity) {
  const int n = int(state.range(0));
  const Mesh fixed = reference(n), sample = compared(n);
  const auto vertices = tensor(fixed.points), queries = tensor(sample.points);
  const auto triangles = tensor(fixed.triangles);
  std::vector<double> distances;
  for (auto _ : state) {
    distances.clear();
    o3d::t::geometry::RaycastingScene scene;
    scene.AddTriangles(vertices, triangles);
    if (byParity) {
      const auto d = scene.ComputeSignedDistance(queries).ToFlatVector<float>();
      distances.assign(d.begin(), d.end());
      continue;
    }
    auto found = scene.ComputeClosestPoints(queries);
    const auto points = found["points"].ToFlatVector<float>(), normals = found["primitive_normals"].ToFlatVector<float>();
    for (std::size_t i = 0; i < sample.points.size(); ++i) {
      const Vec3 d = sample.points[i] - Vec3{points[3 * i], points[3 * i + 1], points[3 * i + 2]};
      distances.push_back(std::copysign(norm(d), dot(d, {normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]})));
    }
  }
  const std::vector<double> ours = ourDistances(fixed, sample);
  countDistances(state, distances, n, &ours);
}

void icpOpen3d(benchmark::State& state) {
  const int n = int(state.range(0));
  const Mesh fixed = reference(n);
  const auto eigen = [](const std::vector<Vec3>& points) {
    std::vector<Eigen::Vector3d> out;
    for (const Vec3& p : points) out.emplace_back(p.x, p.y, p.z);
    return out;
  };
  std::vector<Eigen::Vector3i> triangles;
  for (const auto& t : fixed.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  double squares = 0;
  unsigned seed = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const Mesh moving = displaced(n, 0.2, ++seed);
    o3d::geometry::TriangleMesh mesh(eigen(fixed.points), triangles);
    const o3d::geometry::PointCloud source(eigen(moving.points));
    state.ResumeTiming();
    mesh.ComputeVertexNormals();
    o3d::geometry::PointCloud target(mesh.vertices_);
    target.normals_ = mesh.vertex_normals_;
    const auto result = o3d::pipelines::registration::RegistrationICP(
        source, target, 40.0, Eigen::Matrix4d::Identity(), o3d::pipelines::registration::TransformationEstimationPointToPlane(),
        o3d::pipelines::registration::ICPConvergenceCriteria(1e-7, 1e-7, 200));
    AffineMap map;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) map.linear[r][c] = result.transformation_(r, c);
    map.translation = {result.transformation_(0, 3), result.transformation_(1, 3), result.transformation_(2, 3)};
    const double error = targetError(map);
    squares += error * error;
  }
  state.counters["target_error_rms_mm"] = std::sqrt(squares / seed);
}

}  // namespace

BENCHMARK_CAPTURE(distanceOpen3d, closestPoints, false)->Arg(317)->Arg(1001)->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK_CAPTURE(distanceOpen3d, rayParity, true)->Arg(317)->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(icpOpen3d)->Arg(317)->Arg(1001)->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->UseRealTime()->Iterations(kSeeds);
