// A place for what a test writes.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace pectora {

/// A path below the system's temporary folder that no other process uses. Nothing is made there.
inline std::filesystem::path scratch(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("pectora_test_" + name + "_" + std::to_string(getpid()));
}

}  // namespace pectora
