// The program as a user runs it: exit codes, texts, and which stream they go to.
#include "tests/app/helpers.h"

#include <csignal>
#include <thread>

using namespace pectora;

namespace {

struct Outcome {
  int code = -1;
  std::string out, err;
};

// A file of this process's own.
std::string ownFile(const std::string& name) {
  static const std::filesystem::path folder = freshFolder("app");
  return (folder / name).string();
}

Outcome run(const std::string& arguments, const std::string& environment = "PECTORA_PLUGIN_PATH=" PECTORA_TEST_PLUGINS) {
  const std::string out = ownFile("out"), err = ownFile("err");
  const int code = exitCode(environment + " " PECTORA_PROGRAM " " + arguments + " >" + out + " 2>" + err);
  return {code, readFile(out), readFile(err)};
}

std::string script(const std::string& code) {
  const std::string path = ownFile("script.lua");
  std::ofstream(path) << code;
  return path;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST(CommandLine, SaysWhatItIsAndWhatItIsNot) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_TRUE(contains(help.out, "not a medical device")) << help.out;
  EXPECT_TRUE(contains(help.out, "Exit codes"));
  EXPECT_TRUE(contains(run("--version").out, "pectora "));
}

TEST(CommandLine, ExitsWithTwoOnBadUsage) {
  for (const char* arguments : {"", "frobnicate", "run", "describe", "describe solver.nowhere", "run /nowhere.lua", "run correction --threads 0"})
    EXPECT_EQ(run(arguments).code, 2) << arguments;
}

TEST(CommandLine, SaysWhyNoWindowCanBeOpened) {
  // Either the window is not built in, or there is no such display.
  const Outcome o = run("view", "env -u WAYLAND_DISPLAY DISPLAY=:4711");
  EXPECT_EQ(o.code, 2);
  EXPECT_TRUE(contains(o.err, "not built") || contains(o.err, "no display")) << o.err;
}

TEST(CommandLine, SendsResultsToStdoutAndTheRestToStderr) {
  const Outcome o = run("run " + script("local ct = loader.counter{ warns = true } print('result', ct.slices)"));
  EXPECT_EQ(o.code, 0);
  EXPECT_EQ(o.out, "result\t4.0\n");
  EXPECT_TRUE(contains(o.err, "as asked")) << o.err;
  EXPECT_FALSE(contains(o.err, "\033[")) << "no colours or bars off a terminal";
}

TEST(CommandLine, QuietLeavesWarningsAlone) {
  const Outcome o = run("run --quiet " + script("loader.counter{ warns = true }"));
  EXPECT_TRUE(contains(o.err, "as asked"));
  EXPECT_FALSE(contains(o.err, "info"));
}

TEST(CommandLine, ExitCodesTellFailureFromBadInput) {
  EXPECT_EQ(run("run " + script("segmenter.thrower{ what = 'failed' }")).code, 1);
  EXPECT_EQ(run("run " + script("segmenter.thrower{ what = 'error' }")).code, 2);
  EXPECT_EQ(run("run " + script("segmenter.thrower{ what = 'cancelled' }")).code, 3);
  EXPECT_EQ(run("run " + script("x = = 1")).code, 2);
}

TEST(CommandLine, NamesLineAndNearestNameOfAMistake) {
  const Outcome stage = run("run " + script("\n\nlaoder.counter{}"));
  EXPECT_TRUE(contains(stage.err, "script.lua:3")) << stage.err;
  EXPECT_TRUE(contains(stage.err, "\"loader\"")) << stage.err;
  const Outcome parameter = run("run " + script("\nsolver.verlet(nil, nil, { tolernace = 1 })"));
  EXPECT_TRUE(contains(parameter.err, "script.lua:2")) << parameter.err;
  EXPECT_TRUE(contains(parameter.err, "\"tolerance\"")) << parameter.err;
}

TEST(CommandLine, ListsAScriptsParametersWithUnitRangeAndDefault) {
  const Outcome o = run("run correction --help");
  EXPECT_EQ(o.code, 0);
  EXPECT_TRUE(contains(o.out, "lift = 30 mm")) << o.out;
  EXPECT_TRUE(contains(o.out, "[0 to 120 mm]")) << o.out;
}

TEST(CommandLine, PassesOutOnAndRefusesItWhereAScriptHasNone) {
  EXPECT_EQ(run("run " + script("local p = parameters{ { name = 'out', default = 'x', role = 'output' } } print(p.out)") + " --out /tmp/y").out, "/tmp/y\n");
  EXPECT_EQ(run("run " + script("print(1)") + " --out /tmp/y").code, 2);
}

TEST(CommandLine, ListsAndDescribesEveryPlugin) {
  const Outcome list = run("list", "");
  EXPECT_EQ(list.code, 0);
  std::istringstream lines(list.out);
  int plugins = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    ++plugins;
    const std::string id = line.substr(0, line.find(' '));
    EXPECT_FALSE(contains(line, "cannot be used")) << line;
    const Outcome text = run("describe " + id, ""), json = run("describe " + id + " --json", "");
    EXPECT_EQ(text.code, 0) << id;
    EXPECT_TRUE(contains(text.out, id)) << id;
    EXPECT_TRUE(contains(json.out, "\"parameters\"")) << id;
  }
  EXPECT_GE(plugins, 15);
}

TEST(CommandLine, ListSaysWhatIsWrongWithABrokenPlugin) {
  const Outcome list = run("list");
  EXPECT_EQ(list.code, 0);
  EXPECT_TRUE(contains(list.out, "loader.oldstamp")) << list.out;
  EXPECT_TRUE(contains(list.out, "built for another Pectora")) << list.out;
}

TEST(CommandLine, CancelsCleanlyOnInterrupt) {
  const std::string path = script("segmenter.slow{}");
  const std::string err = ownFile("cancel_err");
  const pid_t child = fork();
  if (child == 0) {
    setenv("PECTORA_PLUGIN_PATH", PECTORA_TEST_PLUGINS, 1);
    if (!std::freopen(err.c_str(), "w", stderr)) _exit(99);
    execl(PECTORA_PROGRAM, "pectora", "run", path.c_str(), nullptr);
    _exit(98);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
  EXPECT_TRUE(contains(readFile(err), "cancelled"));
}
