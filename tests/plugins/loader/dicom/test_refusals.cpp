// Series that must not be loaded: each is refused with a sentence that names the file and says what to do.
#include "support.h"

namespace pectora::dicom {
namespace {

#define EXPECT_SAYS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << text

/// A good series in a folder, to be spoiled.
class Refusals : public testing::Test {
 protected:
  TemporaryFolder folder_;
  Volume volume_ = patternVolume();
  std::vector<std::string> names_ = writeSeries(volume_, folder_.path, {});
  std::string file(std::size_t k) const { return folder_.path + "/" + names_[k]; }
};

TEST_F(Refusals, ADroppedSlice) {
  std::filesystem::remove(file(2));
  const std::string text = refusal(folder_.path);
  EXPECT_SAYS(text, "1 slice is missing");
  EXPECT_SAYS(text, names_[1] + " and " + names_[3]);
}

TEST_F(Refusals, ADuplicateSlice) {
  std::filesystem::copy(file(2), folder_.path + "/copy.dcm");
  const std::string text = refusal(folder_.path);
  EXPECT_SAYS(text, "same position");
  EXPECT_SAYS(text, "copy.dcm");
}

TEST_F(Refusals, UnequalSpacing) {
  editFile(file(4), [](PlainFile& f) { f.set(0x00200032, "DS", "-100.5\\-80.25\\-290.1"); });
  EXPECT_SAYS(refusal(folder_.path), "spacing of the slices varies");
}

TEST_F(Refusals, ASliceOfAnotherSize) {
  editFile(file(3), [](PlainFile& f) {
    f.setShort(0x00280010, 15);
    f.set(0x7fe00010, "OW", f.value(0x7fe00010).substr(0, 24 * 15 * 2));
  });
  const std::string text = refusal(folder_.path);
  EXPECT_SAYS(text, "differ in size");
  EXPECT_SAYS(text, names_[3]);
}

TEST_F(Refusals, AnotherModality) {
  for (std::size_t k = 0; k < names_.size(); ++k) std::filesystem::remove(file(k));
  writeSeries(volume_, folder_.path, {.modality = "MR"});
  EXPECT_SAYS(refusal(folder_.path), "is MR, not CT");
}

TEST_F(Refusals, ReformatsThatAreNotAxial) {
  for (std::size_t k = 0; k < names_.size(); ++k)
    editFile(file(k), [&](PlainFile& f) {
      f.set(0x00200037, "DS", "0\\1\\0\\0\\0\\-1");
      f.set(0x00200032, "DS", std::to_string(2.5 * double(k)) + "\\0\\0");
    });
  EXPECT_SAYS(refusal(folder_.path), "is sagittal, not axial");
}

TEST_F(Refusals, AFileThatEndsAnywhereTooEarly) {
  const std::string whole = readBytes(file(3));
  for (std::size_t length : {std::size_t(0), std::size_t(1), std::size_t(100), std::size_t(140), std::size_t(300), whole.size() - 770, whole.size() - 2, whole.size() - 1}) {
    writeBytes(file(3), whole.substr(0, length));
    EXPECT_SAYS(refusal(folder_.path), names_[3]);
  }
}

TEST_F(Refusals, ACompressedFileThatEndsAnywhereTooEarly) {
  for (const Storage storage : {Storage::rle, Storage::jpegLossless, Storage::jpegLs, Storage::jpeg2000, Storage::deflated}) {
    for (std::size_t k = 0; k < names_.size(); ++k) std::filesystem::remove(file(k));
    writeSeries(volume_, folder_.path, {.storage = storage});
    const std::string whole = readBytes(file(3));
    for (const std::size_t lost : {std::size_t(1), std::size_t(9), std::size_t(60), std::size_t(200)}) {
      writeBytes(file(3), whole.substr(0, whole.size() - lost));
      // The last byte of a deflated file is often mere padding.
      if (storage == Storage::deflated && lost == 1) continue;
      EXPECT_SAYS(refusal(folder_.path), names_[3]) << int(storage) << " without " << lost << " bytes";
    }
  }
}

TEST_F(Refusals, PixelsThatDoNotFillTheImage) {
  editFile(file(3), [](PlainFile& f) { f.set(0x7fe00010, "OW", f.value(0x7fe00010).substr(2)); });
  EXPECT_SAYS(refusal(folder_.path), "fewer pixels");
  editFile(file(3), [](PlainFile& f) { f.set(0x7fe00010, "OW", f.value(0x7fe00010) + std::string(20, ' ')); });
  EXPECT_SAYS(refusal(folder_.path), "more pixels");
}

TEST_F(Refusals, MissingGeometryOrRescaling) {
  const std::pair<unsigned, const char*> kCases[] = {{0x00200032, "no position"}, {0x00200037, "no orientation"}, {0x00280030, "no pixel spacing"},
                                                     {0x00281052, "Hounsfield"},  {0x00281053, "Hounsfield"},     {0x7fe00010, "ends before its pixels"}};
  const std::string good = readBytes(file(1));
  for (const auto& [tag, what] : kCases) {
    editFile(file(1), [&, t = tag](PlainFile& f) { f.remove(t); });
    const std::string text = refusal(folder_.path);
    EXPECT_SAYS(text, what);
    EXPECT_SAYS(text, names_[1]);
    writeBytes(file(1), good);
  }
}

TEST_F(Refusals, ASingleSlice) {
  const std::string text = refusal(file(0));
  EXPECT_SAYS(text, "at least 3 slices");
  EXPECT_SAYS(text, "whole series");
}

TEST_F(Refusals, AFolderWithoutDicomAnEmptyFolderAndNoFolder) {
  TemporaryFolder other;
  EXPECT_SAYS(refusal(other.path), "the folder is empty");
  writeBytes(other.path + "/README", "nothing here\n");
  EXPECT_SAYS(refusal(other.path), "no DICOM image");
  EXPECT_SAYS(refusal(other.path + "/absent"), "no such file");
}

TEST_F(Refusals, AnUnreadableFileAmongTheSlicesThatMayBeOne) {
  writeBytes(folder_.path + "/00099.dcm", std::string(5000, '\0'));
  EXPECT_SAYS(refusal(folder_.path), "00099.dcm");
}

TEST_F(Refusals, AnUnknownSeries) {
  LoadOptions options = loadOptions();
  options.series = "4";
  EXPECT_SAYS(refusal(folder_.path, options), "there is no such series");
}

TEST_F(Refusals, ButOtherKindsOfFilesAreOnlyCounted) {
  writeBytes(folder_.path + "/README", "a note\n");
  writeBytes(folder_.path + "/picture.png", std::string("\x89PNG\r\n\x1a\n\0\0\0", 11));
  ListeningHost host;
  EXPECT_EQ(loadPath(folder_.path, host).hu, volume_.hu);
  EXPECT_NE(std::find(host.infos.begin(), host.infos.end(), "2 files are not DICOM and left out"), host.infos.end());
}

TEST_F(Refusals, ButTwoSeriesAreToldApartAndNeverMixed) {
  Volume other = patternVolume(24, 16, 9);
  for (auto& hu : other.hu) hu = std::int16_t(hu / 2);
  std::filesystem::create_directory(folder_.path + "/b");
  const auto more = writeSeries(other, folder_.path + "/b", {.seed = "other"});
  for (const std::string& name : more) std::filesystem::rename(folder_.path + "/b/" + name, folder_.path + "/b" + name);
  ListeningHost host;
  EXPECT_EQ(loadPath(folder_.path, host).hu, other.hu);
  ASSERT_EQ(host.warnings.size(), 1u);
  EXPECT_SAYS(host.warnings[0], "1: CT, 9 slices");
  EXPECT_SAYS(host.warnings[0], "2: CT, 6 slices");
  LoadOptions options = loadOptions();
  options.series = "2";
  ListeningHost quiet;
  EXPECT_EQ(loadPath(folder_.path, quiet, options).hu, volume_.hu);
  EXPECT_TRUE(quiet.warnings.empty());
}

TEST_F(Refusals, ButALocalizerInTheSeriesIsLeftOut) {
  std::filesystem::copy(file(0), folder_.path + "/scout.dcm");
  editFile(folder_.path + "/scout.dcm", [](PlainFile& f) { f.set(0x00080008, "CS", "ORIGINAL\\PRIMARY\\LOCALIZER"); });
  ListeningHost host;
  EXPECT_EQ(loadPath(folder_.path, host).hu, volume_.hu);
  EXPECT_NE(std::find(host.infos.begin(), host.infos.end(), "1 localizer is left out"), host.infos.end());
}

TEST_F(Refusals, NothingOfThePatientIsInAnyMessage) {
  for (std::size_t k = 0; k < names_.size(); ++k) editFile(file(k), [](PlainFile& f) { f.set(0x00100010, "PN", "SECRET^NAME"), f.set(0x00100020, "LO", "SECRET"); });
  ListeningHost host;
  loadPath(folder_.path, host);
  std::filesystem::remove(file(2));
  host.infos.push_back(refusal(folder_.path));
  for (const auto* list : {&host.infos, &host.warnings})
    for (const std::string& message : *list) EXPECT_EQ(message.find("SECRET"), std::string::npos);
}

}  // namespace
}  // namespace pectora::dicom
