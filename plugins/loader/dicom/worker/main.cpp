// pectora-dicom: reads DICOM headers and pixels for loader.dicom, in a process of its own because GDCM aborts on some
// damaged files. It is started by the loader only; see shared_layout.h for how they talk.
#include "plugins/loader/dicom/shared_layout.h"
#include "plugins/loader/dicom/worker/decode.h"
#include "plugins/loader/dicom/worker/read_header.h"

#include <gdcmTrace.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {
using namespace pectora::dicom;

void* mapShared(int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || status.st_size == 0) return nullptr;
  void* memory = mmap(nullptr, std::size_t(status.st_size), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  return memory == MAP_FAILED ? nullptr : memory;
}

// A damaged length makes GDCM ask for gigabytes, and clear them, before it sees that the file is short. So a file gets
// memory in proportion to what is in it. (Sanitizers need more than any limit.)
void limitMemory([[maybe_unused]] const char* path, [[maybe_unused]] std::uint64_t pixelBytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  struct stat status {};
  const std::uint64_t fileBytes = stat(path, &status) == 0 ? std::uint64_t(status.st_size) : 0;
  const rlimit limit{(std::uint64_t(128) << 20) + 4 * (fileBytes + pixelBytes), RLIM_INFINITY};
  setrlimit(RLIMIT_DATA, &limit);
#endif
}

void scanFile(Board& board, std::uint32_t number, const char* path) {
  limitMemory(path, 0);
  std::vector<FrameHeader> frames;
  FileHeader header = readHeader(path, frames);
  const std::uint32_t first = board.framesUsed.fetch_add(std::uint32_t(frames.size()));
  if (first + frames.size() > kMostFrames) {
    std::snprintf(header.damage, sizeof header.damage, "is one of too many: a series has at most %u slices", kMostFrames);
    frames.clear();
    header.frames = 0;
  }
  header.firstFrame = first;
  for (std::size_t i = 0; i < frames.size(); ++i) board.frame(first + i).header = frames[i];
  board.file(number) = header;
}

void decodeOne(Board& board, std::int16_t* slices, std::uint32_t number, const char* path) {
  FileHeader& header = board.file(number);
  std::vector<FrameHeader> frames;
  std::vector<std::int16_t*> targets;
  bool isWanted = false;
  for (int i = 0; i < header.frames; ++i) {
    const Board::Frame& frame = board.frame(header.firstFrame + std::uint32_t(i));
    frames.push_back(frame.header);
    targets.push_back(frame.target < 0 ? nullptr : slices + std::size_t(frame.target) * board.slicePixels);
    isWanted = isWanted || frame.target >= 0;
  }
  if (!isWanted) return;
  limitMemory(path, 2 * header.framePixels() * std::uint64_t(header.frames));
  std::string damage;
  try {
    damage = decodeFile(path, header, frames, targets);
  } catch (const std::exception&) {
    damage = "has pixels that cannot be decoded";
  }
  std::snprintf(header.damage, sizeof header.damage, "%s", damage.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  // The loader decides when to stop; without it there is nothing to do. No core files: they would hold the patient.
  std::signal(SIGINT, SIG_IGN);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  prctl(PR_SET_DUMPABLE, 0);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  auto* board = argc == 2 ? static_cast<Board*>(mapShared(kBoardDescriptor)) : nullptr;
  if (!board) {
    std::fputs("pectora-dicom is a part of loader.dicom and is started by it.\n", stderr);
    return 2;
  }
  const int self = std::atoi(argv[1]);
  if (self < 0 || self >= kMostWorkers) return 2;
  gdcm::Trace::DebugOff();
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();

  std::vector<const char*> paths;
  const char* path = board->at<const char>(board->pathsAt);
  for (std::uint32_t i = 0; i < board->fileCount; ++i, path += std::strlen(path) + 1) paths.push_back(path);

  std::int16_t* slices = nullptr;
  char command = 0;
  while (read(STDIN_FILENO, &command, 1) == 1) {
    if (command == kDecodeCommand && !slices) slices = static_cast<std::int16_t*>(mapShared(kSlicesDescriptor));
    if (command == kDecodeCommand && !slices) return 3;
    for (std::uint32_t i; (i = board->nextFile.fetch_add(1)) < board->fileCount;) {
      board->current[self] = std::int32_t(i);
      if (command == kScanCommand)
        scanFile(*board, i, paths[i]);
      else
        decodeOne(*board, slices, i, paths[i]);
      board->finished.fetch_add(1);
    }
    board->current[self] = -1;
    if (write(STDOUT_FILENO, &command, 1) != 1) return 0;
  }
  return 0;
}
