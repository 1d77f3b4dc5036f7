// The pixels of slices: raw ones are read where they lie in their files, compressed ones by the helper programs.
#pragma once

#include "plugins/loader/dicom/helpers.h"

namespace pectora::dicom {

/// Reads slices into `to`, slice after slice of `slicePixels` Hounsfield units. Throws Error, naming the file, or Cancelled.
void readPixels(const Scan& scan, const std::vector<FrameTarget>& targets, std::size_t slicePixels, std::int16_t* to,
                Helpers& helpers, Host& host);

}  // namespace pectora::dicom
