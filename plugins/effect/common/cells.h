// Energy of the solid cells between the layers of a system.
#pragma once

#include "kernel/physics/system.h"

namespace pectora {

/// What a cell resists with: mu and kappa, MPa.
struct CellModuli {
  double shear = 0, bulk = 0;
};
/// mu = E / 2(1 + nu) and kappa = E / 3(1 - 2 nu); E in kPa.
CellModuli moduliOf(double youngsModulusKPa, double poissonsRatio);

/// The hexahedra between the system's layers, in the order of Scene::cell, with trilinear shape functions and 2 x 2 x 2 points
/// of quadrature. Energy of a cell of rest volume V, with F the deformation gradient, I = F : F, J = det F, and Jm the mean
/// of J over the cell, that is its volume over V:
///
///   sum_q w_q (mu/2 (I - 3) - mu (J - 1) + mu/6 (J - 1)^2) + V kappa/2 (Jm - 1)^2
///
/// Where J is the same all over a cell this is the stable neo-Hookean solid without logarithm (Smith, de Goes and Kim 2018)
/// with lambda + mu = kappa + mu/3. Only the mean of J meets the bulk modulus, so that a cell does not lock as nu goes to
/// 1/2 (Nagtegaal, Parks and Rice 1974); at small strain it is the B-bar hexahedron (Hughes 1980). It is a potential, finite
/// for any positions, also of cells that are turned inside out.
///
/// Its stiffness bound is that of the rest shape. Throws Error naming the first cell whose rest shape has no positive volume at every point of quadrature.
std::unique_ptr<Term> makeCellTerm(std::string name, const System& system, const std::vector<CellModuli>& cells);

/// The same cells where nothing but the volume meets resistance, V kappa/2 (Jm - 1)^2, with kappa = `bulk`, MPa: no quadrature is needed. Throws
/// Error as makeCellTerm. The projected Hessian leaves out how the pressure turns with the cell's faces.
std::unique_ptr<Term> makeVolumeTerm(std::string name, const System& system, double bulk);

}  // namespace pectora
