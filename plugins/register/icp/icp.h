// Robust point-to-plane alignment of a scan with a surface, on what the operation does not change.
#pragma once

#include "plugins/common/surface/surface_tree.h"

#include "kernel/value/comparison.h"

namespace pectora {

struct IcpSettings {
  double maxDistance = 30;       ///< points further away have no counterpart, mm
  double overlap = 1;            ///< share of the points with a counterpart that is kept, the nearest ones
  double normalAngle = 70;       ///< largest angle between the normals of a point and its counterpart, degrees
  double changeThreshold = 2;    ///< the changed region is where the two given surfaces differ by more than this, mm
  double changeMargin = 10;      ///< and what lies within this of it, mm
  Vec3 ballCenter;               ///< what lies in this ball (of the fixed surface) is left out, too; mm
  double ballRadius = 0;
  int coarsePoints = 5000;       ///< of the first level; each further one has ten times as many, the last one all
  int maxIterations = 100;       ///< over all levels
  double tolerance = 0.005;      ///< converged when no point moves further in one iteration, mm; the next would move about a sixth of it
  int finePoints = 2000000;       ///< of the last level, at most
};

/// The moving points, with their normals if they are known.
struct MovingPoints {
  const std::vector<Vec3>& points;
  const std::vector<Vec3>& normals;   ///< unit, outward; one a point, or none
};

/// Aligns the moving points with `fixed` by a rigid map. Each iteration pairs every point with the nearest point of the surface and
/// minimises the distances along the normals (Chen and Medioni 1992) with Tukey's weights (scale from the median absolute
/// distance), first on few points, then on more. Left out: counterparts on the border of `fixed`; further than maxDistance; with
/// another normal; where `fixed` and `changed` (the predicted surface; may be null) differ; in the ball; beyond the overlap.
/// A twentieth of the points is held out, to be measured at the end.
///
/// The result's rms is that of the distances of the points that take part. Details: status ("converged", "stopped": maxIterations was too few,
/// "undetermined": the points leave a direction free, which then stays as it was), iterations, used and left-out points,
/// held_out_rms, condition, weakest_direction with its standard deviation, and expected_error: RMS over all moving points of the
/// error that the distances' spread causes if they are independent (a lower bound for a real scanner).
/// Throws Error if too few points take part. `poll` is called with the fraction done, and may throw.
Registration alignSurface(const MovingPoints& moving, const Mesh& fixed, const Mesh* changed, const IcpSettings& settings,
                          const std::function<void(double)>& poll);

}  // namespace pectora
