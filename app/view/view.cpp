#include "app/view/view.h"

#include "app/view/app.h"
#include "app/view/tour.h"

namespace pectora::view {

void runView(Registry& registry, const ViewOptions& options) {
  if (!options.tour.empty()) {
    takeTour(registry, options);
    return;
  }
  const ImGuiHolder imgui;
  Layout last;
  last.load();
  const auto target = makeWindow(options.width > 0 ? options.width : last.width, options.height > 0 ? options.height : last.height, options.scale);
  App app(*target, registry, [] { wakeWindow(); });
  if (!options.path.empty()) app.context().open(options.path);
  // Frames are drawn when something happens, and not otherwise.
  while (target->wait(app.untilFrame())) app.frame();
  app.keepLayout();
}

}  // namespace pectora::view
