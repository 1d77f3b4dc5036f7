// Sorting files into series, and choosing one.
#pragma once

#include "plugins/loader/dicom/header.h"

namespace pectora::dicom {

/// One image of a series.
struct Slice {
  std::size_t file = 0;
  int frame = 0;             ///< within its file
  FrameHeader at;
};

/// The files that share a SeriesInstanceUID, without localizers.
struct Series {
  std::uint64_t id = 0;                ///< FileHeader::series
  std::string what;                    ///< "CT", "MR", "RT plan", ...
  std::vector<std::size_t> files;      ///< in the order of the scan
  std::vector<Slice> slices;
  std::size_t localizers = 0;          ///< left out
  std::string obstacle;                ///< why it cannot be the CT, "" if it might: "is MR, not CT"

  /// Eight hexadecimal digits that name the series whatever else is in the folder.
  std::string code() const;
};

/// The series of a scan, those that can be the CT first, most slices first. Files that are not images make series too
/// if they belong to one. Throws nothing.
std::vector<Series> groupSeries(const Scan& scan);

/// "1: CT, 275 slices (code 0a1b2c3d)"; one line a series. Nothing in it identifies a patient.
std::vector<std::string> listing(const std::vector<Series>& series);

/// The number of the series to load: `wanted` is its number in the listing, its code or its whole SeriesInstanceUID; "" is
/// the axial CT with the most slices. Throws Error if there is none, or it cannot be the CT.
std::size_t chooseSeries(const std::vector<Series>& series, const std::string& wanted);

/// Why slices of this orientation are not an axial CT, e.g. "is sagittal"; "" if they are (within 45 degrees).
std::string orientationObstacle(const FrameHeader& frame);

}  // namespace pectora::dicom
