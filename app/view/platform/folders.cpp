#include "app/view/platform/folders.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace pectora::view {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kRecent = 10;

fs::path xdgFolder(const char* variable, const char* belowHome) {
  const char* given = std::getenv(variable);
  const char* home = std::getenv("HOME");
  fs::path folder = given && *given ? fs::path(given) / "pectora" : home && *home ? fs::path(home) / belowHome / "pectora" : fs::path(".pectora");
  std::error_code ignored;   // a read-only home: nothing is remembered
  fs::create_directories(folder, ignored);
  return folder;
}

}  // namespace

fs::path configFolder() { return xdgFolder("XDG_CONFIG_HOME", ".config"); }
fs::path stateFolder() { return xdgFolder("XDG_STATE_HOME", ".local/state"); }

RecentFiles::RecentFiles() {
  std::ifstream file(stateFolder() / "recent");
  for (std::string line; paths_.size() < kRecent && std::getline(file, line);)
    if (!line.empty()) paths_.push_back(line);
}

void RecentFiles::add(const std::string& path) {
  std::erase(paths_, path);
  paths_.insert(paths_.begin(), path);
  if (paths_.size() > kRecent) paths_.resize(kRecent);
  std::ofstream file(stateFolder() / "recent");
  for (const std::string& known : paths_) file << known << "\n";
}

}  // namespace pectora::view
