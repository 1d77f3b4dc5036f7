// From files to a CT.
#pragma once

#include "plugins/loader/dicom/helpers.h"

#include "kernel/value/volume.h"

namespace pectora::dicom {

struct LoadOptions {
  std::string series;          ///< see chooseSeries
  bool resamplesTilt = false;  ///< make the volume of a tilted gantry rectangular, rather than refuse it
  Helpers::Options helpers;
};

/// All files below a folder; the folder's if `path` is a DICOMDIR; else the file itself. Sorted. Throws Error.
std::vector<std::string> filesOf(const std::string& path);

/// Reads the CT series among some files. Throws Error if there is none that is whole, or Cancelled.
Volume load(const std::vector<std::string>& paths, const LoadOptions& options, Host& host);

}  // namespace pectora::dicom
