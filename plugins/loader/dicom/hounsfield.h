// Stored pixel values to Hounsfield units.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pectora::dicom {

/// How a pixel lies in memory and what its number means.
struct PixelCode {
  int bitsAllocated = 16;      ///< 8 or 16
  int bitsStored = 16, highBit = 15;
  bool isSigned = false;
  bool isBigEndian = false;
  double slope = 1, intercept = 0;
};

/// Whether toHounsfield can read it: 8 or 16 bits, the stored ones within them.
bool isReadable(const PixelCode& code);

/// slope * stored + intercept, rounded to the nearest (halves away from 0) and clamped to 16 bits. Bits beyond the
/// stored ones (old overlays) are left out. `from` holds count pixels; it may be the memory of `to` itself if pixels
/// have 16 bits.
void toHounsfield(const PixelCode& code, const void* from, std::size_t count, std::int16_t* to);

}  // namespace pectora::dicom
