// Real CTs against what two independent readers agree on, and every file of the collection of hard DICOM.
#include "support.h"

#include "plugins/loader/dicom/pixels.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <map>

namespace pectora::dicom {
namespace {

namespace fs = std::filesystem;
const std::string kData = PECTORA_DATA;

// By coreutils, so independent of us.
std::string sha256(const std::vector<std::int16_t>& hu) {
  TemporaryFolder folder;
  writeBytes(folder.path + "/hu", {reinterpret_cast<const char*>(hu.data()), hu.size() * sizeof(hu[0])});
  char line[65] = {};
  const std::string command = "sha256sum < " + folder.path + "/hu";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe || std::fread(line, 1, 64, pipe.get()) != 64) return "";
  return line;
}

class Oracle : public testing::TestWithParam<const char*> {};

TEST_P(Oracle, VolumeIsThatOfTwoOtherReaders) {
  const std::string folder = kData + "/ct/" + GetParam();
  if (!fs::exists(folder)) GTEST_SKIP() << "PECTORA_DATA has no folder ct/" << GetParam();
  nlohmann::json oracle;
  std::ifstream(folder + "/ORACLE.json") >> oracle;
  ListeningHost host;
  const Volume volume = loadPath(folder + "/dicom", host);
  const std::vector<int> shape = oracle["shape_zyx"];
  EXPECT_EQ(volume.grid.size, (std::array<int, 3>{shape[2], shape[1], shape[0]}));
  const std::vector<double> first = oracle["ipp_first"], pixel = oracle["pixel_spacing_row_col"];
  EXPECT_NEAR(distance(volume.grid.origin, {first[0], first[1], first[2]}), 0, 1e-9);
  EXPECT_NEAR(volume.grid.spacing.y, pixel[0], 1e-12);
  EXPECT_NEAR(volume.grid.spacing.x, pixel[1], 1e-12);
  EXPECT_NEAR(volume.grid.spacing.z, double(oracle["slice_step"]), 1e-6);
  EXPECT_EQ(sha256(volume.hu), oracle["sha256_int16_LE_HU_zyx_ascending_z"]);
}
INSTANTIATE_TEST_SUITE_P(Ct, Oracle, testing::Values("lidc_0314", "acrin_flt_013", "cptac_c3l00189"), [](const auto& each) { return std::string(each.param); });

// Every file alone, and every folder: loaded, or refused with a sentence that ends with advice. A crash would end this.
TEST(Collection, EveryFileAndFolderIsLoadedOrRefusedWithASentence) {
  const std::string root = kData + "/dicom";
  if (!fs::exists(root)) GTEST_SKIP() << "PECTORA_DATA has no folder dicom";
  std::map<std::string, std::string> outcomes;
  std::vector<std::string> paths;
  for (const auto& entry : fs::recursive_directory_iterator(root)) paths.push_back(entry.path().string());
  for (const std::string& path : paths) {
    ListeningHost host;
    std::string outcome;
    try {
      const Volume volume = loadPath(path, host);
      ASSERT_EQ(volume.hu.size(), volume.grid.voxels());
      outcome = "loaded";
    } catch (const Error& error) {
      outcome = error.what();
      EXPECT_EQ(outcome.find("broke the DICOM library"), std::string::npos) << path << ": " << outcome;
    }
    outcomes[path.substr(root.size() + 1)] = outcome;
  }
  const std::string tree = "pydicom_testfiles/dicomdirtests_tree/src/pydicom/data/test_files/dicomdirtests/";
  const auto expect = [&](const std::string& path, const std::string& part) {
    EXPECT_NE(outcomes[path].find(part), std::string::npos) << path << ": " << outcomes[path];
  };
  expect(tree + "98892001", "loaded");
  expect(tree + "DICOMDIR", "loaded");
  expect("oriented_rtutils/tests/oriented_data", "loaded");
  expect(tree + "98892001/CT2N", "is a localizer");
  expect(tree + "77654033/CT2", "slices are missing");
  expect(tree + "98892003", "is MR, not CT");
  expect("pydicom_testfiles/rtplan.dcm", "is RTPLAN, not CT");
  expect("pydicom_testfiles/CT_small.dcm", "at least 3 slices");
  expect("enhanced_ct_and_wg04/eCT_Supplemental.dcm", "at least 3 slices");
  expect("lungmask_two_slices", "at least 3 slices");
}

// One slice, decoded as the loader decodes all slices.
std::vector<std::int16_t> decodedFile(const std::string& path) {
  ListeningHost host;
  Helpers helpers({path}, loadOptions().helpers);
  Scan scan = helpers.scan(host);
  const FileHeader& file = scan.files.at(0);
  if (file.damage[0]) throw Error("the file " + std::string(file.damage));
  std::vector<std::int16_t> hu(file.framePixels());
  readPixels(scan, {{0, 0, 0}}, hu.size(), hu.data(), helpers, host);
  return hu;
}

// Largest and mean absolute difference.
std::pair<int, double> difference(const std::vector<std::int16_t>& a, const std::vector<std::int16_t>& b) {
  int largest = 0;
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const int d = std::abs(a[i] - b[i]);
    largest = std::max(largest, d);
    sum += d;
  }
  return {largest, sum / double(a.size())};
}

TEST(TransferSyntaxes, OneSliceInSixteenOfThemHasTheSameValues) {
  const std::string folder = kData + "/dicom/transfer_syntaxes/";
  if (!fs::exists(folder)) GTEST_SKIP() << "PECTORA_DATA has no folder dicom/transfer_syntaxes";
  const auto truth = decodedFile(folder + "CTImage.dcm");
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name.rfind("CTImage.dcm_", 0) != 0) continue;
    ++files;
    const auto hu = decodedFile(entry.path());
    ASSERT_EQ(hu.size(), truth.size()) << name;
    const auto [largest, mean] = difference(hu, truth);
    std::printf("%s: largest %d, mean %.3f\n", name.c_str(), largest, mean);
    const bool isLossy = name.find("4.81") != std::string::npos || name.find("4.91") != std::string::npos || name.find("JPEGProcess1T") != std::string::npos ||
                         name.find("JPEGProcess2") != std::string::npos || name.find("JPEGProcess6") != std::string::npos || name.find("JPEGProcess10") != std::string::npos;
    // The worst is JPEG of 8 bits: 4096 values in 256 steps of 16, and its own loss.
    EXPECT_LE(mean, isLossy ? 20 : 0) << name;
  }
  EXPECT_EQ(files, 15) << "and the sixteenth is the original";
  EXPECT_EQ(decodedFile(folder + "CT0012.fragmented_no_bot_jpeg_baseline.51.dcm").size(), 512u * 512u);
}

TEST(TransferSyntaxes, TheWorkingGroupsSamplesDecodeToTheirUncompressedTruth) {
  const std::string folder = kData + "/dicom/enhanced_ct_and_wg04/";
  if (!fs::exists(folder)) GTEST_SKIP() << "PECTORA_DATA has no folder dicom/enhanced_ct_and_wg04";
  for (const std::string slice : {"CT1", "CT2"}) {
    std::string reference;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().filename().string().rfind(slice + "_UNC", 0) == 0) reference = entry.path();
    ASSERT_FALSE(reference.empty());
    const auto truth = decodedFile(reference);
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const std::string name = entry.path().filename();
      if (name.rfind(slice + "_", 0) != 0 || name.find("UNC") != std::string::npos) continue;
      const auto [largest, mean] = difference(decodedFile(entry.path()), truth);
      std::printf("%s: largest %d, mean %.3f\n", name.c_str(), largest, mean);
      // J2KI and JLSN are the lossy ones.
      if (name.find("J2KI") == std::string::npos && name.find("JLSN") == std::string::npos) {
        EXPECT_EQ(largest, 0) << name;
      }
    }
  }
}

}  // namespace
}  // namespace pectora::dicom
