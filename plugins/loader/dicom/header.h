// What the loader knows of DICOM files: plain data without anything of the patient. The helper program writes it into
// shared memory, so it must stay trivially copyable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pectora::dicom {

enum class FileKind : std::uint8_t {
  unread,      ///< not looked at yet
  foreign,     ///< text, a picture, an archive: clearly something else
  unreadable,  ///< neither DICOM that can be read nor anything known: perhaps a damaged slice
  noImage,     ///< DICOM without pixels: a plan, a report, a directory
  image,
};

/// One file. UIDs leave the helper program only as hashes.
struct FileHeader {
  FileKind kind = FileKind::unread;
  char damage[120] = {};            ///< what is wrong with the file, as the end of "the file ..."; "" if nothing is
  std::uint64_t series = 0;         ///< hashUid of the SeriesInstanceUID; 0 if it has none
  std::uint64_t frameOfReference = 0;
  char modality[20] = {};           ///< "CT"; "" if the file does not say
  char sopClass[68] = {};           ///< UID of the kind of object
  char transferSyntax[68] = {};     ///< UID of how the pixels are stored
  bool isLocalizer = false;
  int rows = 0, columns = 0, frames = 0;
  int samples = 1;                  ///< per pixel
  int bitsAllocated = 0, bitsStored = 0, highBit = 0;
  bool isSigned = false;
  bool isRaw = false;               ///< pixels stand uncompressed in the file: at `offset`
  bool isBigEndian = false;         ///< raw pixels only
  std::uint64_t offset = 0;         ///< of the first pixel, raw pixels only
  bool hasPadding = false;
  int padding = 0;                  ///< stored value of pixels outside of the reconstruction
  double gantryTilt = 0;            ///< degrees, as the scanner noted it
  std::uint32_t firstFrame = 0;     ///< number of its first FrameHeader

  std::size_t framePixels() const { return std::size_t(rows) * std::size_t(columns); }
};

/// One slice: a file has one, or many if it is a multi-frame file.
struct FrameHeader {
  double orientation[6] = {};       ///< unit vectors along a row and down a column, LPS
  double position[3] = {};          ///< centre of the first pixel, LPS mm
  double rowSpacing = 0;            ///< mm between rows
  double columnSpacing = 0;         ///< mm between columns
  double slope = 1, intercept = 0;  ///< stored value to Hounsfield units
  bool hasOrientation = false, hasPosition = false, hasSpacing = false, hasRescale = false;
};

/// The headers of a set of files.
struct Scan {
  std::vector<std::string> paths;
  std::vector<FileHeader> files;    ///< one a path
  std::vector<FrameHeader> frames;  ///< of all files: see FileHeader::firstFrame

  /// The file's name without its folder: what messages show.
  std::string name(std::size_t file) const {
    const std::size_t slash = paths[file].rfind('/');
    return slash == std::string::npos ? paths[file] : paths[file].substr(slash + 1);
  }
};

/// FNV-1a of a UID; never 0.
constexpr std::uint64_t hashUid(std::string_view uid) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : uid) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash ? hash : 1;
}

}  // namespace pectora::dicom
