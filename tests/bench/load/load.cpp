// loader.dicom against dcm2niix on the same folder, in turns, in one run: 300 slices of 512 x 512, uncompressed.
// The loader is run as a script runs it, with the hash of the folder for provenance; dcm2niix writes a NIfTI file.
#include "plugins/loader/dicom/series_writer.h"

#include "kernel/host/runner.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace {
using namespace pectora;
namespace fs = std::filesystem;

/// A folder with a series and one for what dcm2niix writes; both go in the end.
class Series {
 public:
  Series() {
    std::string pattern = (fs::temp_directory_path() / "pectora-bench-XXXXXX").string();
    if (!mkdtemp(pattern.data())) std::abort();
    root_ = pattern;
    fs::create_directory(folder());
    fs::create_directory(out());
    Volume volume;
    volume.grid.size = {512, 512, 300};
    volume.hu.resize(volume.grid.voxels());
    for (std::size_t i = 0; i < volume.hu.size(); ++i) volume.hu[i] = std::int16_t((i * 2654435761u >> 20) % 4096 - 1024);
    dicom::writeSeries(volume, folder(), {.shufflesNumbers = true});
  }
  ~Series() { fs::remove_all(root_); }
  Series(const Series&) = delete;
  Series& operator=(const Series&) = delete;
  std::string folder() const { return root_ + "/series"; }
  std::string out() const { return root_ + "/out"; }

 private:
  std::string root_;
};

template <class Work>
double seconds(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void loadAgainstDcm2niix(benchmark::State& state) {
  const Series series;
  const std::string command = "dcm2niix -z n -b n -o " + series.out() + " " + series.folder() + " > /dev/null";
  Registry registry({PECTORA_PLUGINS});
  Messages messages;
  std::atomic<bool> cancel{false};
  std::vector<double> ours, theirs;
  for (auto _ : state) {
    Runner runner(registry, messages, cancel);   // with an empty cache
    const double loader = seconds([&] { benchmark::DoNotOptimize(runner.run("loader.dicom", {{"path", series.folder()}}, {})); });
    const double other = seconds([&] {
      if (std::system(command.c_str()) != 0) state.SkipWithError("dcm2niix cannot be run");
    });
    for (const auto& entry : fs::directory_iterator(series.out())) fs::remove(entry);
    ours.push_back(loader);
    theirs.push_back(other);
    state.SetIterationTime(loader);
  }
  state.counters["loader_s"] = median(ours);
  state.counters["dcm2niix_s"] = median(theirs);
  state.counters["ratio"] = median(ours) / median(theirs);
}
BENCHMARK(loadAgainstDcm2niix)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(9);

}  // namespace

BENCHMARK_MAIN();
