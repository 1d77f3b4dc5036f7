// Hashes for cache keys and provenance: 128-bit XXH3, as 32 hexadecimal digits.
#pragma once

#include <string>
#include <string_view>

namespace pectora {

std::string hashText(std::string_view text);
/// Hash of a file's bytes. Throws Error if it cannot be read.
std::string hashFile(const std::string& path);
/// Hash of a file's bytes, or of the bytes of all files below a folder in the order of their names. Names are not part
/// of it, and are never kept: they may hold a patient's. Throws Error if there is no such path.
std::string hashPath(const std::string& path);

}  // namespace pectora
