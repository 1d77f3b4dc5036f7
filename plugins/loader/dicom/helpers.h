// The helper programs that read headers and decode pixels, and the watch over them.
#pragma once

#include "plugins/loader/dicom/header.h"

#include "kernel/stage/host.h"

#include <memory>

namespace pectora::dicom {

/// Where one frame's pixels go.
struct FrameTarget {
  std::size_t file = 0;
  int frame = 0;
  std::size_t slice = 0;    ///< number among the decoded slices
};

/// Some `pectora-dicom` processes on one list of files. A helper that dies, hangs or is damaged by a file becomes an
/// Error that names the file. All of them are killed and reaped when this ends.
class Helpers {
 public:
  struct Options {
    std::string program;          ///< path of pectora-dicom
    int processes = 2;
    double timeoutSeconds = 60;   ///< longest time that one file may take
  };
  /// Starts the processes. Throws Error if that fails.
  Helpers(std::vector<std::string> paths, const Options& options);
  ~Helpers();
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

  /// The headers of all files. Throws Error or Cancelled.
  Scan scan(Host& host);
  /// Decodes slices of `slicePixels` pixels each, into `to` (slice after slice). After scan only.
  /// Throws Error, naming the file, if one cannot be decoded, or Cancelled.
  void decode(const std::vector<FrameTarget>& targets, std::size_t slicePixels, std::int16_t* to, Host& host);

 private:
  struct State;
  void start();
  void command(char what, const char* progress, double from, double to, Host& host);
  [[noreturn]] void fail(std::size_t helper, bool isHung);
  std::unique_ptr<State> state_;
};

}  // namespace pectora::dicom
