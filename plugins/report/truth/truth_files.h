// Texts and bytes of what a phantom knows of itself.
#pragma once

#include "kernel/value/truth.h"

#include <string>

namespace pectora {

/// NRRD (raw, LPS) of a label volume; the names of the labels stand in its key-value pairs.
std::string nrrdBytes(const Labels& labels, const std::string& recordKey);
/// "structure,side,number,point,x_mm,y_mm,z_mm": rib and cartilage centrelines.
std::string centerlinesCsv(const Truth& truth);
/// Per level: z, T, B, C, Haller and correction index.
std::string metricsCsv(const Anatomy& anatomy);
/// "name,ct_x,ct_y,ct_z,scan_x,scan_y,scan_z" of the landmarks that both have, mm.
std::string landmarksCsv(const Landmarks& ct, const Landmarks& scan);
/// A point cloud as FastSCAN writes it: comment lines, then fixed-width x y z in mm, a blank line between sweeps.
std::string fastScanText(const Points& points);

}  // namespace pectora
