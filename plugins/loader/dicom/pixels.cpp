#include "plugins/loader/dicom/pixels.h"

#include "plugins/loader/dicom/hounsfield.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <algorithm>
#include <atomic>
#include <fcntl.h>
#include <unistd.h>

namespace pectora::dicom {
namespace {

bool readAll(int descriptor, void* to, std::size_t bytes, std::uint64_t offset) {
  auto* at = static_cast<char*>(to);
  while (bytes > 0) {
    const ssize_t got = pread(descriptor, at, bytes, off_t(offset));
    if (got <= 0) return false;
    at += got, offset += std::uint64_t(got), bytes -= std::size_t(got);
  }
  return true;
}

void readRaw(const Scan& scan, const FrameTarget& target, std::size_t slicePixels, std::int16_t* to) {
  const FileHeader& file = scan.files[target.file];
  const FrameHeader& frame = scan.frames[file.firstFrame + std::uint32_t(target.frame)];
  const PixelCode code{.bitsAllocated = file.bitsAllocated, .bitsStored = file.bitsStored, .highBit = file.highBit,
                       .isSigned = file.isSigned, .isBigEndian = file.isBigEndian, .slope = frame.slope, .intercept = frame.intercept};
  const std::size_t bytes = slicePixels * std::size_t(file.bitsAllocated / 8);
  const int descriptor = open(scan.paths[target.file].c_str(), O_RDONLY | O_CLOEXEC);
  // Words of 16 bits are converted where they arrive; bytes need a place of their own.
  std::vector<unsigned char> narrow(file.bitsAllocated == 8 ? bytes : 0);
  void* place = narrow.empty() ? static_cast<void*>(to) : narrow.data();
  const bool isRead = descriptor >= 0 && readAll(descriptor, place, bytes, file.offset + std::uint64_t(target.frame) * bytes);
  if (descriptor >= 0) close(descriptor);
  if (!isRead) throw Error("the file changed while it was read").at(scan.name(target.file)).advise("Load it again when nothing writes to it");
  toHounsfield(code, place, slicePixels, to);
}

}  // namespace

void readPixels(const Scan& scan, const std::vector<FrameTarget>& targets, std::size_t slicePixels, std::int16_t* to,
                Helpers& helpers, Host& host) {
  std::vector<FrameTarget> raw, compressed;
  for (const FrameTarget& target : targets) (scan.files[target.file].isRaw ? raw : compressed).push_back(target);
  if (!compressed.empty()) helpers.decode(compressed, slicePixels, to, host);
  std::atomic<std::size_t> done{0};
  parallelFor(raw.size(), [&](std::size_t i) {
    host.checkCancel();
    readRaw(scan, raw[i], slicePixels, to + raw[i].slice * slicePixels);
    host.progress(0.2 + 0.7 * double(++done) / double(raw.size()), "reading slices");
  });
}

}  // namespace pectora::dicom
