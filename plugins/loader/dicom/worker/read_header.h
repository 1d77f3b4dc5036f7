// Headers by GDCM. GDCM may abort the process on damaged files: only for the helper program.
#pragma once

#include "plugins/loader/dicom/header.h"

namespace pectora::dicom {

/// Reads a file's header up to its pixels, and checks that the pixels are all there. Fills `frames` with one entry a
/// frame. Never throws: what is wrong stands in the header's `damage`.
FileHeader readHeader(const char* path, std::vector<FrameHeader>& frames);

}  // namespace pectora::dicom
