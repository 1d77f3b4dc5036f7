// Files that are whole or not there.
#pragma once

#include <string>

namespace pectora {

/// Writes `bytes` beside `path` and renames it into place. Makes the folder if need be. Throws Error (runFailed).
void writeFile(const std::string& path, const std::string& bytes);
/// Makes a folder with its parents. Throws Error.
void makeFolder(const std::string& path);
/// The name under which to write before publish() renames it to `path`.
std::string asideName(const std::string& path);
void publish(const std::string& path);

}  // namespace pectora
