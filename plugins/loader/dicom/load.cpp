#include "plugins/loader/dicom/load.h"

#include "plugins/loader/dicom/pixels.h"
#include "plugins/loader/dicom/stack.h"
#include "plugins/loader/dicom/untilt.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sys/mman.h>

namespace pectora::dicom {
namespace {

namespace fs = std::filesystem;

// Tells what else is in the folder, and refuses it if a file could be a damaged slice of the series.
void reportOthers(const Scan& scan, const Series& chosen, Host& host) {
  std::set<std::string> extensions;
  for (const std::size_t i : chosen.files) extensions.insert(fs::path(scan.paths[i]).extension());
  std::size_t foreign = 0;
  for (std::size_t i = 0; i < scan.files.size(); ++i) {
    const FileHeader& file = scan.files[i];
    const bool isUnreadable = file.kind == FileKind::unreadable;
    if (isUnreadable && extensions.count(fs::path(scan.paths[i]).extension()))
      throw Error(fmt::format("the file {}, and may be a slice of the series", file.damage)).at(scan.name(i))
          .advise("Copy it again from its source, or take it out of the folder if it is no slice");
    foreign += isUnreadable || file.kind == FileKind::foreign;
  }
  if (foreign > 0) host.info(fmt::format("{} file{} not DICOM and left out", foreign, foreign == 1 ? " is" : "s are"));
}

void reportSeries(const std::vector<Series>& series, std::size_t chosen, bool isAsked, Host& host) {
  const auto candidates = std::count_if(series.begin(), series.end(), [](const Series& s) { return s.obstacle.empty(); });
  const auto lines = listing(series);
  // A choice that nobody made is worth a warning.
  if (candidates > 1 && !isAsked) {
    std::string all;
    for (const std::string& line : lines) all += (all.empty() ? "" : "; ") + line;
    host.warn(fmt::format("there are {} CT series, number {} is loaded; `series` chooses another. {}", candidates, chosen + 1, all));
  } else {
    for (const std::string& line : lines) host.info("series " + line);
  }
  if (series[chosen].localizers > 0)
    host.info(fmt::format("{} localizer{} left out", series[chosen].localizers, series[chosen].localizers == 1 ? " is" : "s are"));
}

void reportValues(const Scan& scan, const Stack& stack, Host& host) {
  const FileHeader& file = scan.files[stack.slices.front().file];
  const FrameHeader& first = stack.slices.front().at;
  if (!file.modality[0]) host.warn("the files do not say their modality; by their kind they are CT");
  if (!stack.isTilted() && std::abs(file.gantryTilt) > 0.5 && std::abs(stack.grid.axes[2].z) > 0.9999)
    host.warn(fmt::format("the scanner noted a gantry tilt of {:g} degrees, but the slices are not tilted", file.gantryTilt));
  for (const Slice& slice : stack.slices) {
    if (slice.at.slope == first.slope && slice.at.intercept == first.intercept) continue;
    host.warn(fmt::format("slope and intercept of the values differ between slices: {:g}, {:g} in {}, {:g}, {:g} in {}", first.slope,
                          first.intercept, scan.name(stack.slices.front().file), slice.at.slope, slice.at.intercept, scan.name(slice.file)));
    break;
  }
  const auto isElsewhere = [&](const Slice& s) { return scan.files[s.file].frameOfReference != file.frameOfReference; };
  if (std::any_of(stack.slices.begin(), stack.slices.end(), isElsewhere))
    host.info("the slices name different frames of reference; their positions make one regular stack");
  const double padding = file.padding * first.slope + first.intercept;
  if (file.hasPadding && padding < -1024)
    host.info(fmt::format("pixels outside of the reconstruction have the value {:g}; it is kept", padding));
}

// Room for a volume in large pages: a third of the time of loading goes into touching small ones for the first time.
void makeRoom(std::vector<std::int16_t>& hu, std::size_t voxels) {
  constexpr std::uintptr_t kPage = 4096;
  hu.reserve(voxels);
  const auto begin = (reinterpret_cast<std::uintptr_t>(hu.data()) + kPage - 1) / kPage * kPage;
  const auto end = reinterpret_cast<std::uintptr_t>(hu.data() + voxels) / kPage * kPage;
  if (end > begin) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  hu.resize(voxels);
}

void flipRows(Volume& volume) {
  const Grid& g = volume.grid;
  parallelFor(std::size_t(g.size[2]), [&](std::size_t k) {
    for (int j = 0; j < g.size[1] / 2; ++j) {
      auto a = volume.hu.begin() + std::ptrdiff_t(g.index(0, j, int(k)));
      auto b = volume.hu.begin() + std::ptrdiff_t(g.index(0, g.size[1] - 1 - j, int(k)));
      std::swap_ranges(a, a + g.size[0], b);
    }
  });
}

}  // namespace

std::vector<std::string> filesOf(const std::string& path) {
  std::error_code error;
  fs::path root = path;
  if (!fs::exists(root, error)) throw Error("there is no such file or folder").of("path").given(path);
  if (!fs::is_directory(root, error)) {
    if (root.filename() != "DICOMDIR") return {path};
    // The directory of a disc lists the files that lie around it.
    root = root.has_parent_path() ? root.parent_path() : fs::path(".");
  }
  std::vector<std::string> files;
  for (auto it = fs::recursive_directory_iterator(root, error); !error && it != fs::recursive_directory_iterator(); it.increment(error))
    if (it->is_regular_file(error)) files.push_back(it->path().string());
  if (error) throw Error("the folder cannot be read: " + error.message()).of("path").given(path);
  if (files.empty()) throw Error("the folder is empty").of("path").given(path);
  std::sort(files.begin(), files.end());
  return files;
}

Volume load(const std::vector<std::string>& paths, const LoadOptions& options, Host& host) {
  Helpers helpers(paths, options.helpers);
  const Scan scan = helpers.scan(host);
  const std::vector<Series> series = groupSeries(scan);
  if (series.empty()) {
    const bool isOne = paths.size() == 1;
    Error error(isOne ? fmt::format("the file is no DICOM image{}", scan.files[0].damage[0] ? fmt::format(": it {}", scan.files[0].damage) : "")
                      : fmt::format("there is no DICOM image among {} files", paths.size()));
    if (isOne) error.at(scan.name(0));
    throw error.of("path").advise("Give the folder that holds the CT series");
  }
  const std::size_t chosen = chooseSeries(series, options.series);
  reportSeries(series, chosen, !options.series.empty(), host);
  reportOthers(scan, series[chosen], host);
  const Stack stack = arrange(scan, series[chosen]);
  reportValues(scan, stack, host);
  if (stack.isTilted() && !options.resamplesTilt)
    throw Error("the gantry was tilted: the slices are not perpendicular to the line of their positions").of("resample_tilt")
        .given(fmt::format("{:.2f} degrees", stack.tiltDeg)).advise("Set resample_tilt to shift each slice into place by linear interpolation");

  Volume volume;
  volume.grid = stack.grid;
  makeRoom(volume.hu, stack.grid.voxels());
  std::vector<FrameTarget> targets;
  for (std::size_t k = 0; k < stack.slices.size(); ++k) targets.push_back({stack.slices[k].file, stack.slices[k].frame, k});
  readPixels(scan, targets, stack.grid.sliceVoxels(), volume.hu.data(), helpers, host);
  if (stack.flipsRows) flipRows(volume);
  if (!stack.isTilted()) return volume;
  host.warn(fmt::format("the gantry was tilted by {:.2f} degrees; the slices are resampled", stack.tiltDeg));
  return untilt(volume, stack.drift[0], stack.drift[1]);
}

}  // namespace pectora::dicom
