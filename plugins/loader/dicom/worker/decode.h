// Pixels by GDCM. GDCM may abort the process on damaged files: only for the helper program.
#pragma once

#include "plugins/loader/dicom/header.h"

namespace pectora::dicom {

/// Decodes all frames of a compressed file into Hounsfield units. `targets` has one place for framePixels() values a
/// frame, null where a frame is not wanted; `frames` are the rescaling of each. Returns what is wrong, as the end of
/// "the file ...", or "".
std::string decodeFile(const char* path, const FileHeader& header, const std::vector<FrameHeader>& frames,
                       const std::vector<std::int16_t*>& targets);

}  // namespace pectora::dicom
