// The two stages through the runner, and the watch over the helper programs.
#include "support.h"

#include "plugins/loader/dicom/pixels.h"

#include "kernel/host/runner.h"
#include "kernel/value/comparison.h"

#include <chrono>
#include <dirent.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>

namespace pectora::dicom {
namespace {

class Stages : public testing::Test {
 protected:
  Registry registry_{{PECTORA_PLUGINS}};
  Messages messages_;
  std::atomic<bool> cancel_{false};
  Runner runner_{registry_, messages_, cancel_};
  TemporaryFolder folder_;

  Handle run(const std::string& path) { return runner_.run("loader.dicom", {{"path", path}}, {}).at(0); }
  const Volume& volumeOf(const Handle& handle) const { return dynamic_cast<const Volume&>(*handle.value); }
};

int openDescriptors() {
  int count = 0;
  DIR* folder = opendir("/proc/self/fd");
  while (readdir(folder)) ++count;
  closedir(folder);
  return count;
}

bool hasChildren() { return waitpid(-1, nullptr, WNOHANG) != -1 || errno != ECHILD; }

TEST_F(Stages, WhatReportDicomWritesLoaderDicomReads) {
  const Volume volume = patternVolume();
  writeSeries(volume, folder_.path, {});
  const Handle first = run(folder_.path);
  for (const std::string& storage : storageNames()) {
    const std::string out = folder_.path + "/out_" + storage;
    for (int run = 0; run < 2; ++run) {   // the second replaces the first
      const Handle report = runner_.run("report.dicom", {{"path", out}, {"storage", storage}, {"twelve_bit", true}, {"shuffle", true}}, {{first}}).at(0);
      EXPECT_EQ(dynamic_cast<const Report&>(*report.value).files.size(), 6u);
    }
    EXPECT_EQ(volumeOf(run(out)).hu, volume.hu) << storage;
  }
}

TEST_F(Stages, ReportDicomLeavesFoldersOfOtherThingsAlone) {
  writeSeries(patternVolume(), folder_.path, {});
  const Handle ct = run(folder_.path);
  const std::string out = folder_.path + "/out";
  std::filesystem::create_directory(out);
  writeBytes(out + "/thesis.txt", "mine");
  EXPECT_THROW(runner_.run("report.dicom", {{"path", out}}, {{ct}}), Error);
  EXPECT_EQ(readBytes(out + "/thesis.txt"), "mine");
}

TEST_F(Stages, AListOfFilesAndADicomdirAreSeriesToo) {
  const Volume volume = patternVolume();
  std::vector<std::string> files = writeSeries(volume, folder_.path, {});
  for (std::string& name : files) name = folder_.path + "/" + name;
  EXPECT_EQ(volumeOf(runner_.run("loader.dicom", {{"files", files}}, {}).at(0)).hu, volume.hu);
  editFile(files[0], [&](PlainFile& f) {
    f.set(0x00020002, "UI", "1.2.840.10008.1.3.10");
    f.write(folder_.path + "/DICOMDIR");
    f.set(0x00020002, "UI", "1.2.840.10008.5.1.4.1.1.2");
  });
  EXPECT_EQ(volumeOf(run(folder_.path + "/DICOMDIR")).hu, volume.hu);
}

TEST_F(Stages, NoPathAndTwoPathsAreErrors) {
  EXPECT_THROW(runner_.run("loader.dicom", {}, {}), Error);
  EXPECT_THROW(runner_.run("loader.dicom", {{"path", folder_.path}, {"files", std::vector<std::string>{folder_.path}}}, {}), Error);
}

TEST_F(Stages, NoProcessAndNoDescriptorIsLeftBehind) {
  writeSeries(patternVolume(), folder_.path, {.storage = Storage::jpegLs});
  ListeningHost host;
  loadPath(folder_.path, host);
  const int before = openDescriptors();
  for (int i = 0; i < 3; ++i) loadPath(folder_.path, host);
  host.cancel = true;
  EXPECT_THROW(loadPath(folder_.path, host), Cancelled);
  EXPECT_EQ(openDescriptors(), before);
  EXPECT_FALSE(hasChildren());
}

// A program in place of the helper.
std::string script(const std::string& folder, const std::string& text) {
  const std::string path = folder + "/helper.sh";
  writeBytes(path, "#!/bin/sh\n" + text + "\n");
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

TEST_F(Stages, AHelperThatDiesBecomesAnError) {
  writeSeries(patternVolume(), folder_.path, {});
  TemporaryFolder programs;
  LoadOptions options = loadOptions();
  options.helpers.program = script(programs.path, "kill -SEGV $$");
  EXPECT_NE(refusal(folder_.path, options).find("SEGV"), std::string::npos);
  options.helpers.program = script(programs.path, "exit 7");
  EXPECT_NE(refusal(folder_.path, options).find("exit code 7"), std::string::npos);
  options.helpers.program = programs.path + "/absent";
  EXPECT_NE(refusal(folder_.path, options).find("cannot be started"), std::string::npos);
  EXPECT_FALSE(hasChildren());
}

// Opening a pipe that nobody writes to waits for ever.
TEST_F(Stages, AFileThatHangsIsNamedAfterTheTimeout) {
  auto files = writeSeries(patternVolume(), folder_.path, {});
  for (std::string& name : files) name = folder_.path + "/" + name;
  files.push_back(folder_.path + "/hangs.dcm");
  ASSERT_EQ(mkfifo(files.back().c_str(), 0600), 0);
  LoadOptions options = loadOptions();
  options.helpers.timeoutSeconds = 0.3;
  ListeningHost host;
  try {
    load(files, options, host);
    FAIL() << "it was loaded";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("hangs.dcm"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(hasChildren());
}

TEST_F(Stages, CancellingEndsTheHelpersAtOnce) {
  const std::string pipe = folder_.path + "/hangs.dcm";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  ListeningHost host;
  const auto start = std::chrono::steady_clock::now();
  std::thread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    host.cancel = true;
  });
  EXPECT_THROW(load({pipe}, loadOptions(), host), Cancelled);
  user.join();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  EXPECT_FALSE(hasChildren());
}

}  // namespace
}  // namespace pectora::dicom
