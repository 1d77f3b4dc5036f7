// A motion in time as a table, and the list of its surfaces.
#pragma once

#include "kernel/value/motion.h"

#include <string>
#include <vector>

namespace pectora {

/// One row for every moment: time (s), potential and kinetic energy (N mm), the largest speed (mm/s), RMS and largest displacement of
/// the skin from rest (mm).
std::string courseCsv(const Motion& motion);
/// ParaView's collection (PVD) of one file a moment.
std::string coursePvd(const Motion& motion, const std::vector<std::string>& files);

}  // namespace pectora
