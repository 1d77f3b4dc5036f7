// One virtual patient in one state (before or after the operation): torso, deformity and place in the scanner.
#pragma once

#include "deformity.h"
#include "kernel/value/anatomy.h"
#include "kernel/value/mesh.h"

#include <memory>

namespace pectora::phantom {

/// From the body frame (LPS axes, origin at the vertebral centre at the level of rib 1, unscaled) to the CT:
/// scaled, turned about the z axis through the middle of the chest, then shifted.
struct Pose {
  double scale = 1;
  double turnDeg = 0;
  Vec3 shift;

  Vec3 toCt(Vec3 body) const;
  Vec3 toBody(Vec3 ct) const;
  double levelToCt(double z) const { return z * scale + shift.z; }
  double levelToBody(double z) const { return (z - shift.z) / scale; }
};
constexpr Vec3 kTurnCenter{0, -38, 0};  ///< of the body, which the turn leaves in place

/// One axial level of a deformed body: what each column (line along y) of it does. x and y in the body frame.
class Level {
 public:
  Level(const Torso& torso, const Deformity& deformity, double z);
  /// Displacement along y of the point that stood at (x, y) in the undeformed body.
  double displacement(double x, double y) const;
  /// Where the point now at (x, y) stood in the undeformed body.
  double undeformedY(double x, double y) const;
  /// Displacement of the bone in the column.
  double bone(double x) const { return lookup(bone_, x); }
  double z() const { return z_; }

 private:
  static constexpr int kHalf = 150;  // columns from -150 to 150 mm, one each mm
  double lookup(const std::vector<float>& table, double x) const;
  double z_;
  std::vector<float> bone_, skinMove_, inner_, outer_, skin_;
};

/// The undeformed torso, its deformity and its pose. Positions taken and given are LPS mm of the CT unless said.
struct Body {
  std::shared_ptr<const Torso> torso;
  Deformity deformity;
  Pose pose;

  Level level(double bodyZ) const { return Level(*torso, deformity, bodyZ); }
  /// A point of the undeformed body frame, displaced and placed in the CT.
  Vec3 place(Vec3 undeformed) const;
  /// A surface's point at that angle and level of the body frame, deformed and placed.
  Vec3 surfacePoint(const PolarTable& surface, const Level& level, double angle) const;
  /// Surface of rows along z and columns around the body, as an open tube of triangles.
  std::shared_ptr<const Mesh> tube(const PolarTable& surface, double bottom, double top, double spacing) const;

  /// Levels along the sternal body: caudal and cranial end, body frame.
  double sternalBodyBottom() const;
  double sternalBodyTop() const;
  /// T, B and C at a level of the body frame; B and C are 0 where there is no sternum.
  LevelMetrics measure(double bodyZ) const;
};

}  // namespace pectora::phantom
