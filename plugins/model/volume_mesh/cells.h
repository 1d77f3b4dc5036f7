// The wall filled with cells.
#pragma once

#include "kernel/value/scene.h"

namespace pectora {

/// Cells through the wall that make them nearly cubic over the front, at least 3.
int cubicCells(const Scene& scene);

/// Adds layers between skin and pleura at equal parts of the line from each skin point to its pleura point, so that there are
/// `cells` cells through the wall. Needs outer and inner.
void fillWall(int cells, Scene& scene);

/// The corners of cell (l, r, c): bit 0 one column on, bit 1 one row on, bit 2 one layer inwards.
std::array<Vec3, 8> cellCorners(const Scene& scene, int l, int r, int c);

/// Fills the masses of all layers: every cell gives an eighth of its own to each corner. Needs the cells' tissues.
void weighCells(Scene& scene);

}  // namespace pectora
