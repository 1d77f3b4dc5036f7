#include "plugins/loader/dicom/helpers.h"

#include "plugins/loader/dicom/shared_layout.h"

#include "kernel/stage/error.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <new>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pectora::dicom {
namespace {

using Clock = std::chrono::steady_clock;

/// A descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  void reset() {
    if (number_ >= 0) close(number_);
    number_ = -1;
  }
  int get() const { return number_; }

 private:
  int number_;
};

/// Anonymous memory that helper programs can map, gone with the last of its users.
class SharedMemory {
 public:
  explicit SharedMemory(const char* name) : descriptor_(memfd_create(name, MFD_CLOEXEC)) {
    if (descriptor_.get() < 0) throw Error("no shared memory can be made", ErrorKind::runFailed);
  }
  ~SharedMemory() {
    if (memory_) munmap(memory_, bytes_);
  }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  void* resize(std::size_t bytes) {
    if (memory_) munmap(memory_, bytes_);
    memory_ = nullptr, bytes_ = bytes;
    if (ftruncate(descriptor_.get(), off_t(bytes)) != 0) throw Error("there is not enough shared memory", ErrorKind::runFailed);
    void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_.get(), 0);
    if (memory == MAP_FAILED) throw Error("there is not enough shared memory", ErrorKind::runFailed);
    return memory_ = memory;
  }
  int descriptor() const { return descriptor_.get(); }

 private:
  Descriptor descriptor_;
  void* memory_ = nullptr;
  std::size_t bytes_ = 0;
};

struct Helper {
  pid_t process = -1;
  Descriptor line;            ///< commands go there, answers come from there
  bool isBusy = false;
  std::int32_t file = -1;     ///< the file that it was last seen at
  Clock::time_point since;    ///< since when
};

std::string copyAgain() { return "Copy the series again from its source, or take this file out"; }

}  // namespace

struct Helpers::State {
  Options options;
  Scan scan;
  SharedMemory boardMemory{"pectora-dicom-board"}, sliceMemory{"pectora-dicom-slices"};
  Board* board = nullptr;
  std::vector<Helper> helpers;

  ~State() {
    for (const Helper& helper : helpers)
      if (helper.process > 0) kill(helper.process, SIGKILL);
    for (const Helper& helper : helpers)
      if (helper.process > 0) waitpid(helper.process, nullptr, 0);
  }
};

Helpers::Helpers(std::vector<std::string> paths, const Options& options) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.options = options;
  s.scan.paths = std::move(paths);
  // Pages that nobody writes to cost nothing, so there is room for as many frames as anyone has.
  const std::size_t count = s.scan.paths.size();
  const auto aligned = [](std::size_t bytes) { return (bytes + 63) / 64 * 64; };
  const std::size_t filesAt = aligned(sizeof(Board)), framesAt = filesAt + aligned(count * sizeof(FileHeader)),
                    pathsAt = framesAt + kMostFrames * sizeof(Board::Frame);
  std::size_t bytes = pathsAt;
  for (const std::string& path : s.scan.paths) bytes += path.size() + 1;
  s.board = new (s.boardMemory.resize(bytes)) Board;
  s.board->fileCount = std::uint32_t(count);
  s.board->filesAt = filesAt, s.board->framesAt = framesAt, s.board->pathsAt = pathsAt, s.board->bytes = bytes;
  char* to = s.board->at<char>(pathsAt);
  for (const std::string& path : s.scan.paths) to = std::strcpy(to, path.c_str()) + path.size() + 1;
  start();
}

Helpers::~Helpers() = default;

void Helpers::start() {
  State& s = *state_;
  // To start a process takes as long as to read some files.
  constexpr std::size_t kFilesWorthAProcess = 8;
  const int worthwhile = int(std::min<std::size_t>(kMostWorkers, 1 + s.scan.paths.size() / kFilesWorthAProcess));
  const int processes = std::clamp(s.options.processes, 1, worthwhile);
  for (int i = 0; i < processes; ++i) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      throw Error("the DICOM helper cannot be started", ErrorKind::runFailed);
    Helper helper;
    helper.line = Descriptor(ends[0]);
    const Descriptor theirs(ends[1]);

    // Copies above the numbers that the helper expects, so that none overwrites another.
    const Descriptor board(fcntl(s.boardMemory.descriptor(), F_DUPFD_CLOEXEC, 10));
    const Descriptor slices(fcntl(s.sliceMemory.descriptor(), F_DUPFD_CLOEXEC, 10));
    const Descriptor line(fcntl(theirs.get(), F_DUPFD_CLOEXEC, 10));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, line.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, line.get(), STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, board.get(), kBoardDescriptor);
    posix_spawn_file_actions_adddup2(&actions, slices.get(), kSlicesDescriptor);
    // A process group of its own: Ctrl-C reaches the loader, which then ends the helpers.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    std::string program = s.options.program, number = std::to_string(i);
    char* arguments[] = {program.data(), number.data(), nullptr};
    const int failure = posix_spawn(&helper.process, program.c_str(), &actions, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0)
      throw Error("the DICOM helper cannot be started: " + std::string(std::strerror(failure)), ErrorKind::runFailed)
          .at("pectora-dicom")
          .advise("It belongs in the folder of the plugins; install Pectora again");
    s.helpers.push_back(std::move(helper));
  }
}

void Helpers::fail(std::size_t number, bool isHung) {
  State& s = *state_;
  Helper& helper = s.helpers[number];
  const std::int32_t file = s.board->current[number];
  int status = 0;
  if (isHung) kill(helper.process, SIGKILL);
  waitpid(helper.process, &status, 0);
  helper.process = -1;
  std::string why;
  if (isHung)
    why = "reading this file took more than " + std::to_string(int(s.options.timeoutSeconds)) + " s";
  else if (WIFSIGNALED(status))
    why = "reading this file broke the DICOM library (" + std::string(sigabbrev_np(WTERMSIG(status))) + "): the file is damaged";
  else
    why = "the DICOM helper ended by itself (exit code " + std::to_string(WEXITSTATUS(status)) + ")";
  Error error(why);
  if (file >= 0 && std::size_t(file) < s.scan.paths.size()) error.at(s.scan.name(std::size_t(file)));
  throw error.advise(copyAgain());
}

void Helpers::command(char what, const char* progress, double from, double to, Host& host) {
  State& s = *state_;
  s.board->nextFile = 0;
  s.board->finished = 0;
  for (std::size_t i = 0; i < s.helpers.size(); ++i) {
    Helper& helper = s.helpers[i];
    s.board->current[i] = -1;
    helper.isBusy = true;
    helper.file = -1;
    helper.since = Clock::now();
    if (send(helper.line.get(), &what, 1, MSG_NOSIGNAL) != 1) fail(i, false);
  }
  const auto isBusy = [](const Helper& h) { return h.isBusy; };
  while (std::any_of(s.helpers.begin(), s.helpers.end(), isBusy)) {
    std::vector<pollfd> polls;
    for (const Helper& helper : s.helpers) polls.push_back({helper.isBusy ? helper.line.get() : -1, POLLIN, 0});
    poll(polls.data(), polls.size(), 50);
    for (std::size_t i = 0; i < s.helpers.size(); ++i) {
      Helper& helper = s.helpers[i];
      if (!helper.isBusy) continue;
      if (polls[i].revents != 0) {
        char answer = 0;
        if (recv(helper.line.get(), &answer, 1, 0) != 1 || answer != what) fail(i, false);
        helper.isBusy = false;
        continue;
      }
      // A helper that is still at the same file as long ago hangs.
      const auto now = Clock::now();
      const std::int32_t file = s.board->current[i];
      if (file != helper.file) helper.file = file, helper.since = now;
      if (std::chrono::duration<double>(now - helper.since).count() > s.options.timeoutSeconds) fail(i, true);
    }
    host.checkCancel();
    host.progress(from + (to - from) * double(s.board->finished) / double(s.board->fileCount), progress);
  }
}

Scan Helpers::scan(Host& host) {
  State& s = *state_;
  command(kScanCommand, "reading headers", 0, 0.2, host);
  s.scan.files.clear();
  s.scan.frames.clear();
  const std::uint32_t frames = std::min<std::uint32_t>(s.board->framesUsed, kMostFrames);
  for (std::size_t i = 0; i < s.scan.paths.size(); ++i) {
    const FileHeader& file = s.scan.files.emplace_back(s.board->file(i));
    // A helper with damaged memory could write anything.
    if (file.kind == FileKind::image && (file.frames < 0 || std::uint64_t(file.firstFrame) + std::uint32_t(file.frames) > frames))
      throw Error("the header of this file cannot be read").at(s.scan.name(i)).advise(copyAgain());
  }
  for (std::uint32_t i = 0; i < frames; ++i) s.scan.frames.push_back(s.board->frame(i).header);
  return s.scan;
}

void Helpers::decode(const std::vector<FrameTarget>& targets, std::size_t slicePixels, std::int16_t* to, Host& host) {
  State& s = *state_;
  // The numbers of the shared slices, in the order of the targets.
  for (std::uint32_t i = 0; i < std::uint32_t(s.scan.frames.size()); ++i) s.board->frame(i).target = -1;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const FileHeader& header = s.scan.files[targets[i].file];
    s.board->frame(header.firstFrame + std::uint32_t(targets[i].frame)).target = std::int32_t(i);
  }
  s.board->slicePixels = slicePixels;
  const auto* decoded = static_cast<const std::int16_t*>(s.sliceMemory.resize(targets.size() * slicePixels * sizeof(*to)));
  command(kDecodeCommand, "decoding slices", 0.2, 0.9, host);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const std::string damage = s.board->file(targets[i].file).damage;
    if (!damage.empty())
      throw Error("the file " + damage).at(s.scan.name(targets[i].file)).advise(copyAgain());
    std::copy_n(decoded + i * slicePixels, slicePixels, to + targets[i].slice * slicePixels);
  }
}

}  // namespace pectora::dicom
