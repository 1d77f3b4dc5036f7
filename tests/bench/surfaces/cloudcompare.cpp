// CloudCompare's cloud-to-mesh distances on the same surfaces: its command reads files, so its own clock for the distances is
// what counts here, and the whole command's time stands beside it.
#include "tests/bench/surfaces/figures.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <sys/resource.h>
#include <unistd.h>

using namespace pectora;
using namespace pectora::bench;
namespace fs = std::filesystem;

namespace {

void writeObj(const Mesh& mesh, const fs::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  for (const Vec3& p : mesh.points) std::fprintf(file, "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
  for (const auto& t : mesh.triangles) std::fprintf(file, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
  std::fclose(file);
}

void writePoints(const Mesh& mesh, const fs::path& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  for (const Vec3& p : mesh.points) std::fprintf(file, "%.9g %.9g %.9g\n", p.x, p.y, p.z);
  std::fclose(file);
}

// Processor time of all commands so far.
double childrenSeconds() {
  rusage usage;
  ::getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void distanceCloudCompare(benchmark::State& state) {
  if (std::system("command -v CloudCompare > /dev/null") != 0) {
    state.SkipWithError("CloudCompare is not installed (package cloudcompare)");
    return;
  }
  const int n = int(state.range(0));
  const fs::path folder = fs::temp_directory_path() / ("pectora_cloudcompare_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const Mesh fixed = reference(n), sample = compared(n);
  writePoints(sample, folder / "compared.asc");
  writeObj(fixed, folder / "reference.obj");
  const std::string command = "cd " + folder.string() +
                              " && QT_QPA_PLATFORM=offscreen CloudCompare -SILENT -NO_TIMESTAMP -C_EXPORT_FMT ASC -PREC 9 -O compared.asc -O reference.obj -C2M_DIST > log.txt 2>&1";
  std::vector<double> distances;
  for (auto _ : state) {
    const double cpu = childrenSeconds();
    const auto begin = std::chrono::steady_clock::now();
    if (std::system(command.c_str()) != 0) state.SkipWithError("CloudCompare failed");
    state.counters["whole_command_s"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    state.counters["whole_command_cpu_s"] = childrenSeconds() - cpu;
    // "[ComputeDistances] Time: 0.61 s." and the time before it for an approximation.
    std::ifstream log(folder / "log.txt");
    double seconds = 0;
    for (std::string line; std::getline(log, line);)
      if (const std::size_t at = line.find("istances] Time: "); at != std::string::npos) seconds += std::atof(line.c_str() + at + 16);
    state.SetIterationTime(seconds);
  }
  std::ifstream result(folder / "compared_C2M_DIST.asc");
  for (std::string line; std::getline(result, line);) {
    std::istringstream words(line);
    double x, y, z, d;
    if (words >> x >> y >> z >> d) distances.push_back(d);
  }
  const std::vector<double> ours = ourDistances(fixed, sample);
  if (distances.size() == ours.size()) countDistances(state, distances, n, &ours);
  else state.SkipWithError("CloudCompare wrote no distances");
  fs::remove_all(folder);
}

}  // namespace

BENCHMARK(distanceCloudCompare)->Arg(317)->Arg(1001)->Unit(benchmark::kSecond)->UseManualTime()->Iterations(1);
