#include "plugins/scan/common/normals.h"

#include "kernel/physics/workers.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <queue>

namespace pectora {
namespace {

constexpr int kGraph = 8;   // neighbours along which orientation spreads

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Turns normals the same way along the tree of least change, part by part.
void orient(const std::vector<Vec3>& points, const std::vector<std::int32_t>& graph, std::vector<Vec3>& normals) {
  Vec3 centroid;
  for (const Vec3& p : points) centroid += p / double(points.size());
  // Seeds: the furthest points first; those that the tree has reached by then are passed over.
  std::vector<std::pair<double, std::int32_t>> seeds(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) seeds[i] = {-distance(points[i], centroid), std::int32_t(i)};
  std::sort(seeds.begin(), seeds.end());
  // Neighbours both ways.
  std::vector<std::vector<std::int32_t>> links(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < kGraph; ++k)
      if (const std::int32_t j = graph[kGraph * i + k]; j >= 0) links[i].push_back(j), links[j].push_back(std::int32_t(i));

  struct Step {
    double change;
    std::int32_t to, from;
    bool operator>(const Step& o) const { return change != o.change ? change > o.change : to != o.to ? to > o.to : from > o.from; }
  };
  std::vector<bool> done(points.size());
  for (const auto& [unused, seed] : seeds) {
    if (done[seed]) continue;
    if (dot(normals[seed], points[seed] - centroid) < 0) normals[seed] = -normals[seed];
    std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
    queue.push({0, seed, seed});
    while (!queue.empty()) {
      const Step step = queue.top();
      queue.pop();
      if (done[step.to]) continue;
      done[step.to] = true;
      if (dot(normals[step.to], normals[step.from]) < 0) normals[step.to] = -normals[step.to];
      for (std::int32_t next : links[step.to])
        if (!done[next]) queue.push({1 - std::abs(dot(normals[step.to], normals[next])), next, step.to});
    }
  }
}

}  // namespace

CloudNormals estimateNormals(const std::vector<Vec3>& points, const Neighbours& tree, int neighbours) {
  CloudNormals result;
  result.normals.resize(points.size());
  std::vector<double> noise(points.size()), spacing(points.size());
  std::vector<std::int32_t> graph(kGraph * points.size(), -1);
  constexpr std::size_t kBlock = 1024;
  parallelFor((points.size() + kBlock - 1) / kBlock, [&](std::size_t b) {
    std::vector<std::int32_t> near;
    std::vector<double> squared;
    for (std::size_t i = b * kBlock; i < std::min(points.size(), (b + 1) * kBlock); ++i) {
      tree.nearest(points[i], neighbours, near, squared);
      Vec3 mean;
      for (std::int32_t j : near) mean += points[j] / double(near.size());
      Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
      for (std::int32_t j : near) {
        const Vec3 d = points[j] - mean;
        const Eigen::Vector3d v(d.x, d.y, d.z);
        covariance += v * v.transpose();
      }
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
      eigen.computeDirect(covariance);
      const Eigen::Vector3d n = eigen.eigenvectors().col(0);
      result.normals[i] = normalized({n(0), n(1), n(2)});
      // A plane takes three degrees of freedom.
      noise[i] = std::sqrt(std::max(0.0, eigen.eigenvalues()(0)) / std::max(1.0, double(near.size()) - 3));
      spacing[i] = near.size() > 1 ? std::sqrt(squared[1]) : 0;
      for (int k = 0; k < kGraph && k + 1 < int(near.size()); ++k) graph[kGraph * i + k] = near[k + 1] == std::int32_t(i) ? near[0] : near[k + 1];
    }
  });
  orient(points, graph, result.normals);
  result.noise = median(std::move(noise));
  result.spacing = median(std::move(spacing));
  return result;
}

}  // namespace pectora
