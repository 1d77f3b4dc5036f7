// From choices to results, without a window.
#include "app/view/session/script_text.h"
#include "app/view/session/worker.h"

#include "tests/app/helpers.h"

using namespace pectora;
using namespace pectora::view;

namespace {

double largestDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, distance(a[i], b[i]));
  return largest;
}

struct Desk {
  Registry registry{{PECTORA_PLUGINS}};
  // On the worker's own thread, at the first that it tells: a busy machine may let this one sleep until the work is done.
  std::atomic<bool> cancelsAtOnce{false};
  Worker worker{registry, [this] {
                  if (cancelsAtOnce.exchange(false)) worker.cancel();
                }};
  Choices choices = initialChoices({"solver.newton"});

  Desk() {
    choices.source = Source::phantom;
    choices.loader = {"loader.phantom", {{"matrix", 128.0}, {"slice_spacing", 5.0}}};
    assign(choices.model.settings, "spacing", 14.0);
    assign(choices.planner.settings, "lift", 15.0);
  }
  void leaveOut(const std::string& id) {
    std::erase_if(choices.effects, [&](const EffectChoice& effect) { return effect.plugin.id == id; });
  }
  // Wishes, and waits until the worker has nothing more to do.
  std::shared_ptr<const Results> after(const Choices& wish, bool isDragging = false) {
    worker.want(wish, isDragging);
    wait();
    return worker.results();
  }
  void wait() {
    for (int quiet = 0; quiet < 20; quiet = worker.activity().isBusy ? 0 : quiet + 1) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
};

}  // namespace

TEST(Pipeline, GoesAllTheWayToAComparisonWithThePhantomsScan) {
  Desk s;
  const auto r = s.after(s.choices);
  EXPECT_EQ(r->error, "");
  ASSERT_TRUE(r->motionValue());
  EXPECT_EQ(r->motionValue()->status, SolveStatus::converged);
  ASSERT_TRUE(r->comparisonValue());
  EXPECT_GT(r->comparisonValue()->overlap.count, 1000u);
  EXPECT_EQ(r->effects.size(), 8u);
}

TEST(Pipeline, LiveSkinEndsAsTheScriptsDoes) {
  Desk s;
  assign(s.choices.planner.settings, "lift", 5.0);
  s.after(s.choices);
  assign(s.choices.planner.settings, "lift", 6.0);
  const auto live = s.after(s.choices, true);
  ASSERT_TRUE(live->skin);
  EXPECT_TRUE(live->isLive);
  EXPECT_FALSE(live->motion.record) << "a skin that rests on the way there has no provenance";
  const auto settled = s.after(s.choices, false);
  EXPECT_FALSE(settled->isLive);
  EXPECT_TRUE(settled->motion.record);
  // What the window says is what there is, and at this lift there is one way to settle.
  EXPECT_NEAR(settled->settled, largestDistance(*live->skin, *settled->skin), 1e-12);
  EXPECT_LT(settled->settled, 0.1);
}

TEST(Pipeline, GoesOnFromTheSkinWhenASpringConstantChanges) {
  Desk s;
  const auto before = s.after(s.choices);
  assign(s.choices.effects[4].plugin.settings, "youngs_modulus", 20.0);
  const auto after = s.after(s.choices, true);
  EXPECT_TRUE(after->isLive);
  EXPECT_EQ(after->ct.value, before->ct.value);
  EXPECT_GT(largestDistance(*before->skin, *after->skin), 0.01);
}

TEST(Pipeline, KeepsTheWallWhileASpringConstantMovesAndSettlesOnOneThatTheModelMade) {
  Desk s;
  s.after(s.choices);
  assign(s.choices.effects[4].plugin.settings, "youngs_modulus", 20.0);
  const auto live = s.after(s.choices, true);
  ASSERT_TRUE(live->isLive);
  EXPECT_FALSE(live->scene.record) << "no stage made it";
  const auto settled = s.after(s.choices, false);
  ASSERT_TRUE(settled->scene.record);
  ASSERT_TRUE(settled->motion.record);
  // Both are the same wall under the same springs.
  const Scene &moving = *live->sceneValue(), &made = *settled->sceneValue();
  EXPECT_EQ(moving.outer, made.outer);
  EXPECT_EQ(moving.inner, made.inner);
  ASSERT_EQ(moving.effects.size(), made.effects.size());
  for (std::size_t i = 0; i < made.effects.size(); ++i) {
    EXPECT_EQ(moving.effects[i]->id, made.effects[i]->id);
    EXPECT_EQ(moving.effects[i]->settings, made.effects[i]->settings);
  }
  // As when all is computed from the beginning.
  Desk fresh;
  EXPECT_EQ(*fresh.after(s.choices)->skin, *settled->skin);

  // Another spacing is another wall.
  assign(s.choices.model.settings, "spacing", 16.0);
  const auto other = s.after(s.choices, true);
  EXPECT_TRUE(other->scene.record);
  EXPECT_LT(other->sceneValue()->outer.size(), made.outer.size());
}

TEST(Pipeline, TellsAnErrorKeepsWhatWasThereAndRecovers) {
  Desk s;
  s.after(s.choices);
  Choices wrong = s.choices;
  for (EffectChoice& effect : wrong.effects) effect.isOn = false;
  const auto broken = s.after(wrong);
  EXPECT_NE(broken->error, "");
  EXPECT_TRUE(broken->cage.value);
  const auto mended = s.after(s.choices);
  EXPECT_EQ(mended->error, "");
  EXPECT_EQ(mended->motionValue()->status, SolveStatus::converged);
}

TEST(Pipeline, StopsAtOnceWhenCancelledAndGoesOnWhenAsked) {
  Desk s;
  assign(s.choices.loader.settings, "matrix", 512.0);
  s.cancelsAtOnce = true;
  EXPECT_FALSE(s.after(s.choices)->motionValue());
  assign(s.choices.loader.settings, "matrix", 128.0);
  EXPECT_TRUE(s.after(s.choices)->motionValue());
}

TEST(Pipeline, TellsTheSpringsOfAPointInBalance) {
  Desk s;
  s.leaveOut("effect.volume");   // which pushes beside the springs
  const auto r = s.after(s.choices);
  std::vector<PickedSpring> springs;
  const int point = r->sceneValue()->index(r->sceneValue()->rows / 2, r->sceneValue()->columns / 2);
  s.worker.run("springs", [&](Pipeline& pipeline) { springs = pipeline.springsAt(point); });
  s.wait();
  // Stretch 4, shear 4, bend 16, through the wall 25.
  EXPECT_EQ(springs.size(), 49u);
  Vec3 sum;
  double largest = 0;
  for (const PickedSpring& spring : springs) {
    sum += normalized(spring.to - spring.from) * spring.force;
    largest = std::max(largest, std::abs(spring.force));
  }
  EXPECT_LT(norm(sum), 1e-4 * largest) << "a point at rest";
}

TEST(Pipeline, MeasuresWhatEachEffectChanges) {
  Desk s;
  s.leaveOut("effect.volume");
  s.after(s.choices);
  std::vector<EffectWorth> worths;
  s.worker.run("effects", [&](Pipeline& pipeline) { worths = pipeline.measureEffects([](double, const std::string&) {}); });
  s.wait();
  const std::vector<std::string> ids = s.registry.ids();
  ASSERT_EQ(std::ptrdiff_t(worths.size()), std::count_if(ids.begin(), ids.end(), [](const std::string& id) { return id.starts_with("effect."); }));
  EXPECT_EQ(std::count_if(worths.begin(), worths.end(), [](const EffectWorth& w) { return w.isOn; }), 7);
  const auto of = [&](const std::string& id) { return *std::find_if(worths.begin(), worths.end(), [&](const EffectWorth& w) { return w.id == id; }); };
  EXPECT_GT(of("effect.cross").largest, of("effect.bend").largest);
  for (const EffectWorth& w : worths) EXPECT_LE(w.rms, w.largest) << w.id;
  EXPECT_NE(of("effect.attachment").refused, "") << "nothing else holds the wall";
  EXPECT_NE(of("effect.tissue").idle, "") << "a lattice has no solid cells";
  EXPECT_GT(of("effect.volume").largest, 0.1) << "not in the scene, and would change it";
  // What taking it in was told to change is what it changes.
  const auto before = s.worker.results();
  s.choices.effects.push_back({{"effect.volume"}, true});
  const auto after = s.after(s.choices);
  EXPECT_NEAR(largestDistance(*before->skin, *after->skin), of("effect.volume").largest, 0.2) << "both have come to rest, but from different sides";
}

TEST(Pipeline, ConsoleSeesTheResultsAndPresetsComeBack) {
  Desk s;
  s.after(s.choices);
  s.worker.takeLog();
  s.worker.run("console", [](Pipeline& pipeline) { pipeline.evaluate("motion.status, plan.lift"); });
  s.wait();
  std::string printed;
  for (const LogLine& line : s.worker.takeLog())
    if (line.kind == LogLine::Kind::print) printed += line.text;
  EXPECT_EQ(printed, "converged\t15.0");

  const std::filesystem::path path = freshFolder("preset") / "mine.lua";
  Choices tuned = s.choices;
  tuned.effects[1].isOn = false;
  assign(tuned.effects[0].plugin.settings, "youngs_modulus", 222.0);
  tuned.solver.id = "solver.lbfgs";
  std::ofstream(path) << presetOf(tuned);
  Choices loaded = s.choices;
  s.worker.run("preset", [&](Pipeline& pipeline) { loaded = pipeline.openedScript(s.choices, path.string()); });
  s.wait();
  EXPECT_FALSE(loaded.effects[1].isOn);
  EXPECT_EQ(std::get<double>(*find(loaded.effects[0].plugin.settings, "youngs_modulus")), 222);
  EXPECT_EQ(loaded.solver.id, "solver.lbfgs");
  EXPECT_EQ(std::get<double>(*find(loaded.planner.settings, "lift")), 15);
}

TEST(Pipeline, OpensTheScriptThatTheWindowShowsAsWhatTheWindowShowed) {
  Desk s;
  assign(s.choices.planner.settings, "lift", 21.5);
  assign(s.choices.effects[4].plugin.settings, "youngs_modulus", 33.0);
  s.choices.effects.erase(s.choices.effects.begin() + 2);
  s.choices.effects.push_back({{"effect.j_curve"}, true});
  assign(s.choices.registration.settings, "method", std::string("similarity"));
  assign(s.choices.icp.settings, "overlap", 0.9);
  assign(s.choices.comparer.settings, "bin_width", 0.25);
  assign(s.choices.segmenter.settings, "pleura_depth", 8.0);
  assign(s.choices.splines.settings, "control_spacing", 22.0);
  // As if they had been placed by hand, a millimetre beside the phantom's own.
  const auto own = s.after(s.choices);
  s.choices.ctLandmarks.points = Results::as<Landmarks>(own->phantomCtLandmarks)->points;
  s.choices.scanLandmarks.points = Results::as<Landmarks>(own->phantomScanLandmarks)->points;
  s.choices.ctLandmarks.points[0].position.x += 1;
  const std::filesystem::path folder = freshFolder("script");
  std::ofstream(folder / "session.lua") << scriptOf(s.choices);
  Choices opened = initialChoices({"solver.verlet"});
  s.worker.run("script", [&](Pipeline& pipeline) { opened = pipeline.openedScript(opened, (folder / "session.lua").string()); });
  s.wait();
  for (const LogLine& line : s.worker.takeLog()) EXPECT_NE(line.kind, LogLine::Kind::error) << line.text;
  EXPECT_EQ(firstDifference(opened, s.choices), Step::nothing) << scriptOf(opened);
  EXPECT_FALSE(std::filesystem::exists("result")) << "nothing is written unasked";
  // And the prediction is found again where the script left it.
  EXPECT_TRUE(s.after(opened)->motion.record);
}

TEST(Pipeline, SaysWhatIsWrongWithAScriptThatPredictsNothing) {
  Desk s;
  const std::filesystem::path path = freshFolder("no_script") / "half.lua";
  std::ofstream(path) << "local ct = loader.phantom{ matrix = 128, slice_spacing = 5 }\n";
  s.worker.takeLog();
  s.worker.run("script", [&](Pipeline& pipeline) { pipeline.openedScript(s.choices, path.string()); });
  s.wait();
  std::string told;
  for (const LogLine& line : s.worker.takeLog())
    if (line.kind == LogLine::Kind::error) told += line.text;
  EXPECT_NE(told.find("no prediction"), std::string::npos) << told;
}

TEST(Pipeline, StudiesWhatAccuracyCosts) {
  Desk s;
  s.after(s.choices);
  Study study;
  s.worker.run("study", [&](Pipeline& pipeline) { study = pipeline.study([](double, const std::string&) {}); });
  s.wait();
  ASSERT_GE(study.points.size(), 9u);
  // Newton from 1e-2 to 1e-6 comes nearer to its own answer at 1e-8; the run that is shown is there once.
  std::vector<double> newton;
  int present = 0;
  for (const StudyPoint& p : study.points) {
    present += p.isPresent;
    if (p.solver == "solver.newton" && !p.isPresent) newton.push_back(p.rms);
    EXPECT_GT(p.milliseconds, 0);
  }
  EXPECT_EQ(present, 1);
  ASSERT_EQ(newton.size(), 4u);
  EXPECT_LT(newton[3], 0.1 * newton[0] + 1e-9);
  EXPECT_LT(newton[3], 1e-4);
}

TEST(Pipeline, SolvesASolidThatHasAModelOfItsOwn) {
  Desk s;
  Choices solid = s.choices;
  solid.model.id = "model.volume_mesh";
  for (EffectChoice& effect : solid.effects) effect.isOn = effect.plugin.id != "effect.direct" && effect.plugin.id != "effect.cross";
  solid.effects.push_back({{"effect.tissue"}, true});
  const auto r = s.after(solid);
  EXPECT_EQ(r->error, "");
  ASSERT_TRUE(r->motionValue());
  EXPECT_FALSE(r->motionValue()->between.empty());
  // A picked point's springs are told here, too.
  std::vector<PickedSpring> springs;
  s.worker.run("springs", [&](Pipeline& pipeline) { springs = pipeline.springsAt(r->sceneValue()->index(3, 3)); });
  s.wait();
  for (const PickedSpring& spring : springs) EXPECT_LT(distance(spring.from, spring.to), 100) << "neighbours of one skin";
}

TEST(Pipeline, TellsLiftAndForceWhereTheBarGivesWay) {
  Desk s;
  s.choices.effects.push_back({{"effect.cartilage_bending"}, true});
  s.choices.effects.push_back({{"effect.bar_compliance"}, true});
  const auto r = s.after(s.choices);
  EXPECT_EQ(r->error, "");
  ASSERT_TRUE(r->motionValue());
  EXPECT_LT(r->motionValue()->lift, 15);
  EXPECT_GT(r->motionValue()->barForce(), 0);
  // What moves goes on from there, with the bar's own guides among the anchors.
  assign(s.choices.planner.settings, "lift", 16.0);
  EXPECT_TRUE(s.after(s.choices, true)->isLive);
}

TEST(Pipeline, ExportsWhatScriptsExport) {
  Desk s;
  s.after(s.choices);
  const std::filesystem::path folder = freshFolder("export");
  s.worker.run("export", [&](Pipeline& pipeline) { pipeline.exportTo(folder.string()); });
  s.wait();
  for (const char* file : {"summary.json", "after.ply", "bar.ply", "scan_vs_simulated.vtp"}) EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;

  // And what was exported is opened again, as a folder of results.
  const auto made = s.worker.results();
  Choices kept = s.choices;
  kept.source = Source::result;
  kept.loader = {"", {{"path", folder.string()}}};
  kept.ctLandmarks = kept.scanLandmarks = {};
  const auto r = s.after(kept);
  EXPECT_EQ(r->error, "");
  EXPECT_FALSE(r->motionValue());
  const auto* after = Results::as<Mesh>(r->after);
  ASSERT_TRUE(after);
  EXPECT_TRUE(Results::as<Mesh>(r->barMesh));
  EXPECT_LT(largestDistance(made->motionValue()->outer, after->points), 1e-3) << "files hold floats";
  // Its script runs by itself.
  std::ofstream(folder / "compare.lua") << scriptOf(kept);
  const std::string command = "cd " + folder.string() + " && " PECTORA_PROGRAM " run --quiet compare.lua > out.txt 2> err.txt";
  EXPECT_EQ(exitCode(command), 0) << readFile(folder / "err.txt") << scriptOf(kept);
}
