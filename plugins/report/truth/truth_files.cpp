#include "plugins/report/truth/truth_files.h"

#include <fmt/format.h>

namespace pectora {

std::string nrrdBytes(const Labels& labels, const std::string& recordKey) {
  const Grid& g = labels.grid;
  const auto vector = [](Vec3 v) { return fmt::format("({:.9g},{:.9g},{:.9g})", v.x, v.y, v.z); };
  std::string bytes = "NRRD0004\n# pectora record " + recordKey + "\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\n";
  bytes += fmt::format("sizes: {} {} {}\n", g.size[0], g.size[1], g.size[2]);
  bytes += fmt::format("space directions: {} {} {}\n", vector(g.axes[0] * g.spacing.x), vector(g.axes[1] * g.spacing.y), vector(g.axes[2] * g.spacing.z));
  bytes += "kinds: domain domain domain\nencoding: raw\nspace units: \"mm\" \"mm\" \"mm\"\n";
  bytes += "space origin: " + vector(g.origin) + "\n";
  for (std::size_t i = 0; i < labels.names.size(); ++i)
    if (!labels.names[i].empty()) bytes += fmt::format("label_{}:={}\n", i, labels.names[i]);
  bytes += "\n";
  bytes.append(reinterpret_cast<const char*>(labels.label.data()), labels.label.size());
  return bytes;
}

std::string centerlinesCsv(const Truth& truth) {
  std::string csv = "structure,side,number,point,x_mm,y_mm,z_mm\n";
  const auto add = [&](const char* structure, Side side, int number, const std::vector<Vec3>& line) {
    for (std::size_t i = 0; i < line.size(); ++i)
      csv += fmt::format("{},{},{},{},{:.4f},{:.4f},{:.4f}\n", structure, sideName(side), number, i, line[i].x, line[i].y, line[i].z);
  };
  for (const Rib& rib : truth.anatomy->ribs) add("rib", rib.side, rib.number, rib.centerline);
  for (const CartilageLine& c : truth.cartilages) add("cartilage", c.side, c.rib, c.centerline);
  return csv;
}

std::string metricsCsv(const Anatomy& anatomy) {
  std::string csv = "z_mm,transverse_mm,sternum_to_vertebra_mm,deepest_inner_wall_mm,haller_index,correction_index_percent\n";
  for (const LevelMetrics& m : anatomy.metrics)
    csv += fmt::format("{:.3f},{:.3f},{:.3f},{:.3f},{:.4f},{:.3f}\n", m.z, m.transverse, m.sternumToVertebra, m.deepestInnerWall, m.haller(), m.correctionIndex());
  return csv;
}

std::string landmarksCsv(const Landmarks& ct, const Landmarks& scan) {
  std::string csv = "name,ct_x,ct_y,ct_z,scan_x,scan_y,scan_z\n";
  for (const Landmark& l : ct.points)
    if (const Landmark* s = scan.find(l.name))
      csv += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", l.name, l.position.x, l.position.y, l.position.z, s->position.x, s->position.y, s->position.z);
  return csv;
}

std::string fastScanText(const Points& points) {
  std::string text = "% Ascii 3D points file in the layout of FastSCAN, made by Pectora from a phantom\n% Raw(separate)\n";
  text += fmt::format("% {} 3D points, x y z per line\n", points.points.size());
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    if (i > 0 && !points.sweeps.empty() && points.sweeps[i] != points.sweeps[i - 1]) text += "\n";
    const Vec3 p = points.points[i];
    text += fmt::format("{:8.2f} {:8.2f} {:8.2f}\n", p.x, p.y, p.z);
  }
  return text;
}

}  // namespace pectora
