// Single panels: what they offer, and what becomes of it.
#include "tests/app/view/desk.h"

#include "app/view/session/script_text.h"

using namespace pectora;
using namespace pectora::view;

namespace {

// So high that nothing needs to be scrolled to.
struct HighDesktop : Desktop {
  explicit HighDesktop(const std::string& name) : Desktop(name, 1280, 4200) {}
  void expectControls(const std::string& id, const std::string& marks, const std::vector<std::string>& hidden = {}) {
    for (const Parameter& p : context().catalog.parameters(id)) {
      if (p.role != TextRole::plain || p.name == kAcceptUnconverged || std::find(hidden.begin(), hidden.end(), p.name) != hidden.end()) continue;
      EXPECT_TRUE(hand.sees(marks + "." + p.name)) << marks << "." << p.name;
    }
  }
};

}  // namespace

TEST(Panels, OfferEveryParameterOfTheActiveStages) {
  HighDesktop desk("view_parameters_home");
  desk.openPhantom();
  desk.context().choices.usesIcp = true;
  desk.context().changed(false);
  desk.click("phantom.open");
  desk.expectControls("loader.phantom", "phantom");
  desk.click("tab.anatomy");
  for (const char* id : {"segmenter.thorax", "splines.cartilage"}) {
    desk.click(std::string(id) + ".open");
    desk.expectControls(id, id);
  }
  desk.click("tab.bar");
  desk.click("bar.second");
  desk.click("bar.shape.open");
  desk.expectControls("planner.nuss", "bar");
  desk.click("tab.tissue");
  for (const EffectChoice& effect : desk.context().choices.effects) {
    desk.click(effect.plugin.id + ".open");
    desk.expectControls(effect.plugin.id, effect.plugin.id);
  }
  desk.expectControls("model.two_layer", "model");
  desk.expectControls(desk.context().choices.solver.id, "solver");
  desk.click("tab.compare");
  desk.expectControls("register.landmarks", "registration");
  desk.click("icp.open");
  desk.expectControls("register.icp", "icp");
  desk.click("comparer.open");
  desk.expectControls("comparer.surface", "comparer", {"name"});
  EXPECT_EQ(desk.results().error, "");
}

TEST(Panels, ColourTheSkinByItsDistanceFromTheScan) {
  Desktop desk("view_distance_home");
  desk.openPhantom();
  const auto distances = desk.results().scanDistances;
  ASSERT_TRUE(distances);
  const std::vector<Vec3>& skin = *desk.results().skin;
  ASSERT_EQ(distances->size(), skin.size());
  // The scan is nowhere farther than its nearest point, but for the 5 mm that a point of a cloud may lie aside.
  const auto* scan = dynamic_cast<const Points*>(desk.results().comparisonValue()->sample.get());
  ASSERT_TRUE(scan);
  int known = 0;
  for (std::size_t i = 0; i < skin.size(); i += 17) {
    if (!std::isfinite((*distances)[i])) continue;
    double nearest = INFINITY;
    for (const Vec3& p : scan->points) nearest = std::min(nearest, distance(p, skin[i]));
    EXPECT_LE(std::abs((*distances)[i]), nearest + 5) << i;
    EXPECT_LE(nearest, std::abs((*distances)[i]) + 5) << i;
    ++known;
  }
  EXPECT_GT(known, 10);

  const auto before = desk.target->pixels();
  desk.click("skin");
  desk.click("skin.Distance");
  EXPECT_EQ(desk.context().scene.skin, SkinLook::distance);
  const ImVec2 low = desk.hand.place("scene", 0, 0), high = desk.hand.place("scene", 1, 1);
  const ImVec4 scene{low.x, low.y, high.x - low.x, high.y - low.y};
  EXPECT_GT(meanDifference(before, desk.target->pixels(), 1280, scene), 3);
  EXPECT_EQ(openGlErrors(), 0);
}

TEST(Panels, DrawATurntablePictureByPictureAndStopItWhenAsked) {
  Desktop desk("view_turntable_home");
  desk.openPhantom();
  desk.click("tab.script");
  desk.hand.click("export.folder");
  desk.hand.control('a');
  desk.hand.type(desk.home, true);
  const auto pictures = [&] {
    const std::filesystem::path folder = desk.home + "/turntable";
    return !std::filesystem::exists(folder) ? 0 : std::distance(std::filesystem::directory_iterator(folder), {});
  };
  desk.hand.click("turntable");
  ASSERT_TRUE(desk.context().turntable);
  const auto first = pictures();
  desk.hand.frames(1);
  EXPECT_EQ(pictures(), first + 1) << "one with each frame";
  desk.hand.click("cancel");
  EXPECT_FALSE(desk.context().turntable);
  EXPECT_LT(pictures(), Turntable::kPictures);
  desk.click("turntable");
  EXPECT_FALSE(desk.context().turntable);
  EXPECT_EQ(pictures(), Turntable::kPictures);

  // A place that cannot be written is told, and nothing ends.
  desk.context().turntable = Turntable{desk.home + "/turntable/turn_000.png"};
  desk.rest();
  EXPECT_FALSE(desk.context().turntable);
  EXPECT_NE(desk.context().message, "");
  desk.context().message.clear();
  desk.context().wantedPicture = "/nowhere/at/all.png";
  desk.hand.frames(1);
  EXPECT_NE(desk.context().message.find("cannot be written"), std::string::npos) << desk.context().message;
  EXPECT_EQ(openGlErrors(), 0);
}

TEST(Panels, TellWhatEffectsChangeThatAreOnAndThatAreNot) {
  HighDesktop desk("view_worth_home");
  desk.openPhantom();
  desk.click("tab.tissue");
  EXPECT_FALSE(desk.hand.sees("effect.cross.worth"));
  desk.click("effects.measure");
  EXPECT_TRUE(desk.hand.sees("effect.cross.worth"));
  EXPECT_TRUE(desk.hand.sees("effect.volume.worth"));
  desk.click("effect.volume");
  EXPECT_FALSE(desk.hand.sees("effect.cross.worth")) << "of another scene";
}

TEST(Panels, KeepTheirWidthsAndTheWindowsSize) {
  Desktop desk("view_layout_home", 1400, 900);
  desk.rest();
  desk.hand.drag("split.left", {0.5f, 0.5f}, {0.5f + 8, 0.5f});   // by eight times its own width, of 5 pixels
  desk.app.keepLayout();
  Layout kept;
  kept.load();
  EXPECT_NEAR(kept.left, Layout().left + 40, 1);
  EXPECT_EQ(kept.width, 1400);
  EXPECT_EQ(kept.height, 900);
  // What is damaged is not taken.
  std::ofstream(desk.home + "/pectora/layout") << "344 264 nonsense";
  Layout damaged;
  damaged.load();
  EXPECT_EQ(damaged.width, Layout().width);
}

TEST(Panels, CopySaveAndLoadWhatWasTuned) {
  HighDesktop desk("view_preset_home");
  desk.openPhantom();
  desk.click("tab.tissue");
  desk.click("effect.bend");
  desk.click("preset.copy");
  EXPECT_EQ(std::string(ImGui::GetClipboardText()), presetOf(desk.context().choices));
  desk.click("preset.save");
  desk.click("effect.bend");
  const auto isOn = [&] {
    const auto& effects = desk.context().choices.effects;
    return std::find_if(effects.begin(), effects.end(), [](const EffectChoice& e) { return e.plugin.id == "effect.bend"; })->isOn;
  };
  EXPECT_TRUE(isOn());
  desk.click("preset.load");
  desk.click("preset.my preset");
  EXPECT_FALSE(isOn()) << desk.told();
  desk.click("undo");
  EXPECT_TRUE(isOn()) << "a preset is one step";
  desk.click("tab.script");
  desk.click("script.copy");
  EXPECT_EQ(std::string(ImGui::GetClipboardText()), scriptOf(desk.context().choices));
}

TEST(Panels, ConsoleBringsBackEarlierLines) {
  Desktop desk("view_console_home");
  desk.rest();
  desk.click("tab.script");
  desk.hand.click("console.line");
  for (const char* line : {"print(1 + 1)", "print(2 + 3)"}) {
    desk.hand.type(line, true);
    desk.rest();
  }
  ImGuiIO& io = ImGui::GetIO();
  for (int i = 0; i < 2; ++i)
    for (bool isDown : {true, false}) io.KeysDown[io.KeyMap[ImGuiKey_UpArrow]] = isDown, desk.hand.frames(1);
  desk.hand.type("", true);
  desk.rest();
  int twos = 0;
  for (const LogLine& line : desk.context().log) twos += line.kind == LogLine::Kind::print && line.text == "2";
  EXPECT_EQ(twos, 2) << desk.told();
}
