#include "plugins/report/common/gnuplot.h"

#include "plugins/report/common/atomic_file.h"

#include "kernel/stage/error.h"

#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>

extern char** environ;

namespace pectora {
namespace {

// The commands stand in the file `commandPath` meanwhile.
void runGnuplot(const std::string& commands, const std::string& commandPath) {
  writeFile(commandPath, commands);
  std::string program = "gnuplot", file = commandPath;
  char* arguments[] = {program.data(), file.data(), nullptr};
  pid_t child = 0;
  int status = 0;
  const int failure = posix_spawnp(&child, "gnuplot", nullptr, nullptr, arguments, environ);
  if (failure == 0) waitpid(child, &status, 0);
  std::error_code ignored;
  std::filesystem::remove(commandPath, ignored);
  if (failure != 0) throw Error("gnuplot, which draws this picture, is not installed", ErrorKind::runFailed).advise("Install it: apt install gnuplot-nox");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw Error("gnuplot could not draw the picture", ErrorKind::runFailed);
}

}  // namespace

std::string inQuotes(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c == '\n' ? ' ' : c);
  return result + "'";
}

std::shared_ptr<const Report> drawPicture(const std::string& path, const std::function<std::string(const std::string& png)>& commandsFor) {
  const std::filesystem::path target = path;
  if (target.has_parent_path()) makeFolder(target.parent_path().string());
  const std::string aside = asideName(path);
  runGnuplot(commandsFor(aside), aside + ".gp");
  publish(path);
  auto report = std::make_shared<Report>();
  report->folder = target.parent_path().string();
  report->files = {target.filename().string()};
  return report;
}

}  // namespace pectora
