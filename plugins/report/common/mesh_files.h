// Meshes and points as PLY and VTP. Coordinates are LPS mm.
#pragma once

#include "kernel/value/mesh.h"
#include "kernel/value/plan.h"

#include <string>

namespace pectora {

/// A comment for the header of every file: what made it.
struct FileNote {
  std::string recordKey;   ///< of the value's provenance
};

/// Binary little-endian PLY; fields become float properties of the vertices.
std::string plyBytes(const Mesh& mesh, const FileNote& note);
std::string plyBytes(const Points& points, const FileNote& note);
/// VTK XML PolyData with raw appended arrays; fields become point data.
std::string vtpBytes(const Mesh& mesh, const FileNote& note);
std::string vtpBytes(const Points& points, const FileNote& note);

/// Bars as one mesh: tubes of rectangular section, each closed.
Mesh barMesh(const std::vector<Bar>& bars);

}  // namespace pectora
