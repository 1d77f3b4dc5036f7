// Finds plugins by name and opens each when it is first named.
#pragma once

#include "kernel/stage/plugin.h"

#include <map>
#include <mutex>

namespace pectora {

struct Plugin {
  const Descriptor* descriptor = nullptr;
  std::string file;      ///< path of the shared library
  std::string fileHash;  ///< of its bytes: part of the cache key
};

/// The plugins of some folders. A plugin "stage.name" is the file stage.name.so; in the first folder that has one.
/// Opened plugins stay open until the process ends. Thread-safe.
class Registry {
 public:
  /// `folders` in the order of search.
  explicit Registry(std::vector<std::string> folders);
  /// Ids of all plugin files, sorted, without opening any.
  std::vector<std::string> ids() const;
  /// The stages that have plugins: "loader", "solver", ...
  std::vector<std::string> stages() const;
  bool has(const std::string& id) const;
  /// Opens the plugin, or returns it if it is open. Throws Error if there is none of that name (and suggests the nearest), if
  /// its build stamp differs from the kernel's (both are told), or if it is broken.
  const Plugin& open(const std::string& id);

 private:
  std::map<std::string, std::string> files_;   // id -> path
  std::map<std::string, Plugin> opened_;
  std::mutex mutex_;
};

/// PECTORA_PLUGIN_PATH (folders separated by ":") before the folder of the build or installation.
std::vector<std::string> pluginFolders();

}  // namespace pectora
