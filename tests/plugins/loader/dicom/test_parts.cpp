// The parts that know no DICOM library: values, fragments, series, stacks and tilts.
#include "plugins/loader/dicom/encapsulated.h"
#include "plugins/loader/dicom/hounsfield.h"
#include "plugins/loader/dicom/stack.h"
#include "plugins/loader/dicom/untilt.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace pectora::dicom {
namespace {

std::vector<std::int16_t> hounsfield(const PixelCode& code, const std::vector<unsigned char>& bytes) {
  std::vector<std::int16_t> hu(bytes.size() * 8 / std::size_t(code.bitsAllocated));
  toHounsfield(code, bytes.data(), hu.size(), hu.data());
  return hu;
}

TEST(Hounsfield, SignedValuesOfTwelveBitsKeepTheirSignAndLoseOverlayBits) {
  const PixelCode code{.bitsAllocated = 16, .bitsStored = 12, .highBit = 11, .isSigned = true};
  // -1 in 12 bits with and without bits above, and 2047.
  EXPECT_EQ(hounsfield(code, {0xff, 0x0f, 0xff, 0xff, 0xff, 0x07, 0xff, 0x17}), (std::vector<std::int16_t>{-1, -1, 2047, 2047}));
}

TEST(Hounsfield, BigEndianWordsAreSwappedAndUnsignedOnesAreNotNegative) {
  const PixelCode code{.isBigEndian = true, .slope = 1, .intercept = -1024};
  EXPECT_EQ(hounsfield(code, {0x04, 0x00, 0x10, 0x00}), (std::vector<std::int16_t>{0, 3072}));
}

TEST(Hounsfield, ValuesBeyondSixteenBitsAreClampedAndFractionsRounded) {
  const PixelCode steep{.isSigned = false, .slope = 2, .intercept = -1000};
  EXPECT_EQ(hounsfield(steep, {0xff, 0xff, 0x00, 0x00}), (std::vector<std::int16_t>{32767, -1000}));
  const PixelCode half{.bitsAllocated = 8, .bitsStored = 8, .highBit = 7, .slope = 0.5, .intercept = 0};
  EXPECT_EQ(hounsfield(half, {3, 4}), (std::vector<std::int16_t>{2, 2}));
}

TEST(Hounsfield, ImpossibleBitsAreNotReadable) {
  EXPECT_FALSE(isReadable({.bitsAllocated = 32, .bitsStored = 32, .highBit = 31}));
  EXPECT_FALSE(isReadable({.bitsAllocated = 16, .bitsStored = 12, .highBit = 16}));
  EXPECT_FALSE(isReadable({.bitsAllocated = 16, .bitsStored = 14, .highBit = 11}));
  EXPECT_FALSE(isReadable({.slope = std::nan("")}));
}

std::string fragments(const std::vector<std::string>& items, bool closes) {
  std::string text;
  const auto add = [&](const char* tag, std::size_t length) {
    text.append(tag, 4);
    for (int i = 0; i < 4; ++i) text += char(length >> (8 * i) & 0xff);
  };
  for (const std::string& item : items) add("\xfe\xff\x00\xe0", item.size()), text += item;
  if (closes) add("\xfe\xff\xdd\xe0", 0);
  return text;
}
std::string checked(const std::string& text) {
  return checkFragments(reinterpret_cast<const unsigned char*>(text.data()), text.size(), 0, true);
}

TEST(Fragments, WholeOnesPassAndEveryTruncationIsSeen) {
  const std::string whole = fragments({"", "abcd", std::string("ef\xff\xd9", 4)}, true);
  EXPECT_EQ(checked(whole), "");
  for (std::size_t length = 0; length < whole.size(); ++length) EXPECT_NE(checked(whole.substr(0, length)), "") << length;
  EXPECT_NE(checked(fragments({"", "abcd"}, true)), "");          // no end marker
  EXPECT_NE(checked(fragments({""}, true)), "");                  // only the table
}

// A scan of axial slices 2 mm apart.
struct Made {
  Scan scan;
  explicit Made(int slices) {
    for (int k = 0; k < slices; ++k) add(k * 2.0);
  }
  void add(double z) {
    FileHeader file;
    file.kind = FileKind::image;
    file.series = 7;
    std::strcpy(file.modality, "CT");
    std::strcpy(file.sopClass, "1.2.840.10008.5.1.4.1.1.2");
    file.rows = 8, file.columns = 10, file.frames = 1;
    file.bitsAllocated = file.bitsStored = 16, file.highBit = 15;
    file.firstFrame = std::uint32_t(scan.frames.size());
    FrameHeader frame;
    const double axial[6] = {1, 0, 0, 0, 1, 0};
    std::copy(axial, axial + 6, frame.orientation);
    frame.position[0] = -4, frame.position[1] = -3, frame.position[2] = z;
    frame.rowSpacing = 0.8, frame.columnSpacing = 0.7;
    frame.hasOrientation = frame.hasPosition = frame.hasSpacing = frame.hasRescale = true;
    scan.paths.push_back("/folder/s" + std::to_string(scan.files.size()) + ".dcm");
    scan.files.push_back(file);
    scan.frames.push_back(frame);
  }
  Stack stack() const { return arrange(scan, groupSeries(scan).at(0)); }
  std::string refusal() const {
    try {
      stack();
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }
};

#define EXPECT_SAYS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << text

TEST(Stack, SlicesAreOrderedByPositionWhateverTheirNames) {
  Made made(5);
  std::reverse(made.scan.frames.begin(), made.scan.frames.end());
  std::swap(made.scan.frames[1], made.scan.frames[3]);
  const Stack stack = made.stack();
  for (std::size_t k = 0; k < 5; ++k) EXPECT_DOUBLE_EQ(stack.slices[k].at.position[2], 2.0 * double(k));
  EXPECT_EQ(stack.grid.size, (std::array<int, 3>{10, 8, 5}));
  EXPECT_TRUE(stack.grid.spacing == (Vec3{0.7, 0.8, 2})) << "the first value of PixelSpacing is that between rows";
  EXPECT_TRUE(stack.grid.origin == (Vec3{-4, -3, 0}));
  EXPECT_FALSE(stack.isTilted());
}

TEST(Stack, AxesAreRightHandedAndUpwardsForAnyAxialOrientation) {
  const double kOrientations[][6] = {{1, 0, 0, 0, 1, 0}, {-1, 0, 0, 0, -1, 0}, {1, 0, 0, 0, -1, 0}, {-1, 0, 0, 0, 1, 0}, {0, 1, 0, -1, 0, 0}};
  for (const auto& orientation : kOrientations) {
    Made made(4);
    for (FrameHeader& frame : made.scan.frames) std::copy(orientation, orientation + 6, frame.orientation);
    const Stack stack = made.stack();
    const auto& axes = stack.grid.axes;
    EXPECT_NEAR(dot(cross(axes[0], axes[1]), axes[2]), 1, 1e-12);
    EXPECT_GT(axes[2].z, 0.99);
    // The image's first pixel stays where the file says, whether rows are flipped or not.
    const Vec3 first = stack.grid.toPatient({0, stack.flipsRows ? 7.0 : 0.0, 0});
    EXPECT_NEAR(distance(first, {-4, -3, 0}), 0, 1e-12);
  }
}

TEST(Stack, AMissingSliceIsNamedByItsNeighbours) {
  Made made(9);
  made.scan.frames[4].position[2] = 100;
  made.scan.files.erase(made.scan.files.begin() + 4);
  made.scan.paths.erase(made.scan.paths.begin() + 4);
  const std::string text = made.refusal();
  EXPECT_SAYS(text, "1 slice is missing");
  EXPECT_SAYS(text, "between 6.00 and 10.00 mm");
  EXPECT_SAYS(text, "s3.dcm and s5.dcm");
}

TEST(Stack, DoublePositionsAndUnequalSpacingAreRefused) {
  Made twice(5);
  twice.add(4);
  EXPECT_SAYS(twice.refusal(), "same position");
  Made uneven(5);
  uneven.scan.frames[2].position[2] += 0.03;
  EXPECT_SAYS(uneven.refusal(), "spacing of the slices varies");
  Made nearly(5);
  nearly.scan.frames[2].position[2] += 0.009;
  EXPECT_EQ(nearly.refusal(), "accepted") << "within 1 %";
}

TEST(Stack, SlicesThatDifferInAnyPropertyAreRefusedByName) {
  const auto refusalOf = [](auto edit) {
    Made made(5);
    edit(made.scan.files[3], made.scan.frames[3]);
    return made.refusal();
  };
  const std::pair<const char*, std::string> kCases[] = {
      {"size", refusalOf([](auto& file, auto&) { file.rows = 9; })},
      {"pixel format", refusalOf([](auto& file, auto&) { file.isSigned = true; })},
      {"pixel format", refusalOf([](auto& file, auto&) { file.bitsStored = 12, file.highBit = 11; })},
      {"modality", refusalOf([](auto& file, auto&) { std::strcpy(file.modality, "OT"); })},
      {"kind of object", refusalOf([](auto& file, auto&) { std::strcpy(file.sopClass, "1.2"); })},
      {"pixel spacing", refusalOf([](auto&, auto& frame) { frame.rowSpacing = 0.81; })},
      {"orientation", refusalOf([](auto&, auto& frame) { std::swap(frame.orientation[0], frame.orientation[1]), frame.orientation[3] = -1, frame.orientation[4] = 0; })},
      {"straight line", refusalOf([](auto&, auto& frame) { frame.position[0] += 1; })},
      {"no position", refusalOf([](auto&, auto& frame) { frame.hasPosition = false; })},
      {"no orientation", refusalOf([](auto&, auto& frame) { frame.hasOrientation = false; })},
      {"no pixel spacing", refusalOf([](auto&, auto& frame) { frame.hasSpacing = false; })},
      {"Hounsfield", refusalOf([](auto&, auto& frame) { frame.hasRescale = false; })},
      {"perpendicular", refusalOf([](auto&, auto& frame) { frame.orientation[3] = 0.3; })},
      {"truncated", refusalOf([](auto& file, auto&) { std::strcpy(file.damage, "is truncated within its pixels"); })},
      {"8 or 16 bits", refusalOf([](auto& file, auto&) { file.bitsAllocated = 32; })}};
  for (const auto& [what, text] : kCases) {
    EXPECT_SAYS(text, what);
    EXPECT_SAYS(text, "s3.dcm");
  }
}

TEST(Stack, FewerThanThreeSlicesAreNoVolume) { EXPECT_SAYS(Made(2).refusal(), "at least 3 slices"); }

TEST(Stack, ATiltedGantryIsMeasured) {
  Made made(11);
  const double angle = 12 * std::numbers::pi / 180;
  for (FrameHeader& frame : made.scan.frames) {
    frame.orientation[4] = std::cos(angle), frame.orientation[5] = std::sin(angle);
  }
  const Stack stack = made.stack();
  EXPECT_NEAR(stack.tiltDeg, 12, 1e-9);
  EXPECT_NEAR(stack.drift[0], 0, 1e-12);
  EXPECT_NEAR(stack.drift[1], 2 * std::sin(angle) / 0.8, 1e-12);
  EXPECT_NEAR(stack.grid.spacing.z, 2 * std::cos(angle), 1e-12);
}

TEST(Series, TheAxialCtWithTheMostSlicesIsChosen) {
  Made made(3);
  for (int k = 0; k < 5; ++k) made.add(k), made.scan.files.back().series = 8;
  for (int k = 0; k < 9; ++k) made.add(k), made.scan.files.back().series = 9, std::strcpy(made.scan.files.back().modality, "MR");
  for (int k = 0; k < 9; ++k) {
    made.add(k);
    made.scan.files.back().series = 10;
    const double coronal[6] = {1, 0, 0, 0, 0, -1};
    std::copy(coronal, coronal + 6, made.scan.frames.back().orientation);
  }
  const auto series = groupSeries(made.scan);
  ASSERT_EQ(series.size(), 4u);
  EXPECT_EQ(series[chooseSeries(series, "")].id, 8u);
  EXPECT_EQ(series[chooseSeries(series, "2")].id, 7u);
  EXPECT_EQ(series[chooseSeries(series, series[1].code())].id, 7u);
  EXPECT_EQ(series[2].obstacle + series[3].obstacle, "is MR, not CTis coronal, not axial");
  EXPECT_THROW(chooseSeries(series, "3"), Error);
  EXPECT_THROW(chooseSeries(series, "5"), Error);
  EXPECT_THROW(chooseSeries(series, "nonsense"), Error);
}

TEST(Series, LocalizersAndReportsAreLeftOut) {
  Made made(4);
  made.add(50), made.scan.files.back().isLocalizer = true;
  made.add(60), made.scan.files.back().kind = FileKind::noImage, std::strcpy(made.scan.files.back().modality, "SR");
  const auto series = groupSeries(made.scan);
  EXPECT_EQ(series[0].slices.size(), 4u);
  EXPECT_EQ(series[0].localizers, 1u);
  EXPECT_EQ(made.refusal(), "accepted");
}

TEST(Series, ACtWithoutPixelsInTheSeriesIsADamagedSlice) {
  Made made(4);
  made.add(8), made.scan.files.back().kind = FileKind::noImage;
  EXPECT_SAYS(made.refusal(), "no pixels");
}

// A linear field is reproduced exactly by linear interpolation, so the straightened volume is known in closed form.
TEST(Untilt, ALinearFieldIsReproducedWhereSlicesCoverTheGrid) {
  for (const double sign : {1.0, -1.0}) {
    Volume sheared;
    sheared.grid.size = {20, 18, 7};
    sheared.grid.spacing = {0.5, 0.8, 2};
    sheared.hu.resize(sheared.grid.voxels());
    const double driftX = 0.25 * sign, driftY = -0.75 * sign;
    const auto field = [](double x, double y, double z) { return 40 * x + 20 * y + 10 * z; };   // of voxels
    for (int k = 0; k < 7; ++k)
      for (int j = 0; j < 18; ++j)
        for (int i = 0; i < 20; ++i) sheared.hu[sheared.grid.index(i, j, k)] = std::int16_t(field(i + k * driftX, j + k * driftY, k));
    const Volume straight = untilt(sheared, driftX, driftY);
    EXPECT_EQ(straight.grid.size, (std::array<int, 3>{22, 23, 7}));
    int covered = 0;
    for (int k = 0; k < 7; ++k) {
      for (int j = 0; j < straight.grid.size[1]; ++j) {
        for (int i = 0; i < straight.grid.size[0]; ++i) {
          const Vec3 voxel = sheared.grid.toVoxel(straight.grid.toPatient({double(i), double(j), double(k)}));
          const double u = voxel.x - k * driftX, v = voxel.y - k * driftY;
          if (u < 0 || u > 19 || v < 0 || v > 17) continue;
          ++covered;
          // 0.5 of rounding the result, and as much of the made-up values.
          EXPECT_NEAR(straight.at(i, j, k), field(voxel.x, voxel.y, voxel.z), 1.0);
        }
      }
    }
    EXPECT_GT(covered, 7 * 17 * 19) << "no slice is cut off";
  }
}

TEST(Untilt, WholeShiftsMoveVoxelsWithoutBlur) {
  Volume sheared;
  sheared.grid.size = {6, 5, 3};
  sheared.hu.assign(sheared.grid.voxels(), 0);
  for (int k = 0; k < 3; ++k) sheared.hu[sheared.grid.index(1, 2, k)] = 900;
  const Volume straight = untilt(sheared, 2, 0);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(straight.at(1 + 2 * k, 2, k), 900);
  EXPECT_EQ(straight.at(0, 0, 2), -1024);
}

}  // namespace
}  // namespace pectora::dicom
