// Landmark files: a line "name, x, y, z" for each, mm; lines that begin with # are comments.
#pragma once

#include "kernel/value/mesh.h"

#include <string>

namespace pectora {

/// Columns of the wanted set: with a header line "name,ct_x,ct_y,ct_z,scan_x,scan_y,scan_z", `set` "ct" or "scan" chooses the columns
/// that begin with it; without one, the first three numbers. Throws Error with the line at fault.
Landmarks readLandmarks(const std::string& text, const std::string& set);

}  // namespace pectora
