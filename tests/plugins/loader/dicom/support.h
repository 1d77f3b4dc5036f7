// What the tests of the DICOM loader share: a host that listens, folders that vanish, and DICOM made by hand.
#pragma once

#include "plugins/loader/dicom/load.h"
#include "plugins/loader/dicom/series_writer.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace pectora::dicom {

/// Keeps what it is told.
class ListeningHost : public Host {
 public:
  void progress(double, const std::string&) override {}
  bool cancelled() const override { return cancel; }
  void warn(const std::string& message) override { keep(warnings, message); }
  void info(const std::string& message) override { keep(infos, message); }
  std::string pluginFolder() const override { return PECTORA_PLUGINS; }

  std::atomic<bool> cancel{false};
  std::vector<std::string> warnings, infos;

 private:
  void keep(std::vector<std::string>& list, const std::string& message) {
    const std::lock_guard lock(mutex_);
    list.push_back(message);
  }
  std::mutex mutex_;
};

/// An empty folder that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string path;
};

/// A small CT whose every voxel tells where it is from.
Volume patternVolume(int columns = 24, int rows = 16, int slices = 6);

LoadOptions loadOptions();
/// Loads a folder or file as the stage does.
Volume loadPath(const std::string& path, Host& host, const LoadOptions& options = loadOptions());
/// The sentence with which a folder or file is refused; fails the test if it is loaded.
std::string refusal(const std::string& path, const LoadOptions& options = loadOptions());

std::string readBytes(const std::string& path);
void writeBytes(const std::string& path, const std::string& bytes);

/// A flat data set in explicit little endian, parsed and written without GDCM.
class PlainFile {
 public:
  struct Element {
    unsigned tag = 0;      ///< group << 16 | element
    std::string vr, value;
  };
  /// Parses a file that writeSeries made with Storage::explicitLittle.
  explicit PlainFile(const std::string& path);
  PlainFile() = default;
  void set(unsigned tag, const std::string& vr, std::string value);
  void setShort(unsigned tag, int value);
  void remove(unsigned tag);
  std::string value(unsigned tag) const;
  std::string bytes() const;
  void write(const std::string& path) const { writeBytes(path, bytes()); }

  std::vector<Element> elements;   ///< sorted by tag when written
};

/// A sequence's value: each item is a data set of its own, in explicit little endian.
std::string sequence(const std::vector<std::vector<PlainFile::Element>>& items);

/// Applies `edit` to one of a folder's files in explicit little endian.
template <class Edit>
void editFile(const std::string& path, Edit edit) {
  PlainFile file(path);
  edit(file);
  file.write(path);
}

}  // namespace pectora::dicom
