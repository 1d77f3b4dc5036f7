// A window on a framebuffer with a hand over it, and a coarse phantom to open.
#pragma once

#include "tests/app/view/walk.h"

#include "tests/app/helpers.h"

namespace pectora::view {

/// So long a window may work, s: tests run beside others.
inline constexpr double kPatience = 500;

/// A phantom that is soon made, on a wall of few points that is soon solved.
inline void makeCoarse(Choices& choices) {
  std::erase_if(choices.effects, [](const EffectChoice& effect) { return effect.plugin.id == "effect.rib_contact" || effect.plugin.id == "effect.volume"; });
  choices.usesIcp = false;
  choices.loader = {"loader.phantom", {{"matrix", 128.0}, {"slice_spacing", 5.0}}};
  assign(choices.model.settings, "spacing", 14.0);
}

/// Keeps what it remembers in a home of its own.
struct Desktop {
  std::string home;
  ImGuiHolder imgui;
  std::unique_ptr<Target> target;
  Registry registry;
  App app;
  Hand hand{app};

  explicit Desktop(const std::string& name, int width = 1280, int height = 800, float scale = 1, std::vector<std::string> plugins = {PECTORA_PLUGINS})
      : home(ownHome(name)), target(makeOffscreen(width, height, scale)), registry(std::move(plugins)), app(*target, registry, [] {}) {}

  Context& context() { return app.context(); }
  const Results& results() { return *app.context().results; }
  /// What it told, line by line: for messages of tests.
  std::string told() {
    std::string text;
    for (const LogLine& line : context().log) text += line.text + "\n";
    return text;
  }
  void rest() { ASSERT_TRUE(hand.rest(kPatience)) << context().activity.stage << " " << context().activity.what; }
  void click(const std::string& name, float x = 0.5f, float y = 0.5f) {
    hand.click(name, x, y);
    rest();
  }
  void openPhantom() {
    rest();
    makeCoarse(context().choices);
    click("opening.phantom");
    ASSERT_TRUE(results().motionValue()) << results().error;
  }
};

}  // namespace pectora::view
