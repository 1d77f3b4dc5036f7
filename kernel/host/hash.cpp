#include "kernel/host/hash.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <xxhash.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

namespace pectora {
namespace {

std::string hex(XXH128_hash_t hash) {
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return text;
}

}  // namespace

std::string hashText(std::string_view text) { return hex(XXH3_128bits(text.data(), text.size())); }

std::string hashFile(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw Error("the file cannot be opened").at(path).advise("Check its name and that you may read it");
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(), XXH3_freeState);
  XXH3_128bits_reset(state.get());
  std::vector<char> buffer(1 << 18);
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), file.get()))
    XXH3_128bits_update(state.get(), buffer.data(), got);
  if (std::ferror(file.get())) throw Error("the file cannot be read to its end").at(path);
  return hex(XXH3_128bits_digest(state.get()));
}

std::string hashPath(const std::string& path) {
  namespace fs = std::filesystem;
  if (!fs::exists(path)) throw Error("there is no such file or folder").given(path).advise("Check the path");
  if (!fs::is_directory(path)) return hashFile(path);
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> hashes(files.size());
  parallelFor(files.size(), [&](std::size_t i) { hashes[i] = hashFile(files[i].string()); });
  std::string all;
  for (const std::string& hash : hashes) all += hash;
  return hashText(all);
}

}  // namespace pectora
