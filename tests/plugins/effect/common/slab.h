// A slab of tissue 120 x 120 x 20 mm whose underside is pushed up in a Gaussian bump: solved here, and by CalculiX on the same
// mesh.
#pragma once

#include "tests/plugins/effect/common/block.h"

#include "plugins/solver/common/newton.h"
#include "plugins/solver/common/quasi_static.h"
#include "tests/kernel/host/quiet_host.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace pectora {

struct Slab {
  static constexpr double kSide = 120, kHeight = 20, kModulusKPa = 20, kBumpWidth = 20;   // mm, kPa
  int cells, layers;   ///< cells along a side and through the height
  double poissonsRatio, bump;
  System system;

  /// The underside is the last layer; its nodes are driven.
  Slab(int cellsOfSide, int cellsOfHeight, double nu, double bumpHeight)
      : cells(cellsOfSide), layers(cellsOfHeight), poissonsRatio(nu), bump(bumpHeight),
        system(block(cellsOfHeight + 1, cellsOfSide + 1, cellsOfSide + 1, {kSide, kHeight, kSide})) {
    system.freeNodes = system.node(layers, 0);
    system.mass.resize(system.freeNodes);
    system.terms.push_back(makeCellTerm("tissue", system, std::vector<CellModuli>(cellsOf(system), moduliOf(kModulusKPa, nu))));
  }

  Vec3 driven(std::size_t node) const {
    const Vec3 p = system.rest[node];
    const double x = p.x - kSide / 2, z = p.z - kSide / 2;
    return p - Vec3{0, bump * std::exp(-(x * x + z * z) / (2 * kBumpWidth * kBumpWidth)), 0};
  }
  Drive drive() const {
    Drive drive;
    drive.frames.resize(2);
    for (std::size_t i = system.freeNodes; i < system.rest.size(); ++i) drive.frames[0].push_back(system.rest[i]), drive.frames[1].push_back(driven(i));
    return drive;
  }
};

/// Displacements of the top's nodes by Newton's method.
inline std::vector<Vec3> solveHere(const Slab& slab, double tolerance) {
  QuasiStaticSettings settings;
  settings.tolerance = tolerance;
  settings.loadStep = 20;
  QuietHost host;
  const auto session = makeQuasiStatic(slab.system, settings, std::make_unique<Newton>(slab.system), 60);
  const Solution solution = session->solve(slab.drive(), nullptr, host);
  if (solution.status != SolveStatus::converged) throw std::runtime_error("not converged: " + solution.message);
  std::vector<Vec3> top;
  for (std::size_t i = 0; i < slab.system.points(); ++i) top.push_back(solution.positions[i] - slab.system.rest[i]);
  return top;
}

/// Writes CalculiX's input. `element`: C3D8I and the like. `isFinite`: neo-Hookean at finite strain, else linear elasticity.
inline void writeDeck(const Slab& slab, const std::string& element, bool isFinite, const std::filesystem::path& file) {
  const System& s = slab.system;
  std::ofstream out(file);
  out.precision(12);
  out << "*NODE,NSET=NALL\n";
  for (std::size_t i = 0; i < s.rest.size(); ++i) out << i + 1 << ',' << s.rest.x[i] << ',' << s.rest.y[i] << ',' << s.rest.z[i] << '\n';
  out << "*ELEMENT,TYPE=" << element << ",ELSET=EALL\n";
  // The face below first: seen from it, the others lie along its normal.
  int number = 0;
  for (int l = 0; l < slab.layers; ++l)
    for (int r = 0; r < slab.cells; ++r)
      for (int c = 0; c < slab.cells; ++c) {
        out << ++number;
        for (const int layer : {l + 1, l})
          for (const auto& [dr, dc] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}}) out << ',' << s.node(layer, std::size_t(r + dr) * (slab.cells + 1) + c + dc) + 1;
        out << '\n';
      }
  out << "*NSET,NSET=NTOP,GENERATE\n1," << s.points() << ",1\n*MATERIAL,NAME=TISSUE\n";
  const CellModuli m = moduliOf(Slab::kModulusKPa, slab.poissonsRatio);
  if (isFinite) out << "*HYPERELASTIC,NEO HOOKE\n" << m.shear / 2 << ',' << 2 / m.bulk << '\n';
  else out << "*ELASTIC\n" << Slab::kModulusKPa * 1e-3 << ',' << slab.poissonsRatio << '\n';
  out << "*SOLID SECTION,ELSET=EALL,MATERIAL=TISSUE\n*STEP" << (isFinite ? ",NLGEOM" : "") << ",INC=200\n*STATIC\n"
      << (isFinite ? "0.25,1.,1e-4,0.5\n" : "1.,1.\n") << "*BOUNDARY\n";
  for (std::size_t i = s.freeNodes; i < s.rest.size(); ++i)
    out << i + 1 << ",1,1,0.\n" << i + 1 << ",2,2," << slab.driven(i).y - s.rest.y[i] << '\n' << i + 1 << ",3,3,0.\n";
  out << "*NODE PRINT,NSET=NTOP,FREQUENCY=1000\nU\n*END STEP\n";
}

/// Displacements of the top's nodes by CalculiX, run in `folder`. Throws if it does not reach the end of the step.
inline std::vector<Vec3> solveByCalculix(const std::string& program, const Slab& slab, const std::string& element, bool isFinite, const std::filesystem::path& folder) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  writeDeck(slab, element, isFinite, folder / "slab.inp");
  const int code = std::system(("cd '" + folder.string() + "' && OMP_NUM_THREADS=2 '" + program + "' -i slab > log.txt 2>&1").c_str());
  // It leaves partial results when it fails: the last line of slab.sta tells the time it reached.
  double reached = 0;
  std::ifstream status(folder / "slab.sta");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    double step, increment, attempt, iterations, total;
    if (words >> step >> increment >> attempt >> iterations >> total) reached = total;
  }
  if (code != 0 || reached < 1) throw std::runtime_error("CalculiX did not finish; see " + (folder / "log.txt").string());
  std::vector<Vec3> top(slab.system.points());
  std::ifstream results(folder / "slab.dat");
  std::size_t read = 0;
  for (std::string line; std::getline(results, line);) {
    std::istringstream words(line);
    std::size_t node;
    Vec3 u;
    if (words >> node >> u.x >> u.y >> u.z && node >= 1 && node <= top.size()) top[node - 1] = u, ++read;
  }
  if (read != top.size()) throw std::runtime_error("CalculiX wrote an unexpected number of nodes");
  std::filesystem::remove_all(folder);
  return top;
}

}  // namespace pectora
