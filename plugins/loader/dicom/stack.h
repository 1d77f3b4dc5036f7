// Slices in space: their order, their grid, and all that can be wrong with it.
#pragma once

#include "plugins/loader/dicom/series.h"

#include "kernel/value/volume.h"

namespace pectora::dicom {

/// The slices of a series as a volume.
struct Stack {
  Grid grid;                    ///< of the slices as they are; if there is a tilt, of the first one and those above it
  std::vector<Slice> slices;    ///< from the feet to the head
  bool flipsRows = false;       ///< the image's last row is row 0 of the grid, which makes the axes right-handed
  double drift[2] = {0, 0};     ///< of each slice against the one below, along axes 0 and 1, in voxels: not 0 if the gantry was tilted
  double tiltDeg = 0;           ///< between the normal of the slices and the line of their positions

  bool isTilted() const { return tiltDeg > 0; }
};

/// Orders the slices by their position along the normal and checks that they make one regular stack: each file whole,
/// all of one size, pixel format, pixel spacing and orientation, none missing or double, spacing within 1 %.
/// Throws Error with the name of the file at fault and what to do.
Stack arrange(const Scan& scan, const Series& series);

}  // namespace pectora::dicom
