// Spring constants from Young's moduli, by homogenising the stencil over one cell (science: C_ijkl =
// 1/V sum k/L^2 d_i d_j d_k d_l; pure springs have Poisson's ratio 1/3 in a sheet and 1/4 in a solid).
#pragma once

#include <array>
#include <vector>

namespace pectora {

/// Spring constants of one layer's 24 neighbours, N/mm, for a sheet of tension stiffness E2 = E t.
struct LayerStiffness {
  double stretchRows = 0;      ///< between neighbouring rows
  double stretchColumns = 0;   ///< between neighbouring columns
  double shear = 0;            ///< diagonals
  double bendWeight = 0;       ///< k / L^2 of every spring that reaches two rows or columns, N/mm^3
  bool isIsotropic = true;     ///< false: the cells are too oblong, and one stretch constant is a floor
};

/// `e2` in N/mm, spacings in mm; `bendShare` (0 to 1) is the part of the sheet's stiffness that the bend springs
/// carry, 0 if the scene has none. Solves N1111 = N2222 = 9/8 E2 and N1122 = 3/8 E2.
LayerStiffness calibrateLayer(double e2, double rowSpacing, double columnSpacing, double bendShare);

/// The eight offsets (rows, columns) of the bend springs of a point, each pair once.
const std::array<std::array<int, 2>, 8>& bendOffsets();

/// Constants of the springs from a skin point to the pleura points up to `rows` rows and `columns` columns away, N/mm.
struct CrossStiffness {
  int rows = 2, columns = 2;
  std::vector<double> stiffness;
  bool isFeasible = true;      ///< false: the wall is too thick for the stencil's reach, and too soft in shear

  double at(int row, int column) const { return stiffness[std::size_t(row + rows) * (2 * columns + 1) + column + columns]; }
};

/// `youngsModulus` in N/mm^2 (MPa), `thickness` H and spacings in mm. Weights k / L^2 = w exp(-beta r^2) with
/// sum w = 1.2 E A / H^3 and a mean r^2 of 2/3 H^2. Springs at the corners alone reach that up to
/// H^2 = 3/2 ((rows a)^2 + (columns b)^2); beyond it all weights are equal.
CrossStiffness calibrateCross(double youngsModulus, double rowSpacing, double columnSpacing, double thickness, int rows = 2, int columns = 2);

}  // namespace pectora
