#include "plugins/loader/dicom/worker/read_header.h"

#include "plugins/loader/dicom/encapsulated.h"
#include "plugins/loader/dicom/shared_layout.h"
#include "plugins/loader/dicom/worker/data_set.h"
#include "plugins/loader/dicom/worker/mapped_file.h"

#include <gdcmReader.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <set>
#include <string_view>

namespace pectora::dicom {
namespace {

const gdcm::Tag kPixelData(0x7fe0, 0x0010);
// Classes of CT images begin so: plain, enhanced, converted.
constexpr std::string_view kCtClass = "1.2.840.10008.5.1.4.1.1.2";

template <std::size_t N>
void copyText(char (&to)[N], const std::string& from) {
  std::snprintf(to, N, "%s", from.c_str());
}

// Text and the commonest other files.
bool isForeign(const MappedFile& file) {
  const std::size_t head = std::min<std::size_t>(file.size(), 512);
  if (head == 0) return false;
  const auto begins = [&](std::string_view magic) {
    return head >= magic.size() && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
  };
  for (const std::string_view magic : {std::string_view("\x89PNG"), std::string_view("\xFF\xD8\xFF"), std::string_view("%PDF"),
                                       std::string_view("PK\x03\x04"), std::string_view("GIF8"), std::string_view("BM"),
                                       std::string_view("\x1F\x8B"), std::string_view("MZ"), std::string_view("\x7F" "ELF")})
    if (begins(magic)) return true;
  return std::all_of(file.data(), file.data() + head, [](unsigned char c) { return c >= 32 || (c >= 9 && c <= 13); });
}

bool hasPreamble(const MappedFile& file) {
  return file.size() >= 132 && std::memcmp(file.data() + 128, "DICM", 4) == 0;
}

// The index of a disc: its class stands in the first elements. GDCM aborts on some, and there is nothing in it to read.
bool isDirectory(const MappedFile& file) {
  const std::string_view head(reinterpret_cast<const char*>(file.data()), std::min<std::size_t>(file.size(), 400));
  constexpr std::string_view kClass = "1.2.840.10008.1.3.10";
  const std::size_t at = head.find(kClass);
  if (!hasPreamble(file) || at == std::string_view::npos || at + kClass.size() >= head.size()) return false;
  const char next = head[at + kClass.size()];
  return next != '.' && (next < '0' || next > '9');
}

// Position, orientation, spacing and rescaling where they stand in a data set itself.
void readPlain(const gdcm::DataSet& set, FrameHeader& frame) {
  if (const auto v = numbersOf(set, {0x0020, 0x0032}); v.size() == 3) {
    std::copy(v.begin(), v.end(), frame.position);
    frame.hasPosition = true;
  }
  if (const auto v = numbersOf(set, {0x0020, 0x0037}); v.size() == 6) {
    std::copy(v.begin(), v.end(), frame.orientation);
    frame.hasOrientation = true;
  }
  if (const auto v = numbersOf(set, {0x0028, 0x0030}); v.size() == 2) {
    frame.rowSpacing = v[0], frame.columnSpacing = v[1];
    frame.hasSpacing = true;
  }
  const auto intercept = numbersOf(set, {0x0028, 0x1052}), slope = numbersOf(set, {0x0028, 0x1053});
  if (intercept.size() == 1 && slope.size() == 1) {
    frame.intercept = intercept[0], frame.slope = slope[0];
    frame.hasRescale = true;
  }
}

// The same within the functional groups of one item of an enhanced file.
void readGroups(const gdcm::DataSet& item, FrameHeader& frame) {
  constexpr std::uint16_t kGroups[][2] = {{0x0020, 0x9113}, {0x0020, 0x9116}, {0x0028, 0x9110}, {0x0028, 0x9145}};
  for (const auto& tag : kGroups) {
    gdcm::SmartPointer<gdcm::SequenceOfItems> holder;
    if (const gdcm::DataSet* group = firstItem(item, {tag[0], tag[1]}, holder)) readPlain(*group, frame);
  }
}

void readFrames(const gdcm::DataSet& set, FileHeader& header, std::vector<FrameHeader>& frames) {
  FrameHeader shared;
  readPlain(set, shared);
  gdcm::SmartPointer<gdcm::SequenceOfItems> holder;
  if (const gdcm::DataSet* item = firstItem(set, {0x5200, 0x9229}, holder)) readGroups(*item, shared);
  frames.assign(std::size_t(header.frames), shared);
  const auto perFrame = sequenceOf(set, {0x5200, 0x9230});
  if (!perFrame) return;
  if (perFrame->GetNumberOfItems() != frames.size()) {
    copyText(header.damage, "does not say where each of its frames lies");
    return;
  }
  for (std::size_t i = 0; i < frames.size(); ++i) readGroups(perFrame->GetItem(i + 1).GetNestedDataSet(), frames[i]);
}

// Where the pixels are and whether they are all there. `offset` is where the value of the pixel element begins.
void checkPixels(const MappedFile& file, std::size_t offset, FileHeader& header) {
  const std::string syntax = header.transferSyntax;
  if (syntax == "1.2.840.10008.1.2.1.99") return;   // deflated: the positions are not the file's
  if (offset < 12 || offset > file.size()) return copyText(header.damage, "ends before its pixels");
  // The element's tag stands 8 bytes before its value in implicit files, 12 in explicit ones; its length just before.
  const bool isBig = syntax == "1.2.840.10008.1.2.2";
  const bool isImplicit = syntax == "1.2.840.10008.1.2";
  const unsigned char* tag = file.data() + offset - (isImplicit ? 8 : 12);
  const unsigned char little[4] = {0xE0, 0x7F, 0x10, 0x00}, big[4] = {0x7F, 0xE0, 0x00, 0x10};
  if (std::memcmp(tag, isBig ? big : little, 4) != 0) return;
  const unsigned char* l = file.data() + offset - 4;
  const std::uint64_t length = isBig ? std::uint64_t(l[0]) << 24 | l[1] << 16 | l[2] << 8 | l[3]
                                     : std::uint64_t(l[3]) << 24 | l[2] << 16 | l[1] << 8 | l[0];
  const bool isUncompressed = isBig || isImplicit || syntax == "1.2.840.10008.1.2.1";
  if (length == 0xFFFFFFFFu) {
    if (isUncompressed) return copyText(header.damage, "has compressed pixels but says that they are not");
    const bool isJpeg = syntax.rfind("1.2.840.10008.1.2.4.", 0) == 0;
    return copyText(header.damage, checkFragments(file.data(), file.size(), offset, isJpeg));
  }
  if (!isUncompressed && syntax.rfind("1.2.840.10008.", 0) == 0)
    return copyText(header.damage, "has uncompressed pixels but says that they are compressed");
  const std::uint64_t needed = std::uint64_t(header.framePixels()) * header.frames * header.samples * header.bitsAllocated / 8;
  if (length < needed) return copyText(header.damage, "has fewer pixels than its rows and columns need");
  if (offset + length > file.size()) return copyText(header.damage, "is truncated within its pixels");
  if (length > needed + 1) return copyText(header.damage, "has more pixels than its rows and columns need");
  header.isRaw = isUncompressed && header.samples == 1 && (header.bitsAllocated == 8 || header.bitsAllocated == 16);
  header.isBigEndian = isBig;
  header.offset = offset;
}

void readImage(const gdcm::DataSet& set, FileHeader& header) {
  header.rows = shortOf(set, {0x0028, 0x0010}).value_or(0);
  header.columns = shortOf(set, {0x0028, 0x0011}).value_or(0);
  header.samples = shortOf(set, {0x0028, 0x0002}).value_or(1);
  header.bitsAllocated = shortOf(set, {0x0028, 0x0100}).value_or(0);
  header.bitsStored = shortOf(set, {0x0028, 0x0101}).value_or(header.bitsAllocated);
  header.highBit = shortOf(set, {0x0028, 0x0102}).value_or(header.bitsStored - 1);
  header.isSigned = shortOf(set, {0x0028, 0x0103}).value_or(0) == 1;
  header.frames = 1;
  if (const auto v = numbersOf(set, {0x0028, 0x0008}); v.size() == 1)
    header.frames = v[0] >= 1 && v[0] <= kMostFrames ? int(v[0]) : 0;
  if (const auto padding = shortOf(set, {0x0028, 0x0120}, header.isSigned)) {
    header.hasPadding = true;
    header.padding = *padding;
  }
  if (const auto v = numbersOf(set, {0x0018, 0x1120}); v.size() == 1) header.gantryTilt = v[0];
  const std::string type = textOf(set, {0x0008, 0x0008});
  header.isLocalizer = type.find("LOCALIZER") != std::string::npos || type.find("SCOUT") != std::string::npos;
}

}  // namespace

FileHeader readHeader(const char* path, std::vector<FrameHeader>& frames) {
  FileHeader header;
  header.kind = FileKind::unreadable;
  frames.clear();
  const MappedFile file(path);
  if (!file.isOpen() || file.size() == 0) {
    copyText(header.damage, file.isOpen() ? "is empty" : "cannot be opened");
    return header;
  }
  const bool isDicom = hasPreamble(file);
  if (!isDicom && isForeign(file)) {
    header.kind = FileKind::foreign;
    return header;
  }
  if (isDirectory(file)) {
    header.kind = FileKind::noImage;
    return header;
  }
  copyText(header.damage, isDicom ? "has a header that cannot be read" : "is not readable as DICOM");
  gdcm::Reader reader;
  std::size_t offset = 0;
  try {
    MappedStream stream(file);
    reader.SetStream(stream);
    if (!reader.ReadUpToTag(kPixelData, {kPixelData})) return header;
    const auto position = stream.tellg();
    if (position > 0) offset = std::size_t(position);
  } catch (const std::exception&) {
    return header;
  }
  const gdcm::DataSet& set = reader.GetFile().GetDataSet();
  copyText(header.sopClass, textOf(set, {0x0008, 0x0016}));
  const std::string modality = textOf(set, {0x0008, 0x0060}), series = textOf(set, {0x0020, 0x000e});
  // GDCM reads many a file as an almost empty data set.
  const bool hasImage = set.FindDataElement(gdcm::Tag(0x0028, 0x0010)) || set.FindDataElement(gdcm::Tag(0x0028, 0x0011));
  if (!hasImage && modality.empty() && !header.sopClass[0]) {
    copyText(header.damage, "neither holds an image nor says what it is");
    return header;
  }

  // A header that breaks off may lose the series too; with a series, it is told apart from the others.
  const std::string_view objectClass = header.sopClass;
  if (!hasImage && series.empty() && (objectClass == kCtClass || objectClass.substr(0, kCtClass.size() + 1) == std::string(kCtClass) + ".")) {
    copyText(header.damage, "says that it is a CT image but has no rows and columns");
    return header;
  }
  header.damage[0] = 0;
  copyText(header.modality, modality);
  header.series = series.empty() ? 0 : hashUid(series);
  const std::string reference = textOf(set, {0x0020, 0x0052});
  header.frameOfReference = reference.empty() ? 0 : hashUid(reference);
  const char* syntax = gdcm::TransferSyntax::GetTSString(reader.GetFile().GetHeader().GetDataSetTransferSyntax());
  copyText(header.transferSyntax, syntax ? syntax : "");
  if (!hasImage) {
    header.kind = FileKind::noImage;
    return header;
  }
  header.kind = FileKind::image;
  readImage(set, header);
  if (header.rows < 1 || header.columns < 1 || header.frames < 1 || header.bitsAllocated < 1 || header.samples < 1 ||
      header.framePixels() * std::uint64_t(header.frames) > kMostPixelBytes / 2) {
    copyText(header.damage, "has impossible rows, columns or bits");
    header.frames = 1;
  }
  readFrames(set, header, frames);
  if (!header.damage[0]) checkPixels(file, offset, header);
  return header;
}

}  // namespace pectora::dicom
