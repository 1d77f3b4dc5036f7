// The inner loops of cells that keep their volume: rows of hexahedra side by side. The volume of one follows from six differences of its
// corners (Grandy, Efficient computation of volume of hexahedral cells, 1997):
//
//   12 V = det(q + p, r, u) + det(p, r + s, t) + det(q, s, t + u)
//
// with p = x6 - x0, q = x7 - x1, r = x7 - x2, s = x5 - x0, t = x7 - x4, u = x3 - x0, and bit 0, 1, 2 of a corner's number its step to the
// next column, row, layer. These steps are left-handed, which turns the sign. It is exact for faces that are bilinear.
#pragma once

#include "kernel/physics/rows.h"

namespace pectora::cells {

inline constexpr int kDiagonals = 6;
/// A cell's numbers on its diagonals: three for each of p to u.
inline constexpr int kOnDiagonals = 3 * kDiagonals;

/// The nodes at the corners of a row of cells: corner a of cell i is in row a >> 1, at i + (a & 1).
template <class T>
struct CornerRow {
  ConstRow<T> rows[4];
};
/// Numbers of a row of cells: number n of cell i at values[n * stride + i].
template <class T>
struct CellNumbers {
  T* values;
  std::size_t stride;
  T* row(int n) const { return values + std::size_t(n) * stride; }
};

/// Volumes and their derivatives by p to u.
void volumes(std::size_t count, const CornerRow<double>& x, double* volume, CellNumbers<double> derivatives);

/// Of cells with the energy 1/2 k (V - V0)^2: the forces along p to u, what each adds to twice the energy, and the square of the largest force
/// that each column has seen at a corner.
struct PressedRow {
  const double* restVolume;   ///< V0, mm^3
  const double* stiffness;    ///< k, N/mm^5
  double *twiceEnergy, *largestSquared;
};
void press(std::size_t count, const CornerRow<double>& x, const PressedRow& row, CellNumbers<double> forces);

/// What is on the diagonals goes to the corners.
void addToCorners(std::size_t count, CellNumbers<double> onDiagonals, const Row<double> (&rows)[4]);
void addToCorners(std::size_t count, CellNumbers<double> onDiagonals, const Row<float> (&rows)[4]);

/// onDiagonals = g (g . v), with v taken along the diagonals.
void projectOnto(std::size_t count, CellNumbers<const float> g, const CornerRow<double>& v, CellNumbers<double> onDiagonals);
void projectOnto(std::size_t count, CellNumbers<const float> g, const CornerRow<float>& v, CellNumbers<double> onDiagonals);
/// onDiagonals += pressure times the second derivative of the volume, applied to v. `diagonals`: p to u.
void addTurned(std::size_t count, const float* pressure, CellNumbers<const float> diagonals, const CornerRow<double>& v, CellNumbers<double> onDiagonals);
void addTurned(std::size_t count, const float* pressure, CellNumbers<const float> diagonals, const CornerRow<float>& v, CellNumbers<double> onDiagonals);

/// The diagonals p to u of each cell.
void diagonalsOf(std::size_t count, const CornerRow<double>& x, CellNumbers<float> diagonals);

}  // namespace pectora::cells
