#include "plugins/loader/dicom/stack.h"

#include "plugins/loader/dicom/hounsfield.h"

#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace pectora::dicom {
namespace {

constexpr std::size_t kFewestSlices = 3;
constexpr double kSpacingTolerance = 0.01;      // part of the slice spacing
constexpr double kDirectionTolerance = 1e-3;    // of each component of a unit vector
constexpr double kSameSpacing = 1e-4;           // part of the pixel spacing
// In-plane drift from the first slice to the last, in pixels, from which the stack counts as tilted.
constexpr double kDriftPixels = 0.25;

const char* kCopyAgain = "Copy the series again from its source";
const char* kExportAgain = "Export the original axial series again, without reformats";

Vec3 rowOf(const FrameHeader& f) { return {f.orientation[0], f.orientation[1], f.orientation[2]}; }
Vec3 columnOf(const FrameHeader& f) { return {f.orientation[3], f.orientation[4], f.orientation[5]}; }
Vec3 positionOf(const FrameHeader& f) { return {f.position[0], f.position[1], f.position[2]}; }

// What every file and slice must have, whatever the others are.
void checkEach(const Scan& scan, const Series& series) {
  for (const std::size_t i : series.files) {
    const FileHeader& file = scan.files[i];
    if (file.damage[0]) throw Error(fmt::format("the file {}", file.damage)).at(scan.name(i)).advise(kCopyAgain);
    if (file.kind != FileKind::image) throw Error("the file has no pixels").at(scan.name(i)).advise(kCopyAgain);
    const PixelCode code{.bitsAllocated = file.bitsAllocated, .bitsStored = file.bitsStored, .highBit = file.highBit};
    if (!isReadable(code) || file.samples != 1)
      throw Error("the pixels are not single values of 8 or 16 bits").given(fmt::format("{} bits", file.bitsAllocated)).at(scan.name(i)).advise(kExportAgain);
  }
  for (const Slice& slice : series.slices) {
    const FrameHeader& f = slice.at;
    const auto refuse = [&](const char* what) { throw Error(what).at(scan.name(slice.file)).advise(kExportAgain); };
    if (!f.hasPosition) refuse("the slice has no position (ImagePositionPatient)");
    if (!f.hasOrientation) refuse("the slice has no orientation (ImageOrientationPatient)");
    if (!f.hasSpacing) refuse("the slice has no pixel spacing");
    if (!f.hasRescale) refuse("the slice does not say how its values become Hounsfield units (RescaleSlope, RescaleIntercept)");
    if (f.slope == 0) refuse("the slice has a RescaleSlope of 0");
    const Vec3 row = rowOf(f), column = columnOf(f);
    if (std::abs(norm(row) - 1) > kDirectionTolerance || std::abs(norm(column) - 1) > kDirectionTolerance ||
        std::abs(dot(row, column)) > kDirectionTolerance)
      refuse("the slice's orientation is not a pair of perpendicular unit vectors");
    if (!(f.rowSpacing > 0.01 && f.rowSpacing < 20 && f.columnSpacing > 0.01 && f.columnSpacing < 20))
      refuse("the slice's pixel spacing is impossible");
    for (const double x : f.position)
      if (std::abs(x) > 1e5) refuse("the slice's position is impossible");
  }
}

// All slices have what the first one has.
void checkAlike(const Scan& scan, const Series& series) {
  const Slice& first = series.slices.front();
  const FileHeader& a = scan.files[first.file];
  for (const Slice& slice : series.slices) {
    const FileHeader& b = scan.files[slice.file];
    const auto refuse = [&](const std::string& what, const std::string& given, const std::string& others) {
      throw Error("the slices of the series differ in " + what).given(given).allowed(others + ", as in " + scan.name(first.file)).at(scan.name(slice.file)).advise(kExportAgain);
    };
    if (a.rows != b.rows || a.columns != b.columns)
      refuse("size", fmt::format("{} x {}", b.columns, b.rows), fmt::format("{} x {}", a.columns, a.rows));
    if (a.bitsAllocated != b.bitsAllocated || a.bitsStored != b.bitsStored || a.highBit != b.highBit || a.isSigned != b.isSigned)
      refuse("pixel format", fmt::format("{} of {} bits{}", b.bitsStored, b.bitsAllocated, b.isSigned ? ", signed" : ""),
             fmt::format("{} of {} bits{}", a.bitsStored, a.bitsAllocated, a.isSigned ? ", signed" : ""));
    if (std::strcmp(a.modality, b.modality) != 0) refuse("modality", b.modality, a.modality);
    if (std::strcmp(a.sopClass, b.sopClass) != 0) refuse("kind of object", b.sopClass, a.sopClass);
    const FrameHeader &f = first.at, &g = slice.at;
    if (distance(rowOf(f), rowOf(g)) > kDirectionTolerance || distance(columnOf(f), columnOf(g)) > kDirectionTolerance)
      refuse("orientation", fmt::format("row {:.3f} {:.3f} {:.3f}", g.orientation[0], g.orientation[1], g.orientation[2]),
             fmt::format("row {:.3f} {:.3f} {:.3f}", f.orientation[0], f.orientation[1], f.orientation[2]));
    if (std::abs(f.rowSpacing / g.rowSpacing - 1) > kSameSpacing || std::abs(f.columnSpacing / g.columnSpacing - 1) > kSameSpacing)
      refuse("pixel spacing", fmt::format("{:g} x {:g} mm", g.columnSpacing, g.rowSpacing), fmt::format("{:g} x {:g} mm", f.columnSpacing, f.rowSpacing));
  }
}

// Heights along the normal rise in equal steps. Returns the step, mm.
double checkSteps(const Scan& scan, const std::vector<Slice>& slices, const std::vector<double>& heights) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < heights.size(); ++i) steps.push_back(heights[i] - heights[i - 1]);
  std::vector<double> sorted = steps;
  std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  const auto pair = [&](std::size_t i) { return scan.name(slices[i].file) + " and " + scan.name(slices[i + 1].file); };
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (usual < 1e-3 || steps[i] < 0.1 * usual)
      throw Error(fmt::format("two slices have the same position ({:.2f} mm along the stack)", heights[i])).at(pair(i))
          .advise("Take the double files out, or export a single phase and reconstruction of the scan");
  std::size_t missing = 0, gaps = 0, first = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double times = std::round(steps[i] / usual);
    if (times < 2 || std::abs(steps[i] - times * usual) > 0.1 * usual) continue;
    if (gaps++ == 0) first = i;
    missing += std::size_t(times) - 1;
  }
  if (gaps > 0)
    throw Error(fmt::format("{} slice{} missing: the first gap is between {:.2f} and {:.2f} mm, where slices are {:.3g} mm apart",
                            missing, missing == 1 ? " is" : "s are", heights[first], heights[first + 1], usual)).at(pair(first)).advise(kCopyAgain);
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (std::abs(steps[i] - usual) > kSpacingTolerance * usual)
      throw Error("the spacing of the slices varies").given(fmt::format("{:.4g} mm at {:.2f} mm along the stack", steps[i], heights[i]))
          .allowed(fmt::format("{:.4g} mm within 1 %", usual)).at(pair(i)).advise("Export a series of one spacing");
  return (heights.back() - heights.front()) / double(steps.size());
}

}  // namespace

Stack arrange(const Scan& scan, const Series& series) {
  checkEach(scan, series);
  if (series.slices.size() < kFewestSlices)
    throw Error(fmt::format("a volume needs at least {} slices", kFewestSlices)).given(fmt::format("{}", series.slices.size()))
        .at(scan.name(series.slices.front().file)).advise("Give the folder that holds the whole series");
  checkAlike(scan, series);

  // Axes of the grid: the third one towards the head, and right-handed.
  Stack stack;
  const Slice& any = series.slices.front();
  const FileHeader& file = scan.files[any.file];
  const Vec3 row = normalized(rowOf(any.at));
  const Vec3 column = normalized(columnOf(any.at) - row * dot(row, columnOf(any.at)));
  Vec3 normal = cross(row, column);
  if (const std::string obstacle = orientationObstacle(any.at); !obstacle.empty())
    throw Error("the series " + obstacle).at(scan.name(any.file)).advise(kExportAgain);
  stack.flipsRows = normal.z < 0;
  const Vec3 down = stack.flipsRows ? -column : column;
  normal = cross(row, down);

  // Order by the position along the normal.
  std::vector<std::pair<double, Slice>> ordered;
  for (const Slice& slice : series.slices) ordered.emplace_back(dot(positionOf(slice.at), normal), slice);
  std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<double> heights;
  for (auto& [height, slice] : ordered) {
    heights.push_back(height);
    stack.slices.push_back(slice);
  }
  const double step = checkSteps(scan, stack.slices, heights);

  // The positions lie on a line; its drift within the planes is the tilt of the gantry.
  const Vec3 from = positionOf(stack.slices.front().at), to = positionOf(stack.slices.back().at);
  const Vec3 stride = (to - from) / double(heights.size() - 1);
  const double pixel = std::min(any.at.rowSpacing, any.at.columnSpacing);
  for (std::size_t i = 0; i < stack.slices.size(); ++i) {
    const double off = distance(positionOf(stack.slices[i].at), from + stride * double(i));
    if (off > std::max(kDriftPixels * pixel, 2 * kSpacingTolerance * step))
      throw Error("the positions of the slices are not on one straight line").given(fmt::format("{:.2f} mm off", off))
          .at(scan.name(stack.slices[i].file)).advise(kExportAgain);
  }
  const double alongRow = dot(stride, row), alongColumn = dot(stride, down);
  const double drift = std::hypot(alongRow, alongColumn);
  if (drift * double(heights.size() - 1) > kDriftPixels * pixel) {
    stack.drift[0] = alongRow / any.at.columnSpacing;
    stack.drift[1] = alongColumn / any.at.rowSpacing;
    stack.tiltDeg = std::atan2(drift, step) * 180 / std::numbers::pi;
  }

  stack.grid.size = {file.columns, file.rows, int(stack.slices.size())};
  stack.grid.spacing = {any.at.columnSpacing, any.at.rowSpacing, step};
  stack.grid.axes = {row, down, normal};
  stack.grid.origin = from;
  if (stack.flipsRows) stack.grid.origin += column * (any.at.rowSpacing * (file.rows - 1));
  return stack;
}

}  // namespace pectora::dicom
