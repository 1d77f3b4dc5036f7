#include "tests/kernel/host/helpers.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <thread>

using namespace pectora;

namespace {

// A counter's volume tells which run made it.
double runNumber(const Handle& handle) { return dynamic_cast<const Volume&>(*handle.value).grid.origin.x; }

std::string temporaryFile(const std::string& content) {
  const std::string path = testing::TempDir() + "/pectora_runner_test_" + std::to_string(getpid()) + ".bin";
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

}  // namespace

TEST(Runner, AnswersAnUnchangedCallFromTheCache) {
  TestRunner t;
  const Handle first = t.runner.run("loader.counter", {{"size", 3.0}}, {})[0];
  const Handle second = t.runner.run("loader.counter", {{"size", 3.0}}, {})[0];
  EXPECT_EQ(first.value, second.value);
  EXPECT_EQ(t.messages.fresh, 1);
  EXPECT_EQ(t.messages.cached, 1);
}

TEST(Runner, RunsAgainWhenASettingChanges) {
  TestRunner t;
  const Handle first = t.runner.run("loader.counter", {{"size", 3.0}}, {})[0];
  const Handle second = t.runner.run("loader.counter", {{"size", 5.0}}, {})[0];
  EXPECT_NE(runNumber(first), runNumber(second));
  EXPECT_NE(first.record->key, second.record->key);
}

TEST(Runner, RunsAgainWhenTheBytesOfAFileChangeButNotItsName) {
  TestRunner t;
  const std::string path = temporaryFile("one");
  const Handle first = t.runner.run("loader.counter", {{"path", path}}, {})[0];
  temporaryFile("two");
  const Handle second = t.runner.run("loader.counter", {{"path", path}}, {})[0];
  const Handle third = t.runner.run("loader.counter", {{"path", path}}, {})[0];
  EXPECT_NE(runNumber(first), runNumber(second));
  EXPECT_EQ(runNumber(second), runNumber(third));
}

TEST(Runner, KeepsNoPathInTheRecord) {
  // A path may hold a patient's name.
  TestRunner t;
  const std::string path = temporaryFile("one");
  const Handle handle = t.runner.run("loader.counter", {{"path", path}, {"target", std::string("/tmp/SMITH^JOHN")}}, {})[0];
  for (const auto& [name, value] : handle.record->settings) {
    EXPECT_FALSE(contains(value, "pectora_runner_test")) << value;
    EXPECT_FALSE(contains(value, "SMITH")) << value;
  }
}

TEST(Runner, PassesTheKeysOfInputsOn) {
  TestRunner t;
  const Handle a = t.runner.run("loader.counter", {{"size", 3.0}}, {})[0], b = t.runner.run("loader.counter", {{"size", 4.0}}, {})[0];
  const auto one = t.runner.run("segmenter.echo", {}, {{a}, {}, {}}), other = t.runner.run("segmenter.echo", {}, {{b}, {}, {}});
  EXPECT_NE(one[0].record->key, other[0].record->key);
  EXPECT_EQ(one[0].record->inputs[0].second, a.record);
  EXPECT_EQ(one[0].record, one[1].record);
}

TEST(Runner, TakesOptionalInputsAndLists) {
  TestRunner t;
  const Handle a = t.runner.run("loader.counter", {}, {})[0];
  const auto plain = t.runner.run("segmenter.echo", {}, {{a}, {}, {}}), full = t.runner.run("segmenter.echo", {}, {{a}, {a}, {a, a, a}});
  EXPECT_EQ(dynamic_cast<const Volume&>(*plain[0].value).grid.origin.y, 0);
  EXPECT_EQ(dynamic_cast<const Volume&>(*full[0].value).grid.origin.y, 103);
}

TEST(Runner, RefusesMissingAndWrongInputs) {
  TestRunner t;
  EXPECT_TRUE(contains(errorOf([&] { t.runner.run("segmenter.echo", {}, {{}, {}, {}}); }).what(), "ct"));
  struct Odd : Value {
    const char* kind() const override { return "Odd"; }
  };
  const Handle odd{std::make_shared<Odd>(), std::make_shared<Record>()};
  const std::string text = errorOf([&] { t.runner.run("segmenter.echo", {}, {{odd}, {}, {}}); }).what();
  EXPECT_TRUE(contains(text, "Odd")) << text;
  EXPECT_TRUE(contains(text, "Volume")) << text;
}

TEST(Runner, NamesTheStageOfEveryError) {
  TestRunner t;
  const auto thrown = [&](const char* what) { return errorOf([&] { t.runner.run("segmenter.thrower", {{"what", std::string(what)}}, {}); }); };
  for (const char* what : {"error", "failed", "standard", "memory"}) EXPECT_EQ(thrown(what).stage(), "segmenter.thrower") << what;
  EXPECT_EQ(thrown("error").kind(), ErrorKind::badInput);
  EXPECT_EQ(thrown("failed").kind(), ErrorKind::runFailed);
  EXPECT_EQ(thrown("standard").kind(), ErrorKind::runFailed);
  EXPECT_THROW(t.runner.run("segmenter.thrower", {{"what", std::string("cancelled")}}, {}), Cancelled);
}

TEST(Runner, RefusesAStageThatReturnsTooLittle) {
  TestRunner t;
  EXPECT_EQ(errorOf([&] { t.runner.run("segmenter.short", {}, {}); }).kind(), ErrorKind::runFailed);
}

TEST(Runner, KeepsWarningsInTheRecordAndRepeatsThemFromTheCache) {
  TestRunner t;
  for (int i = 0; i < 2; ++i) {
    const Handle handle = t.runner.run("loader.counter", {{"warns", true}}, {})[0];
    EXPECT_EQ(handle.record->warnings, std::vector<std::string>{"as asked"});
  }
  EXPECT_EQ(t.messages.warnings.size(), 2u);
}

TEST(Runner, StopsWithinMomentsOfACancel) {
  TestRunner t;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    t.cancel = true;
  });
  // The stage itself would take half a minute: only a cancel ends this test in time.
  EXPECT_THROW(t.runner.run("segmenter.slow", {}, {}), Cancelled);
  canceller.join();
}

TEST(Runner, LetsTheLeastRecentlyUsedGoWhenTheBudgetIsSpent) {
  TestRunner t;
  t.runner.cacheBudget = 500000;
  const double first = runNumber(t.runner.run("loader.counter", {{"size", 50.0}}, {})[0]);  // 250 kB
  t.runner.run("loader.counter", {{"size", 51.0}}, {});
  EXPECT_NE(runNumber(t.runner.run("loader.counter", {{"size", 50.0}}, {})[0]), first);
}
