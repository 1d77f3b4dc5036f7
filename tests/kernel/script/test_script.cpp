#include "kernel/script/engine.h"

#include "tests/kernel/host/helpers.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

using namespace pectora;

namespace {

struct Script : TestRunner {
  std::string printed;
  ScriptOptions options() {
    ScriptOptions o;
    o.print = [this](const std::string& line) { printed += line + "\n"; };
    o.memoryLimit = 8 << 20;
    return o;
  }
  ScriptEngine engine{runner, registry, cancel, options()};

  static std::string write(const std::string& code, const std::string& name = "test.lua") {
    // A folder for each process: tests run side by side.
    const std::string folder = testing::TempDir() + "/pectora_script_" + std::to_string(getpid());
    std::filesystem::create_directories(folder);
    const std::string path = folder + "/" + name;
    std::ofstream(path, std::ios::binary) << code;
    return path;
  }
  std::string run(const std::string& code, const std::vector<std::pair<std::string, std::string>>& arguments = {}) {
    printed.clear();
    engine.run(write(code), arguments);
    return printed;
  }
  std::string failure(const std::string& code, const std::vector<std::pair<std::string, std::string>>& arguments = {}) {
    return errorOf([&] { run(code, arguments); }).what();
  }
};

}  // namespace

TEST(Script, CallsAStageAndReadsItsFacts) {
  EXPECT_EQ(Script().run("local ct = loader.counter{ size = 5 } print(ct.kind, ct.slices)"), "Volume\t5.0\n");
}

TEST(Script, PassesInputsByPositionOrNameAndGetsSeveralResults) {
  Script s;
  EXPECT_EQ(s.run("local ct = loader.counter{} local a, b = segmenter.echo(ct) print(a.rows, b.rows)"), "4.0\t4.0\n");
  EXPECT_EQ(s.run("local ct = loader.counter{} local a = segmenter.echo{ ct = ct, more = { ct, ct }, shift = 2 } print(a.kind)"), "Volume\n");
  EXPECT_EQ(s.run("local ct = loader.counter{} local a = segmenter.echo(ct, nil, { ct, ct }, {}) print(a.kind)"), "Volume\n");
}

TEST(Script, TakesEveryInstalledEffectForTheWordAuto) {
  // The test plugins have one effect, pull, and a segmenter that tells how many it was given.
  Script s;
  EXPECT_EQ(s.run("print(segmenter.effects('auto').count)"), "1.0\n");
  EXPECT_EQ(s.run("print(segmenter.effects{ effects = { 'auto' } }.count)"), "1.0\n");
  EXPECT_EQ(s.run("print(segmenter.effects{ effects = { effect.pull{}, 'auto' } }.count)"), "1.0\n");
  EXPECT_TRUE(contains(s.failure("segmenter.effects{ effects = { 'auto', effect.pull{} } }"), "every entry of this list"));
  EXPECT_TRUE(contains(s.failure("segmenter.effects{ effects = 'automatic' }"), "must be a value that a stage returned"));
}

TEST(Script, SaysTheLineOfAMisspeltStageAndTheRightName) {
  const std::string text = Script().failure("local x = 1\n\nlaoder.counter{}");
  EXPECT_TRUE(contains(text, "test.lua:3")) << text;
  EXPECT_TRUE(contains(text, "\"loader\"")) << text;
}

TEST(Script, SaysTheLineOfAMisspeltPluginAndTheRightName) {
  const std::string text = Script().failure("\nloader.conter{}");
  EXPECT_TRUE(contains(text, "test.lua:2")) << text;
  EXPECT_TRUE(contains(text, "loader.counter")) << text;
}

TEST(Script, SaysTheLineOfAMisspeltParameterAndTheRightName) {
  const std::string text = Script().failure("\nloader.counter{ szie = 3 }");
  EXPECT_TRUE(contains(text, "test.lua:2")) << text;
  EXPECT_TRUE(contains(text, "loader.counter")) << text;
  EXPECT_TRUE(contains(text, "\"size\"")) << text;
}

TEST(Script, SaysTheLineOfAMisspeltFact) {
  const std::string text = Script().failure("local ct = loader.counter{}\nprint(ct.slcies)");
  EXPECT_TRUE(contains(text, "test.lua:2")) << text;
  EXPECT_TRUE(contains(text, "\"slices\"")) << text;
}

TEST(Script, GivesATracebackForItsOwnErrors) {
  const std::string text = Script().failure("local function deep() error('too deep') end\ndeep()");
  EXPECT_TRUE(contains(text, "test.lua:1: too deep")) << text;
  EXPECT_TRUE(contains(text, "stack traceback")) << text;
}

TEST(Script, KeepsTheKindOfAnErrorThatPassedThroughIt) {
  Script s;
  EXPECT_EQ(errorOf([&] { s.run("segmenter.thrower{ what = 'failed' }"); }).kind(), ErrorKind::runFailed);
  EXPECT_EQ(errorOf([&] { s.run("segmenter.thrower{ what = 'error' }"); }).kind(), ErrorKind::badInput);
}

TEST(Script, MayCatchAnErrorAndGoOn) {
  const std::string text = Script().run("local ok, e = pcall(function() segmenter.thrower{} end) print(ok, tostring(e)) print('on')");
  EXPECT_TRUE(contains(text, "false\ttest.lua:1: segmenter.thrower: ct: the slice is bad")) << text;
  EXPECT_TRUE(contains(text, "on\n")) << text;
}

TEST(Script, HasNoWayOutOfTheSandbox) {
  Script s;
  for (const char* name : {"io", "os", "debug", "load", "dofile", "loadfile", "collectgarbage", "xpcall", "package", "coroutine"})
    EXPECT_THROW(s.run("return " + std::string(name)), Error) << name;
  EXPECT_THROW(s.run("return string.dump(function() end)"), Error);
  EXPECT_THROW(s.run("setmetatable({}, { __gc = function() end })"), Error);
  EXPECT_THROW(s.run("\x1bLua"), Error);
  EXPECT_THROW(s.run("getmetatable(loader.counter{}).__gc = nil"), Error);
}

TEST(Script, StopsWhenCancelledEvenInsideAnEndlessPcall) {
  Script s;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    s.cancel = true;
  });
  EXPECT_THROW(s.run("while true do pcall(function() while true do end end) end"), Cancelled);
  canceller.join();
}

TEST(Script, CannotSwallowTheCancelOfAStage) {
  Script s;
  EXPECT_THROW(s.run("pcall(function() segmenter.thrower{ what = 'cancelled' } end) print('still here')"), Cancelled);
  EXPECT_EQ(s.printed, "");
}

TEST(Script, IsStoppedWhenItTakesTooMuchMemory) { EXPECT_THROW(Script().run("local t = {} for i = 1, 1e9 do t[i] = i end"), Error); }

TEST(Script, RequiresModulesBesideItAndNoOthers) {
  Script s;
  Script::write("return { answer = 42 }", "helpmodule.lua");
  EXPECT_EQ(s.run("print(require('helpmodule').answer, require 'helpmodule' == require 'helpmodule')"), "42\ttrue\n");
  EXPECT_THROW(s.run("require('../helpmodule')"), Error);
  EXPECT_THROW(s.run("require('nowhere')"), Error);
}

TEST(ScriptParameters, OfAScriptThatDeclaresNoneAreNoneAndNothingIsRun) {
  Script s;
  const std::string path = Script::write("print('before')\nlocal v = loader.counter{}\nprint('ran on')");
  EXPECT_TRUE(s.engine.parametersOf(path).empty());
  EXPECT_EQ(s.printed, "before\n");
}

TEST(ScriptParameters, AreListedWithoutRunningTheRest) {
  Script s;
  const std::string path = Script::write(
      "local p = parameters{ { name = 'lift', default = 30, unit = 'mm', range = { 0, 80 }, doc = 'How far' }, { name = 'ct', doc = 'Where' } }\nerror('ran on')");
  const auto found = s.engine.parametersOf(path);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].name, "lift");
  EXPECT_EQ(found[0].hard.high, 80);
  EXPECT_EQ(found[1].type, "text");
}

TEST(ScriptParameters, AreCheckedLikeThoseOfAStage) {
  Script s;
  const std::string code = "local p = parameters{ { name = 'lift', default = 30, range = { 0, 80 } }, { name = 'ct' }, { name = 'fast', default = false } } print(p.lift, p.ct, p.fast)";
  EXPECT_EQ(s.run(code), "30.0\tnil\tfalse\n");
  EXPECT_EQ(s.run(code, {{"lift", "12.5"}, {"ct", "a b"}, {"fast", "true"}}), "12.5\ta b\ttrue\n");
  EXPECT_TRUE(contains(s.failure(code, {{"lift", "99"}}), "0 to 80"));
  EXPECT_TRUE(contains(s.failure(code, {{"lfit", "9"}}), "\"lift\""));
  EXPECT_THROW(s.run("print(1)", {{"lift", "9"}}), Error);
}

TEST(Script, LeavesNothingForTheNextOne) {
  Script s;
  s.run("leftover = 1");
  EXPECT_THROW(s.run("print(leftover)"), Error);
}

TEST(ScriptConsole, KeepsItsStateBetweenLinesAndPrintsValues) {
  Script s;
  s.engine.evaluate("x = 6");
  s.engine.evaluate("x * 7, 'done'");
  EXPECT_EQ(s.printed, "42\tdone\n");
}

TEST(ScriptConsole, GoesOnAfterAnErrorAndAfterACancel) {
  Script s;
  s.engine.evaluate("x = 1");
  EXPECT_TRUE(contains(errorOf([&] { s.engine.evaluate("laoder.counter{}"); }).what(), "console:1"));
  EXPECT_THROW(s.engine.evaluate("setmetatable({}, { __tostring = function() error('no') end })"), Error);
  s.cancel = true;
  EXPECT_THROW(s.engine.evaluate("while true do end"), Cancelled);
  s.cancel = false;
  s.engine.evaluate("x");
  EXPECT_EQ(s.printed, "1\n");
}

TEST(ScriptConsole, SeesValuesThatTheProgramDefinesAndGivesItsOwn) {
  Script s;
  s.engine.define("ct", s.runner.run("loader.counter", {}, {}).front());
  s.engine.evaluate("ct.slices");
  EXPECT_EQ(s.printed, "4.0\n");
  s.engine.evaluate("list = { ct, ct } name = 'solver.x' plain = { b = 2, a = { 1, 2 }, c = 'text' }");
  EXPECT_EQ(s.engine.handles("list").size(), 2u);
  EXPECT_EQ(s.engine.text("name"), "solver.x");
  const Settings plain = s.engine.settings("plain");
  ASSERT_EQ(plain.size(), 3u);
  EXPECT_EQ(plain[0].first, "a");
  EXPECT_EQ(std::get<double>(plain[1].second), 2);
  EXPECT_TRUE(s.engine.handles("nothing").empty());
  EXPECT_TRUE(s.engine.text("nothing").empty());
}
