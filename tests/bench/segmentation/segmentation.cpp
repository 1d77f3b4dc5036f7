// The whole way from a CT of 300 slices of 512 x 512 to the anatomy and its rib cage: seconds, and the memory that it takes beyond
// the CT's own. Run it with --benchmark_out=FILE.json.
#include "phantom.h"

#include "kernel/physics/workers.h"
#include "plugins/segmenter/thorax/segment.h"
#include "plugins/splines/cartilage/cage.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

namespace {
using namespace pectora;

struct Silent final : Host {
  void progress(double, const std::string&) override {}
  bool cancelled() const override { return false; }
  void warn(const std::string&) override {}
  void info(const std::string&) override {}
  std::string pluginFolder() const override { return {}; }
};

// The process's present or greatest resident memory, MB, by /proc/self/status.
double memory(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key + ":")) return std::stod(line.substr(key.size() + 1)) / 1024;
  return 0;
}

std::shared_ptr<const Volume> chest() {
  phantom::Settings settings;
  settings.haller = 4;
  settings.sliceSpacing = 1.3;   // a few more than 300 slices
  const phantom::Patient patient = phantom::makePatient(settings);
  auto ct = phantom::rasterise(patient, settings, [](double) {}).ct;
  // Exactly 300 slices, those of the head's end.
  auto part = std::make_shared<Volume>(*ct);
  const int extra = ct->grid.size[2] - 300;
  if (extra < 0) std::abort();
  part->grid.size[2] = 300;
  part->grid.origin = ct->grid.toPatient({0, 0, double(extra)});
  part->hu.assign(ct->hu.begin() + std::ptrdiff_t(extra * ct->grid.sliceVoxels()), ct->hu.end());
  return part;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void wholeSegmentation(benchmark::State& state) {
  static const std::shared_ptr<const Volume> ct = chest();
  setThreads(2);
  Silent host;
  const auto seconds = [](auto from) { return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count(); };
  std::vector<double> anatomies, cages, processor;
  // The greatest memory is counted from here on.
  std::ofstream("/proc/self/clear_refs") << "5";
  const double before = memory("VmRSS");
  for (auto _ : state) {
    const std::clock_t busy = std::clock();
    const auto start = std::chrono::steady_clock::now();
    const auto anatomy = thorax::segment(ct, {}, host);
    anatomies.push_back(seconds(start));
    const auto middle = std::chrono::steady_clock::now();
    std::vector<std::string> warnings;
    const RibCage cage = buildCage(anatomy, ct.get(), {}, warnings);
    cages.push_back(seconds(middle));
    state.SetIterationTime(seconds(start));
    processor.push_back(double(std::clock() - busy) / CLOCKS_PER_SEC);
  }
  state.counters["segmenter_s"] = median(anatomies);
  state.counters["splines_s"] = median(cages);
  // Of all threads together: what it costs on a machine that is busy with other things, too.
  state.counters["processor_s"] = median(processor);
  state.counters["ct_MB"] = double(ct->bytes()) / (1 << 20);
  state.counters["beside_the_ct_MB"] = memory("VmHWM") - before;
  state.counters["peak_MB"] = memory("VmHWM") - before + double(ct->bytes()) / (1 << 20);
}
BENCHMARK(wholeSegmentation)->UseManualTime()->Unit(benchmark::kSecond)->Iterations(5);

}  // namespace

BENCHMARK_MAIN();
