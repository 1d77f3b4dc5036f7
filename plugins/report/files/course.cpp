#include "plugins/report/files/course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {

std::string courseCsv(const Motion& motion) {
  std::string csv = "time_s,energy_Nmm,kinetic_energy_Nmm,fastest_mm_per_s,displacement_rms_mm,displacement_max_mm\n";
  for (const Moment& moment : motion.moments) {
    double squares = 0, largest = 0;
    for (const double d : skinDisplacement(*motion.scene, moment.outer)) {
      squares += d * d;
      largest = std::max(largest, d);
    }
    const double rms = moment.outer.empty() ? 0 : std::sqrt(squares / double(moment.outer.size()));
    csv += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", moment.time, moment.energy, moment.kineticEnergy, moment.fastest, rms, largest);
  }
  return csv;
}

std::string coursePvd(const Motion& motion, const std::vector<std::string>& files) {
  std::string xml = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (std::size_t i = 0; i < files.size(); ++i)
    xml += fmt::format("    <DataSet timestep=\"{:g}\" file=\"{}\"/>\n", motion.moments[i].time, files[i]);
  return xml + "  </Collection>\n</VTKFile>\n";
}

}  // namespace pectora
