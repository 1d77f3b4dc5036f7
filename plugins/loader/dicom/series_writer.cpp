#include "plugins/loader/dicom/series_writer.h"

#include "plugins/loader/dicom/header.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <fmt/format.h>
#include <gdcmFileMetaInformation.h>
#include <gdcmImage.h>
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmTrace.h>
#include <gdcmWriter.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <random>
#include <sstream>

namespace pectora::dicom {
namespace {

constexpr int kIntercept = -1024, kHighest = 3071;

struct StorageKind {
  const char* name;
  gdcm::TransferSyntax::TSType syntax;
  bool isCompressed;
};
const StorageKind kKinds[] = {{"implicit_le", gdcm::TransferSyntax::ImplicitVRLittleEndian, false},
                              {"explicit_le", gdcm::TransferSyntax::ExplicitVRLittleEndian, false},
                              {"explicit_be", gdcm::TransferSyntax::ExplicitVRBigEndian, false},
                              {"deflated", gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian, false},
                              {"rle", gdcm::TransferSyntax::RLELossless, true},
                              {"jpeg_lossless", gdcm::TransferSyntax::JPEGLosslessProcess14_1, true},
                              {"jpeg_ls", gdcm::TransferSyntax::JPEGLSLossless, true},
                              {"jpeg_2000", gdcm::TransferSyntax::JPEG2000Lossless, true}};

// A UID below the root for numbers from UUIDs, made of a hash.
std::string uidOf(const std::string& seed, const std::string& what) {
  return fmt::format("2.25.{}", hashUid(seed + "/" + what));
}

// A decimal string of at most 16 characters, as near as that allows.
std::string decimal(double value) {
  for (int digits = 15; digits > 0; --digits) {
    const std::string text = fmt::format("{:.{}g}", value, digits);
    if (text.size() <= 16) return text;
  }
  return "0";
}
std::string decimals(std::initializer_list<double> values) {
  std::string text;
  for (const double v : values) text += (text.empty() ? "" : "\\") + decimal(v);
  return text;
}

class Elements {
 public:
  explicit Elements(gdcm::DataSet& set) : set_(set) {}
  void text(gdcm::Tag tag, gdcm::VR::VRType vr, std::string value) {
    if (value.size() % 2 != 0) value += vr == gdcm::VR::UI ? '\0' : ' ';
    put(tag, vr, value.data(), value.size());
  }
  void number(gdcm::Tag tag, gdcm::VR::VRType vr, int value) {
    // GDCM swaps words to the file's byte order itself.
    const auto word = std::uint16_t(value);
    put(tag, vr, reinterpret_cast<const char*>(&word), 2);
  }

 private:
  void put(gdcm::Tag tag, gdcm::VR::VRType vr, const char* bytes, std::size_t size) {
    gdcm::DataElement element(tag);
    element.SetVR(vr);
    element.SetByteValue(bytes, std::uint32_t(size));
    set_.Replace(element);
  }
  gdcm::DataSet& set_;
};

// Stored values of one slice.
std::vector<std::uint16_t> storedPixels(const Volume& volume, int k, const WriteOptions& options) {
  const std::size_t count = volume.grid.sliceVoxels();
  const std::int16_t* hu = volume.hu.data() + std::size_t(k) * count;
  std::vector<std::uint16_t> stored(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (options.isTwelveBit && (hu[i] < kIntercept || hu[i] > kHighest))
      throw Error("a value does not fit into 12 bits").given(fmt::format("{} HU", hu[i])).allowed(fmt::format("{} to {} HU", kIntercept, kHighest));
    stored[i] = std::uint16_t(options.isTwelveBit ? hu[i] - kIntercept : hu[i]);
  }
  return stored;
}

gdcm::DataElement pixelElement(const std::vector<std::uint16_t>& stored) {
  gdcm::DataElement element(gdcm::Tag(0x7fe0, 0x0010));
  element.SetVR(gdcm::VR::OW);
  element.SetByteValue(reinterpret_cast<const char*>(stored.data()), std::uint32_t(stored.size() * sizeof(stored[0])));
  return element;
}

gdcm::DataElement compressed(const gdcm::DataElement& raw, const Grid& grid, const WriteOptions& options) {
  // Counted by reference, so it must not live on the stack.
  const gdcm::SmartPointer<gdcm::Image> image = new gdcm::Image;
  image->SetNumberOfDimensions(2);
  const unsigned size[2] = {unsigned(grid.size[0]), unsigned(grid.size[1])};
  image->SetDimensions(size);
  gdcm::PixelFormat format(options.isTwelveBit ? gdcm::PixelFormat::UINT16 : gdcm::PixelFormat::INT16);
  if (options.isTwelveBit) format.SetBitsStored(12);
  image->SetPixelFormat(format);
  image->SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  image->SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
  image->SetDataElement(raw);
  gdcm::ImageChangeTransferSyntax change;
  change.SetTransferSyntax(kKinds[int(options.storage)].syntax);
  change.SetInput(*image);
  if (!change.Change()) throw Error("a slice cannot be compressed", ErrorKind::runFailed).given(kKinds[int(options.storage)].name);
  return change.GetOutput().GetDataElement();
}

void writeSlice(const Volume& volume, int k, int number, const std::string& path, const WriteOptions& options) {
  using VR = gdcm::VR;
  const Grid& g = volume.grid;
  const StorageKind& kind = kKinds[int(options.storage)];
  gdcm::Writer writer;
  writer.CheckFileMetaInformationOff();
  gdcm::DataSet& set = writer.GetFile().GetDataSet();
  Elements put(set);
  const std::string instance = uidOf(options.seed, fmt::format("slice {}", k));
  const char* objectClass = options.modality == "MR" ? "1.2.840.10008.5.1.4.1.1.4" : "1.2.840.10008.5.1.4.1.1.2";
  const Vec3 position = g.toPatient({0, 0, double(k)});

  put.text({0x0008, 0x0005}, VR::CS, "ISO_IR 100");
  put.text({0x0008, 0x0008}, VR::CS, "ORIGINAL\\PRIMARY\\AXIAL");
  put.text({0x0008, 0x0016}, VR::UI, objectClass);
  put.text({0x0008, 0x0018}, VR::UI, instance);
  put.text({0x0008, 0x0020}, VR::DA, "20000101");
  put.text({0x0008, 0x0030}, VR::TM, "000000");
  put.text({0x0008, 0x0050}, VR::SH, "");
  put.text({0x0008, 0x0060}, VR::CS, options.modality);
  put.text({0x0008, 0x0070}, VR::LO, "Pectora");
  put.text({0x0008, 0x0090}, VR::PN, "");
  put.text({0x0010, 0x0010}, VR::PN, "PHANTOM");
  put.text({0x0010, 0x0020}, VR::LO, "PHANTOM");
  put.text({0x0010, 0x0030}, VR::DA, "");
  put.text({0x0010, 0x0040}, VR::CS, "");
  put.text({0x0018, 0x0050}, VR::DS, decimal(g.spacing.z));
  put.text({0x0018, 0x0060}, VR::DS, "");
  put.text({0x0018, 0x5100}, VR::CS, "HFS");
  put.text({0x0020, 0x000d}, VR::UI, uidOf(options.seed, "study"));
  put.text({0x0020, 0x000e}, VR::UI, uidOf(options.seed, "series"));
  put.text({0x0020, 0x0010}, VR::SH, "1");
  put.text({0x0020, 0x0011}, VR::IS, "1");
  put.text({0x0020, 0x0012}, VR::IS, "1");
  put.text({0x0020, 0x0013}, VR::IS, std::to_string(number));
  put.text({0x0020, 0x0032}, VR::DS, decimals({position.x, position.y, position.z}));
  put.text({0x0020, 0x0037}, VR::DS, decimals({g.axes[0].x, g.axes[0].y, g.axes[0].z, g.axes[1].x, g.axes[1].y, g.axes[1].z}));
  put.text({0x0020, 0x0052}, VR::UI, uidOf(options.seed, "frame of reference"));
  put.text({0x0020, 0x1040}, VR::LO, "");
  put.number({0x0028, 0x0002}, VR::US, 1);
  put.text({0x0028, 0x0004}, VR::CS, "MONOCHROME2");
  put.number({0x0028, 0x0010}, VR::US, g.size[1]);
  put.number({0x0028, 0x0011}, VR::US, g.size[0]);
  put.text({0x0028, 0x0030}, VR::DS, decimals({g.spacing.y, g.spacing.x}));
  put.number({0x0028, 0x0100}, VR::US, 16);
  put.number({0x0028, 0x0101}, VR::US, options.isTwelveBit ? 12 : 16);
  put.number({0x0028, 0x0102}, VR::US, options.isTwelveBit ? 11 : 15);
  put.number({0x0028, 0x0103}, VR::US, options.isTwelveBit ? 0 : 1);
  put.text({0x0028, 0x1052}, VR::DS, options.isTwelveBit ? std::to_string(kIntercept) : "0");
  put.text({0x0028, 0x1053}, VR::DS, "1");
  put.text({0x0028, 0x1054}, VR::LO, "HU");
  const gdcm::DataElement raw = pixelElement(storedPixels(volume, k, options));
  set.Replace(kind.isCompressed ? compressed(raw, g, options) : raw);

  gdcm::FileMetaInformation& meta = writer.GetFile().GetHeader();
  Elements metaPut(meta);
  const char version[2] = {0, 1};
  gdcm::DataElement versionElement(gdcm::Tag(0x0002, 0x0001));
  versionElement.SetVR(VR::OB);
  versionElement.SetByteValue(version, 2);
  meta.Replace(versionElement);
  metaPut.text({0x0002, 0x0002}, VR::UI, objectClass);
  metaPut.text({0x0002, 0x0003}, VR::UI, instance);
  metaPut.text({0x0002, 0x0010}, VR::UI, gdcm::TransferSyntax::GetTSString(kind.syntax));
  metaPut.text({0x0002, 0x0012}, VR::UI, "2.25.80101116111114097");
  metaPut.text({0x0002, 0x0013}, VR::SH, "PECTORA");
  meta.SetDataSetTransferSyntax(kind.syntax);
  // By way of memory, because GDCM does not notice a full disk.
  std::ostringstream bytes;
  writer.SetStream(bytes);
  const bool isMade = writer.Write();
  std::ofstream file(path, std::ios::binary);
  const std::string_view all = bytes.view();
  file.write(all.data(), std::streamsize(all.size()));
  file.close();
  if (!isMade || !file) throw Error("a slice cannot be written", ErrorKind::runFailed).at(path).advise("Is the disk full?");
}

}  // namespace

const std::vector<std::string>& storageNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const StorageKind& kind : kKinds) all.emplace_back(kind.name);
    return all;
  }();
  return names;
}

Storage storageOf(const std::string& name) {
  const auto& names = storageNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw Error("there is no such way to store pixels").given(name);
  return Storage(found - names.begin());
}

std::vector<std::string> writeSeries(const Volume& volume, const std::string& folder, const WriteOptions& options,
                                     const std::function<void()>& cancelled) {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  const int slices = volume.grid.size[2];
  std::vector<int> numbers(static_cast<std::size_t>(slices));
  std::iota(numbers.begin(), numbers.end(), 1);
  if (options.shufflesNumbers) {
    std::mt19937 random(std::uint32_t(hashUid(options.seed)));
    for (std::size_t i = numbers.size(); i > 1; --i) std::swap(numbers[i - 1], numbers[random() % i]);
  }
  std::vector<std::string> names;
  for (const int number : numbers) names.push_back(fmt::format("{:05}.dcm", number));
  const auto write = [&](int k) {
    cancelled();
    writeSlice(volume, k, numbers[std::size_t(k)], folder + "/" + names[std::size_t(k)], options);
  };
  // The first slice alone, for it sets up what GDCM shares between threads.
  if (slices > 0) write(0);
  if (slices > 1) parallelFor(std::size_t(slices - 1), [&](std::size_t k) { write(int(k) + 1); });
  return names;
}

}  // namespace pectora::dicom
