// Readers of scanner files. They take bytes, not paths, trust no count or index of a file, and never return what is not finite.
#pragma once

#include "kernel/value/mesh.h"

#include <string>
#include <string_view>

namespace pectora {

/// What a file holds: triangles may be empty (a cloud).
struct RawSurface {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;                    ///< one a point, or none
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> sweeps;                      ///< one a point, or none
  std::vector<std::string> notes;               ///< what was wrong in the file and passed over
};

/// Recognises the format by the bytes (and `name`'s ending where they do not tell) and reads it. Throws Error that says what is wrong where.
RawSurface readSurface(std::string_view bytes, const std::string& name);

RawSurface readFastScanText(std::string_view bytes);   ///< "% ..." comments, then "x y z" a line
RawSurface readPly(std::string_view bytes);            ///< ASCII, binary of both byte orders
RawSurface readStl(std::string_view bytes);            ///< ASCII, binary, big-endian binary; equal corners are merged
RawSurface readVtk(std::string_view bytes);            ///< legacy text files of polygons or points, old and new lists of cells
RawSurface readObj(std::string_view bytes);            ///< v, vn, f with any slashes and negative indices; polygons become fans

/// Merges points that are bit for bit equal and mends the triangles' indices (STL repeats its corners).
void mergeEqualPoints(RawSurface& surface);

}  // namespace pectora
