#include "kernel/value/scene.h"

#include "kernel/value/motion.h"

#include <algorithm>
#include <numeric>

namespace pectora {

Mesh layerMesh(int rows, int columns, std::vector<Vec3> points) {
  // Rows run up, columns from right to left: (row, column) x (row, column + 1) points to the front.
  Mesh mesh;
  mesh.points = std::move(points);
  mesh.triangles.reserve(std::size_t(2) * std::max(0, rows - 1) * std::max(0, columns - 1));
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      const int a = r * columns + c, b = a + 1, up = a + columns, upB = up + 1;
      mesh.triangles.push_back({a, b, upB});
      mesh.triangles.push_back({a, upB, up});
    }
  }
  return mesh;
}

std::vector<double> skinDisplacement(const Scene& scene, const std::vector<Vec3>& outer) {
  std::vector<double> far(outer.size());
  for (std::size_t i = 0; i < far.size(); ++i) far[i] = distance(outer[i], scene.outer[i]);
  return far;
}

Mesh displacedSkin(const Scene& scene, const std::vector<Vec3>& outer) {
  Mesh mesh = layerMesh(scene.rows, scene.columns, outer);
  mesh.fields.push_back({"displacement", "mm", skinDisplacement(scene, outer)});
  return mesh;
}

std::vector<Fact> Scene::facts() const {
  return {{"rows", double(rows), ""},
          {"columns", double(columns), ""},
          {"layers", double(layers()), ""},
          {"skin_points", double(points()), ""},
          {"row_spacing", rowSpacing, "mm"},
          {"column_spacing", columnSpacing, "mm"},
          {"thickness", thickness, "mm"},
          {"anchors", double(anchors.size()), ""},
          {"effects", double(effects.size()), ""}};
}

std::vector<std::pair<std::string, std::shared_ptr<const Value>>> Scene::parts() const {
  return {{"cage", cage},
          {"skin", std::make_shared<Mesh>(layerMesh(rows, columns, outer))},
          {"pleura", std::make_shared<Mesh>(layerMesh(rows, columns, inner))}};
}

const char* statusName(SolveStatus status) {
  switch (status) {
    case SolveStatus::converged: return "converged";
    case SolveStatus::stalled: return "stalled";
    case SolveStatus::diverged: return "diverged";
    case SolveStatus::cancelled: return "cancelled";
  }
  return "unknown";
}

double Motion::barForce() const {
  return barForces.empty() ? std::numeric_limits<double>::quiet_NaN() : std::accumulate(barForces.begin(), barForces.end(), 0.0);
}

std::vector<Fact> Motion::facts() const {
  double greatest = 0, fastest = 0, overshoot = 0;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    const double end = distance(outer[i], scene->outer[i]);
    greatest = std::max(greatest, end);
    for (const Moment& m : moments) overshoot = std::max(overshoot, distance(m.outer[i], scene->outer[i]) - end);
  }
  for (const Moment& m : moments) fastest = std::max(fastest, m.fastest);
  return {{"status", statusName(status), ""},
          {"message", message, ""},
          {"iterations", double(iterations), ""},
          {"force_evaluations", double(forceEvaluations), ""},
          {"residual", residual, "N"},
          {"relative_residual", relativeResidual, ""},
          {"energy", energy, "N mm"},
          {"energy_growth", energyGrowth, ""},
          {"inverted_prisms", double(invertedPrisms), ""},
          {"greatest_skin_displacement", greatest, "mm"},
          {"lift", lift, "mm"},
          {"bar_force", barForce(), "N"},
          {"second_bar_force", barForces.size() > 1 ? barForces[1] : std::numeric_limits<double>::quiet_NaN(), "N"},
          {"duration", moments.empty() ? 0 : moments.back().time, "s"},
          {"fastest", fastest, "mm/s"},
          {"overshoot", overshoot, "mm"}};
}

std::vector<std::pair<std::string, std::shared_ptr<const Value>>> Motion::parts() const {
  auto before = std::make_shared<Mesh>(layerMesh(scene->rows, scene->columns, scene->outer));
  auto after = std::make_shared<Mesh>(displacedSkin(*scene, outer));
  auto copied = std::make_shared<Mesh>(layerMesh(scene->rows, scene->columns, skinThatCopiesBone(*this)));
  return {{"scene", scene}, {"before", before}, {"after", after}, {"copied", copied}};
}

std::vector<Vec3> skinThatCopiesBone(const Motion& motion) {
  const Scene& scene = *motion.scene;
  std::vector<Vec3> sum(scene.outer.size());
  std::vector<double> weights(scene.outer.size());
  for (std::size_t i = 0; i < scene.anchors.size() && i < motion.anchors.size(); ++i) {
    const Anchor& anchor = scene.anchors[i];
    if (anchor.isOnSkin) continue;
    // Nearer than a hundredth of a millimetre is on the bone.
    const double weight = 1 / std::max(1e-4, dot(anchor.rest - scene.inner[anchor.point], anchor.rest - scene.inner[anchor.point]));
    sum[anchor.point] += (motion.anchors[i] - anchor.rest) * weight;
    weights[anchor.point] += weight;
  }
  std::vector<Vec3> skin = scene.outer;
  for (std::size_t i = 0; i < skin.size(); ++i)
    if (weights[i] > 0) skin[i] += sum[i] / weights[i];
  return skin;
}

int countInvertedPrisms(int rows, int columns, const std::vector<Vec3>& outer, const std::vector<Vec3>& inner,
                        int& first) {
  // Each cell of the grid is a hexahedron; the triple product at each of its outer corners must keep its sign.
  int inverted = 0;
  first = -1;
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      const int a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
      const auto corner = [&](int o, int along, int up) {
        return dot(cross(outer[along] - outer[o], outer[up] - outer[o]), outer[o] - inner[o]) > 0;
      };
      const bool good = corner(a, b, d) && corner(b, e, a) && corner(e, d, b) && corner(d, a, e);
      if (good) continue;
      ++inverted;
      if (first < 0) first = a;
    }
  }
  return inverted;
}

}  // namespace pectora
