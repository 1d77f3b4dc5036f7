#include "plugins/model/two_layer/wall.h"

#include "plugins/model/common/anchors.h"
#include "plugins/model/two_layer/masses.h"

#include <mutex>

namespace pectora {

std::shared_ptr<const Scene> wallOf(std::shared_ptr<const RibCage> cage, const WallSettings& settings, const std::function<void()>& attaching) {
  static std::mutex mutex;
  static WallSettings lastSettings;
  static std::shared_ptr<const Scene> last;
  {
    const std::lock_guard lock(mutex);
    if (last && last->cage == cage && lastSettings == settings) return last;
  }
  const auto wall = std::make_shared<Scene>();
  wall->cage = std::move(cage);
  buildLayers(settings.layers, *wall);
  weighLayers(settings.density, *wall);
  attaching();
  wall->anchors = findAnchors(*wall, settings.reach);
  const std::lock_guard lock(mutex);
  lastSettings = settings;
  last = wall;
  return wall;
}

}  // namespace pectora
