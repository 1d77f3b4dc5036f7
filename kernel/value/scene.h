// The two-layer model of the chest wall at rest, with the effects that it calls for.
#pragma once

#include "kernel/value/mesh.h"
#include "kernel/value/rib_cage.h"
#include "kernel/value/settings.h"

namespace pectora {

/// An effect that a scene asks for: the plugin's id and the settings that the script gave.
struct EffectCall : Value {
  static constexpr const char* kName = "Effect";
  std::string id;        ///< "effect.stretch"
  Settings settings;

  const char* kind() const override { return kName; }
};

enum class BodyKind {
  rib,
  cartilage,
  sternum,
  still,   ///< what the operation does not move: the abdomen behind the wall below the costal arch, skin beyond the model
};

/// Where a point hangs on a body: a material point of that body.
struct Anchor {
  int point = 0;                       ///< index into Scene::inner, or Scene::outer if it is on the skin
  BodyKind body = BodyKind::rib;
  int index = 0;                       ///< into RibCage::ribs or ::cartilages; 0 for the others
  double u = 0;                        ///< curve parameter of the material point; of a rib or cartilage only
  Vec3 rest;                           ///< its position at rest, mm
  bool isOnSkin = false;               ///< holds the skin at the model's edge, where skin beyond the model goes on
};

/// Two layers of rows × columns points: `outer` on the skin, `inner` on the pleura. Row 0 is the lowest level,
/// column 0 the patient's right. Point (r, c) has index r * columns + c in both layers.
struct Scene : Value {
  static constexpr const char* kName = "Scene";
  std::shared_ptr<const RibCage> cage;
  int rows = 0, columns = 0;
  std::vector<Vec3> outer, inner;         ///< rest positions, mm
  std::vector<double> outerMass, innerMass;  ///< kg
  double rowSpacing = 0, columnSpacing = 0;  ///< mean distance between neighbours on the skin, mm
  double thickness = 0;                      ///< mean distance from skin to pleura over the middle third of the columns, mm
  std::vector<Anchor> anchors;
  std::vector<std::shared_ptr<const EffectCall>> effects;

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
  std::vector<std::pair<std::string, std::shared_ptr<const Value>>> parts() const override;
  int index(int row, int column) const { return row * columns + column; }
  int points() const { return rows * columns; }
};

/// The triangle mesh of one layer; normals point out of the body.
Mesh layerMesh(int rows, int columns, std::vector<Vec3> points);

}  // namespace pectora
