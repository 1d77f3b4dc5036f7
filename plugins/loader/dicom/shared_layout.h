// The memory that the loader and its helper programs share.
//
// Descriptor 3 is the board: a Board, then the FileHeaders, then room for FrameHeaders, then the paths, each with a
// zero behind it. Descriptor 4 holds decoded slices. The loader writes a command byte to a helper's standard input; the
// helper does its part of the files and answers with the same byte.
#pragma once

#include "plugins/loader/dicom/header.h"

#include <atomic>

namespace pectora::dicom {

inline constexpr int kBoardDescriptor = 3, kSlicesDescriptor = 4;
inline constexpr int kMostWorkers = 8;
inline constexpr std::uint32_t kMostFrames = 1u << 19;
inline constexpr char kScanCommand = 'S', kDecodeCommand = 'D';
/// Largest number of bytes of one file's decoded pixels.
inline constexpr std::uint64_t kMostPixelBytes = std::uint64_t(4) << 30;

struct Board {
  std::uint32_t fileCount = 0;
  std::uint64_t filesAt = 0, framesAt = 0, pathsAt = 0, bytes = 0;
  std::uint64_t slicePixels = 0;                       ///< of every decoded slice
  std::atomic<std::uint32_t> nextFile{0};              ///< the next file that nobody has taken
  std::atomic<std::uint32_t> framesUsed{0};
  std::atomic<std::uint32_t> finished{0};              ///< files done, for the progress bar
  std::atomic<std::int32_t> current[kMostWorkers]{};   ///< the file that each helper is at, -1 if none

  template <class T>
  T* at(std::uint64_t offset) {
    return reinterpret_cast<T*>(reinterpret_cast<char*>(this) + offset);
  }
  FileHeader& file(std::size_t i) { return at<FileHeader>(filesAt)[i]; }
  /// A frame of the board: its header, and where its pixels go among the decoded slices (-1: nowhere).
  struct Frame {
    FrameHeader header;
    std::int32_t target = -1;
  };
  Frame& frame(std::size_t i) { return at<Frame>(framesAt)[i]; }
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace pectora::dicom
