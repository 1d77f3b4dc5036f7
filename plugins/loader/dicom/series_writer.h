// Writes a CT as a series of DICOM files. GDCM stays within.
#pragma once

#include "kernel/value/volume.h"

#include <functional>
#include <string>
#include <vector>

namespace pectora::dicom {

/// How pixels are stored. Lossless, all of them.
enum class Storage { implicitLittle, explicitLittle, explicitBig, deflated, rle, jpegLossless, jpegLs, jpeg2000 };
/// "implicit_le", ...; in the order of Storage.
const std::vector<std::string>& storageNames();
/// Throws Error if there is none of that name.
Storage storageOf(const std::string& name);

struct WriteOptions {
  Storage storage = Storage::explicitLittle;
  bool isTwelveBit = false;     ///< unsigned 12 of 16 bits with an intercept of -1024 (values beyond -1024 to 3071 are an error); else signed 16 bits
  bool shufflesNumbers = false; ///< names and instance numbers do not follow the positions
  std::string seed = "phantom"; ///< all UIDs follow from it and the slice's number: equal seeds, equal bytes
  std::string modality = "CT";
};

/// Writes the slices into an existing folder, one file a slice, on all threads; nothing in them depends on the clock.
/// The patient is PHANTOM. `cancelled` is called between slices and may throw. Returns the file names, from the feet to
/// the head. Throws Error if a value cannot be stored or a file cannot be written.
std::vector<std::string> writeSeries(const Volume& volume, const std::string& folder, const WriteOptions& options,
                                     const std::function<void()>& cancelled = [] {});

}  // namespace pectora::dicom
