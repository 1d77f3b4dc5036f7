// What the writer wrote, the loader reads, whatever the storage; and files made by hand, without GDCM.
#include "support.h"

namespace pectora::dicom {
namespace {

void expectSame(const Volume& a, const Volume& b) {
  ASSERT_EQ(a.grid.size, b.grid.size);
  EXPECT_EQ(a.hu, b.hu);
  EXPECT_NEAR(distance(a.grid.origin, b.grid.origin), 0, 1e-9);
  EXPECT_NEAR(distance(a.grid.spacing, b.grid.spacing), 0, 1e-9);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(distance(a.grid.axes[axis], b.grid.axes[axis]), 0, 1e-9);
}

class EveryStorage : public testing::TestWithParam<std::string> {};

TEST_P(EveryStorage, GivesBackEveryHounsfieldUnit) {
  const Volume volume = patternVolume();
  for (const bool isTwelveBit : {false, true}) {
    TemporaryFolder folder;
    writeSeries(volume, folder.path, {.storage = storageOf(GetParam()), .isTwelveBit = isTwelveBit, .shufflesNumbers = true});
    ListeningHost host;
    expectSame(loadPath(folder.path, host), volume);
    EXPECT_TRUE(host.warnings.empty());
  }
}
INSTANTIATE_TEST_SUITE_P(Storage, EveryStorage, testing::ValuesIn(storageNames()), [](const auto& each) { return each.param; });

TEST(RoundTrip, ExtremeValuesSurviveSigned16BitStorage) {
  Volume volume = patternVolume();
  volume.hu[0] = -32768, volume.hu[1] = 32767, volume.hu[2] = -3024;
  TemporaryFolder folder;
  writeSeries(volume, folder.path, {});
  ListeningHost host;
  expectSame(loadPath(folder.path, host), volume);
  EXPECT_THROW(writeSeries(volume, folder.path, {.isTwelveBit = true}), Error);
}

TEST(RoundTrip, AnObliqueGridComesBackWhereItWas) {
  Volume volume = patternVolume();
  volume.grid.axes = {Vec3{0.96, 0.28, 0}, Vec3{-0.28, 0.96, 0}, Vec3{0, 0, 1}};
  TemporaryFolder folder;
  writeSeries(volume, folder.path, {});
  ListeningHost host;
  expectSame(loadPath(folder.path, host), volume);
}

TEST(RoundTrip, EqualSeedsGiveEqualBytesAndOtherSeedsOtherUids) {
  const Volume volume = patternVolume();
  TemporaryFolder a, b, c;
  writeSeries(volume, a.path, {.seed = "x"});
  writeSeries(volume, b.path, {.seed = "x"});
  writeSeries(volume, c.path, {.seed = "y"});
  EXPECT_EQ(readBytes(a.path + "/00002.dcm"), readBytes(b.path + "/00002.dcm"));
  EXPECT_NE(readBytes(a.path + "/00002.dcm"), readBytes(c.path + "/00002.dcm"));
}

TEST(RoundTrip, ImagesWhoseNormalPointsToTheFeetAreFlippedIntoARightHandedGrid) {
  const Volume volume = patternVolume();
  TemporaryFolder folder;
  // Rows stored from the back to the front: the first pixel is at the last row, and columns run towards -y.
  for (const std::string& name : writeSeries(volume, folder.path, {})) {
    editFile(folder.path + "/" + name, [&](PlainFile& file) {
      const std::string pixels = file.value(0x7fe00010);
      std::string flipped;
      const std::size_t row = std::size_t(volume.grid.size[0]) * 2;
      for (std::size_t at = pixels.size(); at >= row; at -= row) flipped += pixels.substr(at - row, row);
      file.set(0x7fe00010, "OW", flipped);
      const std::string position = file.value(0x00200032);
      const std::string z = position.substr(position.rfind('\\') + 1);
      file.set(0x00200032, "DS", "-100.5\\" + std::to_string(-80.25 + 15 * 0.8) + "\\" + z);
      file.set(0x00200037, "DS", "1\\0\\0\\0\\-1\\0");
    });
  }
  ListeningHost host;
  expectSame(loadPath(folder.path, host), volume);
}

TEST(RoundTrip, SlopeAndInterceptAreThoseOfEachSlice) {
  const Volume volume = patternVolume();
  TemporaryFolder folder;
  const auto names = writeSeries(volume, folder.path, {});
  editFile(folder.path + "/" + names[2], [](PlainFile& file) { file.set(0x00281052, "DS", "-7"), file.set(0x00281053, "DS", "2"); });
  ListeningHost host;
  const Volume loaded = loadPath(folder.path, host);
  EXPECT_EQ(loaded.at(3, 4, 2), 2 * volume.at(3, 4, 2) - 7);
  EXPECT_EQ(loaded.at(3, 4, 3), volume.at(3, 4, 3));
  ASSERT_EQ(host.warnings.size(), 1u);
  EXPECT_NE(host.warnings[0].find("differ between slices"), std::string::npos);
}

TEST(RoundTrip, AnEnhancedMultiFrameFileLoadsByItsFunctionalGroups) {
  const Volume volume = patternVolume();
  TemporaryFolder parts, folder;
  const auto names = writeSeries(volume, parts.path, {});
  PlainFile file(parts.path + "/" + names[0]);
  for (const unsigned tag : {0x00200032u, 0x00200037u, 0x00280030u, 0x00281052u, 0x00281053u}) file.remove(tag);
  file.set(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2.1");
  file.set(0x00280008, "IS", "6");
  // Orientation and spacing are shared, position and rescaling are each frame's; frames from the head to the feet.
  file.elements.push_back({0x52009229, "SQ", sequence({{{0x00209116, "SQ", sequence({{{0x00200037, "DS", "1\\0\\0\\0\\1\\0"}}})},
                                                       {0x00289110, "SQ", sequence({{{0x00280030, "DS", "0.8\\0.75"}}})}}})});
  std::vector<std::vector<PlainFile::Element>> frames;
  std::string pixels;
  for (int k = 5; k >= 0; --k) {
    PlainFile slice(parts.path + "/" + names[std::size_t(k)]);
    pixels += slice.value(0x7fe00010);
    frames.push_back({{0x00209113, "SQ", sequence({{{0x00200032, "DS", slice.value(0x00200032)}}})},
                      {0x00289145, "SQ", sequence({{{0x00281052, "DS", k == 3 ? "10" : "0"}, {0x00281053, "DS", "1"}}})}});
  }
  file.elements.push_back({0x52009230, "SQ", sequence(frames)});
  file.set(0x7fe00010, "OW", pixels);
  file.write(folder.path + "/enhanced.dcm");

  Volume expected = volume;
  for (std::size_t i = 3 * volume.grid.sliceVoxels(); i < 4 * volume.grid.sliceVoxels(); ++i) expected.hu[i] += 10;
  ListeningHost host;
  expectSame(loadPath(folder.path + "/enhanced.dcm", host), expected);
}

TEST(RoundTrip, ATiltedGantryIsResampledWhenAsked) {
  Volume volume = patternVolume();
  std::fill(volume.hu.begin(), volume.hu.end(), std::int16_t(40));
  TemporaryFolder folder;
  const auto names = writeSeries(volume, folder.path, {});
  // One pixel of drift along the rows with every slice.
  for (std::size_t k = 0; k < names.size(); ++k)
    editFile(folder.path + "/" + names[k], [&](PlainFile& file) {
      file.set(0x00200032, "DS", std::to_string(-100.5 + 0.75 * double(k)) + "\\-80.25\\" + std::to_string(-300 + 2.5 * double(k)));
    });
  const std::string text = refusal(folder.path);
  EXPECT_NE(text.find("gantry was tilted"), std::string::npos) << text;
  EXPECT_NE(text.find("resample_tilt"), std::string::npos) << text;
  LoadOptions options = loadOptions();
  options.resamplesTilt = true;
  ListeningHost host;
  const Volume straight = loadPath(folder.path, host, options);
  EXPECT_EQ(straight.grid.size, (std::array<int, 3>{24 + 5, 16, 6}));
  EXPECT_EQ(straight.at(0, 3, 0), 40);
  EXPECT_EQ(straight.at(0, 3, 1), -1024);
  EXPECT_EQ(straight.at(28, 3, 5), 40);
  EXPECT_EQ(straight.at(28, 3, 4), -1024);
  EXPECT_EQ(host.warnings.size(), 1u);
}

}  // namespace
}  // namespace pectora::dicom
