#include "plugins/model/volume_mesh/cells.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr int kLeastCells = 3;

// Volume of a hexahedron with bilinear faces: the mean of its two cuts into five tetrahedra.
double volumeOf(const std::array<Vec3, 8>& p) {
  const auto tetrahedron = [&](int a, int b, int c, int d) { return dot(cross(p[b] - p[a], p[c] - p[a]), p[d] - p[a]) / 6; };
  const double one = tetrahedron(0, 1, 2, 4) + tetrahedron(3, 2, 1, 7) + tetrahedron(5, 4, 7, 1) + tetrahedron(6, 7, 4, 2) + tetrahedron(1, 2, 4, 7);
  const double other = tetrahedron(1, 0, 3, 5) + tetrahedron(2, 3, 0, 6) + tetrahedron(4, 5, 6, 0) + tetrahedron(7, 6, 5, 3) + tetrahedron(0, 3, 5, 6);
  return (std::abs(one) + std::abs(other)) / 2;
}

}  // namespace

int cubicCells(const Scene& scene) {
  return std::max(kLeastCells, int(std::lround(scene.thickness / std::sqrt(scene.rowSpacing * scene.columnSpacing))));
}

void fillWall(int cells, Scene& scene) {
  scene.between.assign(cells - 1, {});
  for (int l = 1; l < cells; ++l)
    for (int i = 0; i < scene.points(); ++i) scene.between[l - 1].push_back(lerp(scene.outer[i], scene.inner[i], double(l) / cells));
}

std::array<Vec3, 8> cellCorners(const Scene& scene, int l, int r, int c) {
  std::array<Vec3, 8> corners;
  for (int a = 0; a < 8; ++a) corners[a] = scene.layer(l + (a >> 2))[scene.index(r + (a >> 1 & 1), c + (a & 1))];
  return corners;
}

void weighCells(Scene& scene) {
  std::vector<std::vector<double>> mass(scene.layers(), std::vector<double>(scene.points()));
  for (int l = 0; l + 1 < scene.layers(); ++l)
    for (int r = 0; r + 1 < scene.rows; ++r)
      for (int c = 0; c + 1 < scene.columns; ++c) {
        // kg/m^3 times mm^3.
        const double eighth = 1e-9 / 8 * scene.tissues[scene.cellTissue[scene.cell(l, r, c)]].density * volumeOf(cellCorners(scene, l, r, c));
        for (int a = 0; a < 8; ++a) mass[l + (a >> 2)][scene.index(r + (a >> 1 & 1), c + (a & 1))] += eighth;
      }
  scene.outerMass = std::move(mass.front());
  scene.innerMass = std::move(mass.back());
  scene.betweenMass.assign(std::make_move_iterator(mass.begin() + 1), std::make_move_iterator(mass.end() - 1));
}

}  // namespace pectora
