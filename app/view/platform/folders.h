// Where the window keeps what it remembers: the user's own XDG folders.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pectora::view {

/// XDG_CONFIG_HOME/pectora (presets) and XDG_STATE_HOME/pectora (layout, recent files); made when first asked for. Without a
/// home the present folder's ".pectora".
std::filesystem::path configFolder();
std::filesystem::path stateFolder();

/// The last opened paths, newest first, at most ten. Only paths are kept, and only in the user's own folder.
class RecentFiles {
 public:
  RecentFiles();
  const std::vector<std::string>& paths() const { return paths_; }
  /// Puts a path first and writes the list.
  void add(const std::string& path);

 private:
  std::vector<std::string> paths_;
};

}  // namespace pectora::view
