// A half cylinder with three ribs and a sternum, for models of the wall.
#pragma once

#include "plugins/model/common/layers.h"

#include <cmath>
#include <numbers>

namespace pectora {

inline constexpr double kSkin = 150, kPleura = 125;

inline LayerSlice halfCircle(double radius, double z) {
  LayerSlice slice{z, {}, false};
  for (int i = 0; i <= 180; ++i) {
    const double t = std::numbers::pi * i / 180;
    slice.points.push_back({-radius * std::cos(t), -radius * std::sin(t), z});
  }
  return slice;
}

// A half cylinder with three rings for ribs and a plate for a sternum, 200 mm high.
inline std::shared_ptr<RibCage> barrel() {
  auto anatomy = std::make_shared<Anatomy>();
  for (int z = 0; z <= 200; z += 2) {
    anatomy->skin.push_back(halfCircle(kSkin, z));
    anatomy->pleura.push_back(halfCircle(kPleura, z));
  }
  anatomy->sternum.contours = {{{-15, -132, 100}, {15, -132, 100}, {15, -126, 100}, {-15, -126, 100}}};
  anatomy->sternum.jugularNotch = {0, -130, 180};
  auto cage = std::make_shared<RibCage>();
  cage->anatomy = anatomy;
  for (int rib = 0; rib < 3; ++rib) {
    Curve curve;
    curve.knots = clampedKnots(4, 3);
    const double z = 30 + 60 * rib;
    curve.controls = {{-130, 0, z}, {-130, -175, z}, {130, -175, z}, {130, 0, z}};
    cage->ribs.push_back({Side::right, rib + 4, curve, 0});
  }
  return cage;
}

inline Scene built(std::shared_ptr<const RibCage> cage, double spacing) {
  Scene scene;
  scene.cage = cage;
  buildLayers({spacing, 20}, scene);
  return scene;
}

}  // namespace pectora
