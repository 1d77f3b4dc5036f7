#include "plugins/loader/dicom/series.h"

#include "kernel/stage/error.h"
#include "kernel/value/vec3.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace pectora::dicom {
namespace {

// Kinds of objects that say what they are without a modality, by SOP class.
std::string kindOfClass(const std::string& sopClass) {
  static const std::map<std::string, std::string> kKinds{
      {"1.2.840.10008.5.1.4.1.1.2", "CT"},       {"1.2.840.10008.5.1.4.1.1.2.1", "CT"},
      {"1.2.840.10008.5.1.4.1.1.2.2", "CT"},     {"1.2.840.10008.5.1.4.1.1.4", "MR"},
      {"1.2.840.10008.5.1.4.1.1.4.1", "MR"},     {"1.2.840.10008.5.1.4.1.1.7", "secondary capture"},
      {"1.2.840.10008.5.1.4.1.1.66.4", "SEG"},   {"1.2.840.10008.5.1.4.1.1.128", "PT"},
      {"1.2.840.10008.5.1.4.1.1.481.2", "RTDOSE"}};
  const auto found = kKinds.find(sopClass);
  return found == kKinds.end() ? "" : found->second;
}

std::string kindOf(const FileHeader& file) {
  const std::string byClass = kindOfClass(file.sopClass);
  // A capture of a screen and a segmentation bear the modality of the CT that they show.
  if (byClass == "secondary capture" || byClass == "SEG") return byClass;
  if (file.modality[0]) return file.modality;
  return byClass;
}

std::string obstacleOf(const Series& series, const Scan& scan) {
  if (series.what.empty()) return "does not say what it is (no modality)";
  if (series.what != "CT") return "is " + series.what + ", not CT";
  if (series.slices.empty()) return series.localizers > 0 ? "is a localizer (scout view)" : "has no images";
  if (scan.files[series.files.front()].samples != 1) return "has coloured pixels";
  // Of most of its slices: single ones that differ are an error of a chosen series.
  std::map<std::string, std::size_t> votes;
  for (const Slice& slice : series.slices) ++votes[orientationObstacle(slice.at)];
  const auto most = std::max_element(votes.begin(), votes.end(), [](auto& a, auto& b) { return a.second < b.second; });
  return most->first;
}

}  // namespace

std::string orientationObstacle(const FrameHeader& frame) {
  if (!frame.hasOrientation) return "";   // reported with the file's name when the slices are arranged
  const Vec3 row{frame.orientation[0], frame.orientation[1], frame.orientation[2]};
  const Vec3 column{frame.orientation[3], frame.orientation[4], frame.orientation[5]};
  const Vec3 normal = normalized(cross(row, column));
  if (std::abs(normal.z) >= std::sqrt(0.5)) return "";
  return std::abs(normal.x) > std::abs(normal.y) ? "is sagittal, not axial" : "is coronal, not axial";
}

std::string Series::code() const { return fmt::format("{:08x}", std::uint32_t(id ^ id >> 32)); }

std::vector<Series> groupSeries(const Scan& scan) {
  std::map<std::pair<std::uint64_t, std::string>, Series> groups;
  for (std::size_t i = 0; i < scan.files.size(); ++i) {
    const FileHeader& file = scan.files[i];
    if (file.kind != FileKind::image && (file.kind != FileKind::noImage || file.series == 0)) continue;
    // A report or plan may bear the UID of the images; a CT without pixels is a damaged slice of its series.
    const std::string kind = kindOf(file);
    const bool isApart = file.kind == FileKind::noImage && !kind.empty() && kind != "CT";
    Series& series = groups[{file.series, isApart ? kind : ""}];
    series.id = file.series;
    if (series.what.empty()) series.what = kind;
    if (file.isLocalizer) {
      ++series.localizers;
      continue;
    }
    series.files.push_back(i);
    if (file.kind != FileKind::image) continue;
    for (int f = 0; f < file.frames; ++f)
      series.slices.push_back({i, f, scan.frames[file.firstFrame + std::uint32_t(f)]});
  }
  std::vector<Series> sorted;
  for (auto& [key, series] : groups) {
    series.obstacle = obstacleOf(series, scan);
    sorted.push_back(std::move(series));
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const Series& a, const Series& b) {
    if (a.obstacle.empty() != b.obstacle.empty()) return a.obstacle.empty();
    return a.slices.size() > b.slices.size();
  });
  return sorted;
}

std::vector<std::string> listing(const std::vector<Series>& series) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const Series& s = series[i];
    std::string line = fmt::format("{}: {}, {} slice{} (code {})", i + 1, s.what.empty() ? "unknown" : s.what,
                                   s.slices.size(), s.slices.size() == 1 ? "" : "s", s.code());
    if (!s.obstacle.empty()) line += ", " + s.obstacle;
    lines.push_back(line);
  }
  return lines;
}

std::size_t chooseSeries(const std::vector<Series>& series, const std::string& wanted) {
  const auto numbers = [&] { return fmt::format("1 to {}, or a code", series.size()); };
  std::size_t chosen = 0;
  if (!wanted.empty()) {
    const bool isNumber = wanted.size() <= 4 && wanted.find_first_not_of("0123456789") == std::string::npos;
    for (chosen = 0; chosen < series.size(); ++chosen) {
      if (isNumber ? std::stoul(wanted) == chosen + 1 : series[chosen].code() == wanted || series[chosen].id == hashUid(wanted)) break;
    }
    if (chosen == series.size()) {
      std::string all = "The series are ";
      for (const std::string& line : listing(series)) all += (all.back() == ' ' ? "" : "; ") + line;
      throw Error("there is no such series").of("series").given(wanted).allowed(numbers()).advise(all);
    }
  }
  if (series.empty()) throw Error("there is no series of images").of("path").advise("Give the folder of the chest CT");
  const Series& s = series[chosen];
  if (s.obstacle.empty()) return chosen;
  if (!wanted.empty()) throw Error("this series " + s.obstacle).of("series").given(wanted);
  std::string found;
  std::set<std::string> told;
  for (const Series& other : series)
    if (told.insert(other.obstacle).second) found += (found.empty() ? "" : "; ") + ("one " + other.obstacle);
  throw Error("there is no axial CT series: " + found).of("path").advise("Export the axial CT series of the chest, without reformats");
}

}  // namespace pectora::dicom
