// The main job end to end through the program: phantom, DICOM, prediction, comparison, files; and what must stay equal or stay out.
#include "tests/app/helpers.h"

namespace fs = std::filesystem;
using namespace pectora;

namespace {

int run(const std::string& arguments, const fs::path& log) {
  return exitCode(PECTORA_PROGRAM " " + arguments + " >" + log.string() + " 2>&1");
}

// A coarse phantom and two runs of its correction, made once.
struct Runs {
  fs::path folder;
  std::string table;
};
const Runs& runs() {
  static const Runs made = [] {
    Runs r;
    r.folder = freshFolder("whole_way");
    const fs::path log = r.folder / "log.txt";
    EXPECT_EQ(run("run phantom matrix=256 lift=25 seed=3 out=" + (r.folder / "patient").string(), log), 0) << readFile(log);
    for (const char* name : {"one", "two"}) {
      const fs::path patient = r.folder / "patient";
      EXPECT_EQ(run("run correction lift=25 slices=3 ct=" + (patient / "dicom").string() + " scan=" + (patient / "truth/scan.txt").string() +
                        " landmarks=" + (patient / "truth/landmarks.csv").string() + " out=" + (r.folder / name).string() + (std::string(name) == "two" ? " --threads 1" : ""),
                    log), 0) << readFile(log);
      r.table = readFile(log);
    }
    return r;
  }();
  return made;
}

}  // namespace

TEST(WholeWay, WritesEveryFileThatItNames) {
  const fs::path result = runs().folder / "one";
  const std::string summary = readFile(result / "summary.json");
  for (const char* name : {"before.ply", "after.ply", "bar.ply", "scene.vtp", "ct_vs_simulated.vtp", "scan_vs_simulated.vtp", "scan_vs_simulated.ply", "ct_vs_simulated_reverse.ply", "ct_vs_simulated.png",
                           "scan_vs_simulated.png", "scan_vs_simulated_histogram.csv", "rib_cage.png", "summary.json"}) {
    EXPECT_TRUE(fs::exists(result / name)) << name;
    EXPECT_GT(fs::file_size(result / name), 40u) << name;
    EXPECT_NE(summary.find(std::string("\"") + name + "\""), std::string::npos) << name;
  }
  for (const auto& entry : fs::recursive_directory_iterator(result)) EXPECT_NE(entry.path().extension(), ".part");
}

TEST(WholeWay, PrintsTheTable) {
  for (const char* row : {"ct vs simulated, overlap", "ct vs simulated, pit", "scan vs simulated, overlap", "scan vs simulated, pit", "scan vs simulated, hollow", "scan, hollow, RMS:", "from skin that copies bone (skill ", "Haller index before 4.0"})
    EXPECT_NE(runs().table.find(row), std::string::npos) << row << "\n" << runs().table;
}

TEST(WholeWay, GivesTheSameBytesAgainAndForAnyNumberOfThreadsButForTimes) {
  for (const auto& entry : fs::recursive_directory_iterator(runs().folder / "one")) {
    if (!entry.is_regular_file()) continue;
    const fs::path relative = fs::relative(entry.path(), runs().folder / "one");
    std::string one = readFile(entry.path()), two = readFile(runs().folder / "two" / relative);
    if (relative == "summary.json") {
      // Everything but the last member, "timing".
      one.resize(one.find("\"timing\""));
      two.resize(two.find("\"timing\""));
    }
    EXPECT_TRUE(one == two) << relative;
  }
}

TEST(WholeWay, RecordsEveryStageWithItsSettingsAndNoPath) {
  const std::string summary = readFile(runs().folder / "one/summary.json");
  for (const char* stage : {"loader.dicom", "segmenter.thorax", "splines.cartilage", "model.two_layer", "effect.cross", "planner.nuss", "solver.verlet", "scan.file", "register.landmarks", "comparer.surface"})
    EXPECT_NE(summary.find(std::string("\"stage\": \"") + stage + "\""), std::string::npos) << stage;
  EXPECT_NE(summary.find("xxh128:"), std::string::npos);
  EXPECT_EQ(summary.find(runs().folder.string()), std::string::npos) << "a path may hold a patient's name";
}

TEST(WholeWay, KeepsThePatientsNameOutOfEverything) {
  // The series carries a name; nothing that is written or printed may.
  std::string dicom;
  for (const auto& entry : fs::directory_iterator(runs().folder / "patient/dicom")) dicom = readFile(entry.path());
  ASSERT_NE(dicom.find("PHANTOM"), std::string::npos);
  for (const auto& entry : fs::recursive_directory_iterator(runs().folder / "one")) {
    if (!entry.is_regular_file()) continue;
    EXPECT_EQ(readFile(entry.path()).find("PHANTOM"), std::string::npos) << entry.path();
  }
  EXPECT_EQ(runs().table.find("PHANTOM"), std::string::npos);
}

TEST(WholeWay, PredictsWithTheSolidWallToo) {
  const fs::path log = runs().folder / "solid.txt", out = runs().folder / "solid";
  ASSERT_EQ(run("run correction model=volume_mesh spacing=14 lift=25 slices=0 ct=" + (runs().folder / "patient/dicom").string() + " out=" + out.string(), log), 0) << readFile(log);
  const std::string summary = readFile(out / "summary.json");
  for (const char* stage : {"model.volume_mesh", "effect.tissue"}) EXPECT_NE(summary.find(std::string("\"stage\": \"") + stage + "\""), std::string::npos) << stage;
  EXPECT_NE(readFile(log).find("ct vs simulated, pit"), std::string::npos);
}

TEST(WholeWay, ExplainsWithoutSolving) {
  const fs::path log = runs().folder / "explain.txt";
  ASSERT_EQ(run("explain --quiet correction ct=" + (runs().folder / "patient/dicom").string() + " out=" + (runs().folder / "never").string(), log), 0) << readFile(log);
  const std::string text = readFile(log);
  for (const char* effect : {"effect.stretch", "effect.shear", "effect.bend", "effect.direct", "effect.cross", "effect.attachment", "ms an evaluation"})
    EXPECT_NE(text.find(effect), std::string::npos) << effect << text;
  EXPECT_FALSE(fs::exists(runs().folder / "never"));
}

TEST(WholeWay, TellsAFailedSolverFromBadInput) {
  const fs::path log = runs().folder / "bad.txt";
  EXPECT_EQ(run("run correction ct=/nowhere", log), 2);
  EXPECT_EQ(run("run correction ct=" + (runs().folder / "one").string(), log), 2);
  EXPECT_NE(readFile(log).find("loader.dicom"), std::string::npos) << readFile(log);
}
