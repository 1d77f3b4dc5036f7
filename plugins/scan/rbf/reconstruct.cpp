#include "plugins/scan/rbf/reconstruct.h"

#include "plugins/scan/common/normals.h"
#include "plugins/scan/rbf/extract.h"
#include "plugins/scan/rbf/field.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// Points on edges of one triangle.
std::vector<Vec3> borderPoints(const Mesh& mesh) {
  std::vector<std::pair<int, int>> edges;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) edges.push_back(std::minmax(t[k], t[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j] == edges[i]) ++j;
    if (j - i == 1) points.push_back(mesh.points[edges[i].first]), points.push_back(mesh.points[edges[i].second]);
    i = j;
  }
  return points;
}

void keepPoints(Mesh& mesh, const std::vector<char>& keep) {
  std::vector<int> newIndex(mesh.points.size(), -1);
  std::vector<std::array<int, 3>> triangles;
  std::vector<Vec3> points;
  for (const auto& t : mesh.triangles) {
    if (!keep[t[0]] || !keep[t[1]] || !keep[t[2]]) continue;
    for (int corner : t)
      if (newIndex[corner] < 0) newIndex[corner] = int(points.size()), points.push_back(mesh.points[corner]);
    triangles.push_back({newIndex[t[0]], newIndex[t[1]], newIndex[t[2]]});
  }
  mesh.points = std::move(points);
  mesh.triangles = std::move(triangles);
}

// The surface reaches `fill` beyond every border of the data. Holes that closed have no border left; where one remains, the
// surface draws back from it by as much, to where points are.
void trim(Mesh& mesh, const Neighbours& data, double near, double fill) {
  const std::vector<Vec3> border = borderPoints(mesh);
  if (border.empty()) return;
  const Neighbours edge(border);
  std::vector<char> keep(mesh.points.size());
  constexpr std::size_t kBlock = 256;
  parallelFor((keep.size() + kBlock - 1) / kBlock, [&](std::size_t b) {
    for (std::size_t i = b * kBlock; i < std::min(keep.size(), (b + 1) * kBlock); ++i)
      keep[i] = data.distance(mesh.points[i]) <= near || edge.distance(mesh.points[i]) > 1.5 * fill;
  });
  keepPoints(mesh, keep);
}

}  // namespace

Reconstruction reconstruct(const std::vector<Vec3>& points, const std::vector<Vec3>& given, const ReconstructSettings& settings,
                           const std::function<void(double)>& poll) {
  constexpr std::size_t kFewest = 100;
  if (points.size() < kFewest) throw Error("too few points for a surface").given(std::to_string(points.size())).allowed(fmt::format("{} or more", kFewest));
  for (const Vec3& p : points)
    if (!isFinite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 1e5)
      throw Error("the cloud has a coordinate that is not a finite number, or beyond any body").advise("Clean the scan first, and check the units");
  const Neighbours tree(points);
  poll(0.02);
  CloudNormals cloud = estimateNormals(points, tree);
  Reconstruction result;
  result.estimatedNormals = given.empty();
  result.spacing = cloud.spacing;
  result.noise = settings.noise > 0 ? settings.noise : cloud.noise;
  poll(0.2);
  FieldSettings fieldSettings;
  fieldSettings.noise = result.noise;
  fieldSettings.coarseCell = 4 * std::max(settings.fill, settings.cell);
  const RbfField field(points, given.empty() ? cloud.normals : given, tree, fieldSettings, [&](double f) { poll(0.2 + 0.5 * f); });
  result.balls = field.balls();
  // Whatever is asked, gaps of the points' own spacing are none.
  const double near = std::max(2 * cloud.spacing, settings.cell), reach = std::max(settings.fill, near);
  result.mesh = extractSurface(points, [&](Vec3 p) { return field(p); }, [&](Vec3 p) { return tree.distance(p); }, {settings.cell, reach}, [&](double) { poll(0.8); });
  poll(0.9);
  trim(result.mesh, tree, near, reach);
  if (result.mesh.triangles.empty()) throw Error("no surface came out of these points").advise("Check the units, and that the points lie on a surface");
  return result;
}

}  // namespace pectora
