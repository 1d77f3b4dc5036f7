#include "kernel/host/registry.h"

#include "kernel/host/hash.h"
#include "kernel/host/suggest.h"

#include <dlfcn.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>

namespace pectora {
namespace fs = std::filesystem;

Registry::Registry(std::vector<std::string> folders) {
  for (const std::string& folder : folders) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      const fs::path& path = entry.path();
      if (path.extension() != ".so" || path.stem().string().find('.') == std::string::npos) continue;
      files_.emplace(path.stem().string(), path.string());  // the first folder wins
    }
  }
}

std::vector<std::string> Registry::ids() const {
  std::vector<std::string> ids;
  for (const auto& [id, file] : files_) ids.push_back(id);
  return ids;
}

std::vector<std::string> Registry::stages() const {
  std::set<std::string> stages;
  for (const auto& [id, file] : files_) stages.insert(id.substr(0, id.find('.')));
  return {stages.begin(), stages.end()};
}

bool Registry::has(const std::string& id) const { return files_.contains(id); }

const Plugin& Registry::open(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (const auto found = opened_.find(id); found != opened_.end()) return found->second;
  const auto file = files_.find(id);
  if (file == files_.end()) {
    // Names of the same stage come first to mind.
    const std::string stage = id.substr(0, id.find('.') + 1);
    std::vector<std::string> near;
    for (const auto& [name, path] : files_)
      if (name.starts_with(stage)) near.push_back(name);
    throw Error("there is no plugin \"" + id + "\"").advise(suggest(id, near.empty() ? ids() : near));
  }

  // The stamp is compared before anything else of the plugin runs.
  void* library = dlopen(file->second.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw Error("the plugin cannot be opened: " + std::string(dlerror())).at(file->second).advise("Build it again against this Pectora");
  const auto stamp = reinterpret_cast<const char* (*)()>(dlsym(library, "pectora_build_stamp"));
  const auto entry = reinterpret_cast<const Descriptor* (*)()>(dlsym(library, "pectora_plugin"));
  if (!stamp || !entry)
    throw Error("this is no Pectora plugin: it does not export pectora_build_stamp and pectora_plugin")
        .at(file->second).advise("Use PECTORA_STAGE, PECTORA_EFFECT or PECTORA_SOLVER once in it");
  if (std::strcmp(stamp(), PECTORA_BUILD_STAMP) != 0)
    throw Error("the plugin was built for another Pectora")
        .given(stamp()).allowed(PECTORA_BUILD_STAMP).at(file->second).advise("Build it again with this one");
  const Descriptor* descriptor = entry();
  const int factories = bool(descriptor->makeStage) + bool(descriptor->makeEffect) + bool(descriptor->makeSolver);
  if (descriptor->id != id || factories != 1)
    throw Error("the plugin does not match its file's name: it calls itself \"" + descriptor->id + "\"")
        .at(file->second).advise("Name the file like its id");
  return opened_[id] = Plugin{descriptor, file->second, hashFile(file->second)};
}

std::vector<std::string> pluginFolders() {
  std::vector<std::string> folders;
  if (const char* path = std::getenv("PECTORA_PLUGIN_PATH")) {
    const std::string list = path;
    for (std::size_t begin = 0; begin < list.size();) {
      const std::size_t end = std::min(list.find(':', begin), list.size());
      if (end > begin) folders.push_back(list.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  // Plugins lie in "pectora" beside the kernel's own library.
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&pluginFolders), &info) && info.dli_fname)
    folders.push_back((fs::canonical(info.dli_fname).parent_path() / "pectora").string());
  return folders;
}

}  // namespace pectora
