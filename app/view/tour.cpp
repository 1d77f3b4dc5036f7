#include "app/view/tour.h"

#include "app/view/hand.h"

#include "kernel/stage/error.h"

#include <filesystem>

namespace pectora::view {

void takeTour(Registry& registry, const ViewOptions& options) {
  std::filesystem::create_directories(options.tour);
  const ImGuiHolder imgui;
  const int width = options.width > 0 ? options.width : Layout().width, height = options.height > 0 ? options.height : Layout().height;
  const auto target = makeOffscreen(width, height, options.scale);
  App app(*target, registry, [] {});
  app.context().layout = {};
  Hand hand(app);
  const auto rest = [&] {
    if (!hand.rest(600)) throw Error("the window did not come to rest", ErrorKind::runFailed);
  };
  const auto picture = [&](const char* name) {
    ImGui::GetIO().MousePos = {-1, -1};
    rest();
    // Six bits a colour are enough for a page, and a third smaller.
    std::vector<unsigned char> rgba = target->pixels();
    for (unsigned char& c : rgba) c = static_cast<unsigned char>((c & 0xFC) | c >> 6);
    writePng(options.tour + "/" + name + ".png", width, height, rgba);
  };
  rest();
  picture("opening");
  hand.click("opening.phantom");
  rest();
  picture("patient");
  hand.click("tab.bar");
  hand.frames(3);
  // Up, and back to the lift that the phantom's scan shows.
  hand.drag("bar.lift", {0.50f, 0.5f}, {0.60f, 0.5f});
  hand.drag("bar.lift", {0.60f, 0.5f}, {0.50f, 0.5f});
  picture("bar");
  hand.click("bar.second");
  picture("two_bars");
  hand.click("bar.second");
  rest();
  hand.click("tab.tissue");
  hand.click("effect.cross.open");
  hand.click("effects.measure");
  rest();
  hand.click("scene", 0.5f, 0.45f);
  picture("tissue");
  hand.click("tab.anatomy");
  hand.frames(3);
  hand.click("window.Bone");
  picture("anatomy");
  hand.click("correct");
  hand.click("correct.rib");
  hand.click("correct.Left rib 4");
  hand.click("correct.notch");
  picture("corrections");
  hand.click("anatomy.solid");
  picture("joints");
  hand.click("anatomy.slices");
  hand.click("correct");
  hand.click("tab.compare");
  picture("compare");
  hand.click("landmarks.place");
  picture("landmarks");
  hand.click("landmarks.place");
  hand.click("tab.accuracy");
  hand.frames(3);
  hand.click("study");
  rest();
  picture("accuracy");
  hand.click("tab.script");
  hand.click("console.line");
  hand.type("plan.haller_index, motion.status", true);
  picture("script");
}

}  // namespace pectora::view
