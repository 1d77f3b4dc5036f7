// A flat wall on a sternum that moves as a whole, to be made hard.
#pragma once

#include "plugins/model/hard_case/hard_case.h"

namespace pectora {

/// A wall and its operation; everything may be changed before `finish`.
struct HardWall {
  std::shared_ptr<Scene> scene = std::make_shared<Scene>();
  std::shared_ptr<Plan> plan = std::make_shared<Plan>();
  std::shared_ptr<Motion> start;

  /// rows x columns points `spacing` mm apart and `thickness` mm from skin to pleura; the middle of the pleura hangs on the
  /// sternum, the rest on ribs, by three anchors a point. The sternum goes `lift` mm forwards.
  HardWall(int rows, int columns, double spacing, double thickness, double lift);

  /// Calls the six effects of springs with skin and wall of these Young's moduli, kPa.
  void callSprings(double skin, double wall, double attachment = 60);
  void callEffect(const std::string& id, Settings settings = {});
  /// A start at rest, to be changed.
  Motion& startAtRest();
  /// Greatest length of the wall at rest, mm.
  double extent() const;
};

}  // namespace pectora
