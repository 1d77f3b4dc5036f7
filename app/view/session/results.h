// What the worker has made of the choices so far. Never changed once it is shown.
#pragma once

#include "app/view/session/choices.h"

#include "kernel/host/compile.h"
#include "kernel/value/anatomy.h"
#include "kernel/value/comparison.h"
#include "kernel/value/motion.h"
#include "kernel/value/plan.h"
#include "kernel/value/volume.h"

#include "kernel/stage/stage.h"

namespace pectora::view {

struct Results {
  Handle ct, segmented, cage, scene, plan, motion;
  Handle anatomy;                  ///< what was segmented, corrected
  Handle before, after, barMesh;   ///< of a result folder
  Handle phantomScan, phantomCtLandmarks, phantomScanLandmarks;
  Handle scan, aligned, byLandmarks, byIcp, comparison;
  std::shared_ptr<const std::vector<double>> scanDistances;   ///< as in scan_distances.h, of the comparison; null if there is none
  std::shared_ptr<const std::vector<Vec3>> skin;   ///< of the scene's points; where the motion is on its way, or has ended
  bool isPreview = false;                          ///< the skin is still on its way
  bool isLive = false;                             ///< the motion began where the last one ended; not yet as the script does
  double liveMs = 0;                               ///< from the change to the skin, of the last live solve
  double solveMs = 0;                              ///< of these the solver's, with the scene's making if that was new
  double settled = -1;                             ///< the largest distance between the live skin and the script's, mm; -1: not known
  std::vector<EffectUse> effects;
  std::string error;                               ///< why there is no more than this

  template <class T>
  static const T* as(const Handle& handle) { return dynamic_cast<const T*>(handle.value.get()); }
  const Volume* volume() const { return as<Volume>(ct); }
  const Anatomy* anatomyValue() const { return as<Anatomy>(anatomy); }
  const RibCage* cageValue() const { return as<RibCage>(cage); }
  const Scene* sceneValue() const { return as<Scene>(scene); }
  const Plan* planValue() const { return as<Plan>(plan); }
  const Motion* motionValue() const { return as<Motion>(motion); }
  const Comparison* comparisonValue() const { return as<Comparison>(comparison); }
};

/// A spring at a picked point.
struct PickedSpring {
  Vec3 from, to;
  double stiffness = 0;       ///< N/mm
  double stretch = 0;         ///< length over rest length, minus one
  double force = 0;           ///< N, positive: it pulls
};

}  // namespace pectora::view
