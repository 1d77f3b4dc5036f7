// The command line: run, demo, list, describe, explain, view.
//
// Exit codes: 0 done; 1 the run failed; 2 bad usage or bad input; 3 cancelled.
#include "app/console.h"
#include "app/listing.h"
#ifdef PECTORA_VIEW
#include "app/view/view.h"
#endif

#include "kernel/physics/workers.h"
#include "kernel/script/engine.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <filesystem>

namespace {

using namespace pectora;
namespace fs = std::filesystem;

constexpr const char* kAbout =
    "Pectora predicts the look of a chest after a Nuss operation, from the CT before it.\n"
    "Research software; not a medical device, and not to be used for the care of a patient.";
constexpr const char* kExitCodes = "Exit codes: 0 done; 1 the run failed; 2 bad usage or bad input; 3 cancelled.";

std::atomic<bool> cancelFlag{false};

// The first Ctrl-C asks the run to stop; a second one ends the program at once.
void onInterrupt(int) {
  if (cancelFlag.exchange(true)) std::_Exit(3);
}

void writeOut(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

// Scripts lie in "share/pectora/scripts" of an installation, or in "scripts" of a build.
std::string scriptsFolder() {
  const fs::path prefix = fs::canonical("/proc/self/exe").parent_path().parent_path(), installed = prefix / "share/pectora/scripts";
  return (fs::exists(installed) ? installed : prefix / "scripts").string();
}

// A script by its path, or by its name among the installed ones.
std::string findScript(const std::string& given) {
  if (fs::exists(given)) return given;
  for (const std::string& name : {given, given + ".lua"}) {
    const fs::path installed = fs::path(scriptsFolder()) / fs::path(name).filename();
    if (fs::exists(installed) && fs::path(name) == fs::path(name).filename()) return installed.string();
  }
  throw Error("there is no such script").given(given).advise("Give the path of a .lua file, or a name from " + scriptsFolder());
}

struct Options {
  std::string script, id, out;
  std::vector<std::string> arguments;
  int threadCount = 0;
  bool quiet = false, json = false, scriptHelp = false;
#ifdef PECTORA_VIEW
  view::ViewOptions window;
#endif
};

// NAME=VALUE words, with --out as out=DIR.
std::vector<std::pair<std::string, std::string>> scriptArguments(const Options& options) {
  std::vector<std::pair<std::string, std::string>> arguments;
  for (const std::string& word : options.arguments) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error("a script's parameter is given as NAME=VALUE").given(word).advise("`pectora run SCRIPT --help` lists them");
    arguments.emplace_back(word.substr(0, equals), word.substr(equals + 1));
  }
  if (!options.out.empty()) arguments.emplace_back("out", options.out);
  return arguments;
}

// Runs an installed script after printing the command that does the same.
void runAndTell(ScriptEngine& engine, const std::string& script, const std::vector<std::pair<std::string, std::string>>& arguments) {
  std::string line = "$ pectora run " + script;
  for (const auto& [name, value] : arguments) line += " " + name + "=" + value;
  writeOut(line + "\n");
  engine.run(findScript(script), arguments);
  writeOut("\n");
}

int command(const CLI::App& app, const Options& options, Console& console) {
  Registry registry(pluginFolders());
  Runner runner(registry, console, cancelFlag);
  ScriptOptions scriptOptions;
  scriptOptions.requireFolders = {scriptsFolder()};
  scriptOptions.print = [](const std::string& line) { writeOut(line + "\n"); };
  ScriptEngine engine(runner, registry, cancelFlag, scriptOptions);

  if (app.got_subcommand("list")) {
    writeOut(listText(registry));
  } else if (app.got_subcommand("describe")) {
    writeOut(options.json ? describeJson(registry, runner, options.id) : describeText(registry, runner, options.id));
  } else if (app.got_subcommand("run") && options.scriptHelp) {
    const std::string path = findScript(options.script);
    writeOut(fmt::format("pectora run {} [NAME=VALUE ...]\n\nParameters of this script\n{}", options.script,
                         parametersText(engine.parametersOf(path))));
  } else if (app.got_subcommand("run")) {
    engine.run(findScript(options.script), scriptArguments(options));
  } else if (app.got_subcommand("demo")) {
    const std::string out = options.out.empty() ? "demo" : options.out;
    runAndTell(engine, "phantom.lua", {{"out", out + "/patient"}});
    runAndTell(engine, "correction.lua", {{"ct", out + "/patient/dicom"},
                                          {"scan", out + "/patient/truth/scan.txt"},
                                          {"landmarks", out + "/patient/truth/landmarks.csv"},
                                          {"out", out + "/result"}});
  } else if (app.got_subcommand("explain")) {
    std::vector<Explanation> explanations;
    runner.explanations = &explanations;
    try {
      engine.run(findScript(options.script), scriptArguments(options));
      writeOut("The script calls no solver.\n");
    } catch (const Explained&) {
      for (const Explanation& e : explanations) writeOut(explanationText(e));
    }
  } else {
#ifdef PECTORA_VIEW
    // The window has a button to cancel; an interrupt ends it.
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    view::runView(registry, options.window);
#else
    throw Error("the tool window is not built into this program").advise("Scripts do all that it would: pectora run scripts/correction.lua");
#endif
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{kAbout};
  app.footer(kExitCodes);
  app.set_version_flag("--version", fmt::format("pectora {}\n{}", PECTORA_VERSION, PECTORA_BUILD_STAMP));
  app.require_subcommand(1);

  const auto common = [&](CLI::App* sub) {
    sub->add_option("--threads", options.threadCount, "Threads to use (default: all cores); results do not depend on it")
        ->check(CLI::Range(1, 1024));
    sub->add_flag("--quiet", options.quiet, "Warnings and errors only on stderr");
  };
  CLI::App* run = app.add_subcommand("run", "Run a Lua script");
  run->set_help_flag();
  run->add_flag("-h,--help", options.scriptHelp, "List the script's own parameters");
  run->add_option("SCRIPT", options.script, "Path of a .lua file, or name of an installed script");
  run->add_option("NAME=VALUE", options.arguments, "The script's parameters");
  run->add_option("--out", options.out, "Folder for results (the script's parameter out)");
  common(run);
  CLI::App* demo = app.add_subcommand("demo", "Make a phantom patient and predict its correction");
  demo->add_option("--out", options.out, "Folder for results (default: demo)");
  common(demo);
  app.add_subcommand("list", "List all plugins");
  CLI::App* describe = app.add_subcommand("describe", "Say what a plugin does, takes and returns");
  describe->add_option("STAGE.NAME", options.id, "The plugin, such as solver.verlet")->required();
  describe->add_flag("--json", options.json, "As JSON");
  CLI::App* explain = app.add_subcommand("explain", "Say which effects a script's scene runs, and why, without solving");
  explain->add_option("SCRIPT", options.script, "Path of a .lua file, or name of an installed script")->required();
  explain->add_option("NAME=VALUE", options.arguments, "The script's parameters");
  explain->add_option("--out", options.out, "Folder for results (the script's parameter out)");
  common(explain);
  CLI::App* view = app.add_subcommand("view", "Open the tool window");
#ifdef PECTORA_VIEW
  view->add_option("PATH", options.window.path, "What to open: a folder of DICOM files or of results, a script, a scan or a preset");
  view->add_option("--tour", options.window.tour, "Write pictures of a tour through the window into this folder, and open none");
  view->add_option("--scale", options.window.scale, "Size of text and panels (default: as the display says)")->check(CLI::Range(0.5, 4.0));
  view->add_option("--width", options.window.width, "Width in pixels (default: as it was last time)")->check(CLI::Range(960, 10000));
  view->add_option("--height", options.window.height, "Height in pixels (default: as it was last time)")->check(CLI::Range(600, 10000));
#endif
  common(view);

  try {
    app.parse(argc, argv);
    if (run->parsed() && options.script.empty()) {
      if (!options.scriptHelp) throw CLI::RequiredError("SCRIPT");
      writeOut(run->help() + kExitCodes + "\n");
      return 0;
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }

  if (options.threadCount > 0) setThreads(options.threadCount);
  std::signal(SIGINT, onInterrupt);
  std::signal(SIGTERM, onInterrupt);
  Console console(options.quiet);
  try {
    return command(app, options, console);
  } catch (const Error& error) {
    console.error(error.what());
    return error.kind() == ErrorKind::badInput ? 2 : 1;
  } catch (const Cancelled&) {
    console.error("cancelled");
    return 3;
  } catch (const std::exception& error) {
    console.error(std::string("internal error: ") + error.what());
    return 1;
  }
}
