#include "plugins/loader/dicom/series_writer.h"
#include "plugins/report/common/atomic_file.h"

#include "kernel/stage/plugin.h"
#include "kernel/value/comparison.h"

#include <filesystem>

namespace {
using namespace pectora;
namespace fs = std::filesystem;

/// A new folder beside the one that is to be made; gone with its content unless it was put in place.
class FolderAside {
 public:
  explicit FolderAside(const std::string& path) : path_(path), aside_(asideName(path)) {
    fs::remove_all(aside_);
    makeFolder(aside_);
  }
  ~FolderAside() {
    std::error_code ignored;
    fs::remove_all(aside_, ignored);
  }
  FolderAside(const FolderAside&) = delete;
  FolderAside& operator=(const FolderAside&) = delete;
  const std::string& path() const { return aside_; }
  /// Takes the place of the older folder, if there is one.
  void putInPlace() const {
    const std::string old = path_ + ".old";
    fs::remove_all(old);
    if (fs::exists(path_)) fs::rename(path_, old);
    publish(path_);
    fs::remove_all(old);
  }

 private:
  std::string path_, aside_;
};

// A folder of an earlier run may be replaced; any other keeps what it holds.
void checkFolder(const std::string& path) {
  if (!fs::exists(path)) return;
  bool isOurs = fs::is_directory(path);
  if (isOurs)
    for (const auto& entry : fs::directory_iterator(path)) isOurs = isOurs && entry.path().extension() == ".dcm";
  if (!isOurs)
    throw Error("the folder holds other files than DICOM").of("path").given(path).advise("Give a new folder: two series must never mix");
}

class WriteDicom final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.text("path", path_, TextRole::outputPath, "Folder to make; the series of an earlier run in it is replaced, so that two never mix");
    v.choice("storage", storage_, dicom::storageNames(), "How pixels are stored; all are lossless");
    v.flag("twelve_bit", isTwelveBit_, "Unsigned 12-bit values with an intercept of -1024 HU, as older scanners store them, instead of signed 16-bit ones");
    v.flag("shuffle", shuffles_, "Number the files in another order than that of their positions");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    while (path_.size() > 1 && path_.back() == '/') path_.pop_back();
    if (path_.empty()) throw Error("a folder to write into is needed").of("path");
    try {
      return {write(inputs, host)};
    } catch (const fs::filesystem_error& error) {
      throw Error("the folder cannot be written: " + error.code().message(), ErrorKind::runFailed).of("path").given(path_);
    }
  }

 private:
  std::shared_ptr<const Report> write(const Inputs& inputs, Host& host) const {
    checkFolder(path_);
    const FolderAside folder(path_);
    auto report = std::make_shared<Report>();
    report->folder = path_;
    const dicom::WriteOptions options{.storage = dicom::storageOf(storage_), .isTwelveBit = isTwelveBit_, .shufflesNumbers = shuffles_,
                                      .seed = inputs.handles("ct").front().record->key};
    report->files = dicom::writeSeries(*inputs.get<Volume>("ct"), folder.path(), options, [&] { host.checkCancel(); });
    folder.putInPlace();
    return report;
  }

  std::string path_, storage_ = "explicit_le";
  bool isTwelveBit_ = false, shuffles_ = false;
};

}  // namespace

PECTORA_STAGE(WriteDicom, {.id = "report.dicom", .version = "1.0",
                           .summary = "Writes a CT as a DICOM series of the patient PHANTOM",
                           .references = "DICOM PS3.3 (CT Image), PS3.10 (files)",
                           .inputs = {{"ct", {"Volume"}}},
                           .outputs = {{"report", {"Report"}}},
                           .isCacheable = false})
