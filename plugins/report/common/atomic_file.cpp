#include "plugins/report/common/atomic_file.h"

#include "kernel/stage/error.h"

#include <cstdio>
#include <filesystem>
#include <memory>

namespace pectora {
namespace fs = std::filesystem;

void makeFolder(const std::string& path) {
  std::error_code failed;
  fs::create_directories(path, failed);
  if (failed || !fs::is_directory(path))
    throw Error("the folder cannot be made", ErrorKind::runFailed).given(path).advise("Choose another with out=DIR");
}

std::string asideName(const std::string& path) { return path + ".part"; }

void publish(const std::string& path) {
  std::error_code failed;
  fs::rename(asideName(path), path, failed);
  if (failed) throw Error("the file cannot be put in its place", ErrorKind::runFailed).at(path);
}

void writeFile(const std::string& path, const std::string& bytes) {
  if (const fs::path folder = fs::path(path).parent_path(); !folder.empty()) makeFolder(folder.string());
  {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(asideName(path).c_str(), "wb"), std::fclose);
    if (!file || std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size() || std::fflush(file.get()) != 0) {
      std::error_code ignored;
      fs::remove(asideName(path), ignored);
      throw Error("the file cannot be written", ErrorKind::runFailed).at(path).advise("Is the disk full, or the folder closed to you?");
    }
  }
  publish(path);
}

}  // namespace pectora
