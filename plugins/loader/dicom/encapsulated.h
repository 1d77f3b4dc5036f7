// The fragments of compressed pixel data, checked without decoding them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace pectora::dicom {

/// Walks the items of encapsulated pixel data, which begin at `offset` of a file. Returns what is wrong, as the end of
/// "the file ...", or "" if all fragments lie within the file, the closing delimiter is there and, where
/// `endsWithMarker` (all JPEG families), the last fragment ends with the marker FFD9.
std::string checkFragments(const unsigned char* file, std::size_t size, std::uint64_t offset, bool endsWithMarker);

}  // namespace pectora::dicom
