// The chest wall at rest as layers of points, with the effects that it calls for.
#pragma once

#include "kernel/value/mesh.h"
#include "kernel/value/rib_cage.h"
#include "kernel/value/settings.h"

#include <cstdint>

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

/// What a cell between two layers is made of.
struct Tissue {
  std::string name;                    ///< "fat"
  double youngsModulus = 0;            ///< kPa
  double poissonsRatio = 0;
  double density = 0;                  ///< kg/m^3
};

/// Layers of rows × columns points: `outer` on the skin, `inner` on the pleura, and those `between` them, from skin to
/// pleura; a lattice has none between. Row 0 is the lowest level, column 0 the patient's right. Point (r, c) has index
/// r * columns + c in every layer.
struct Scene : Value {
  static constexpr const char* kName = "Scene";
  std::shared_ptr<const RibCage> cage;
  int rows = 0, columns = 0;
  std::vector<Vec3> outer, inner;         ///< rest positions, mm
  std::vector<std::vector<Vec3>> between; ///< rest positions of the layers between, mm
  std::vector<double> outerMass, innerMass;  ///< kg
  std::vector<std::vector<double>> betweenMass;  ///< kg, as `between`
  std::vector<Tissue> tissues;            ///< of a solid wall; a lattice has none
  std::vector<std::uint8_t> cellTissue;   ///< index into `tissues` of every cell, see `cell`; empty for a lattice
  double rowSpacing = 0, columnSpacing = 0;  ///< mean distance between neighbours on the skin, mm
  double thickness = 0;                      ///< mean distance from skin to pleura over the middle third of the columns, mm
  std::vector<Anchor> anchors;
  std::vector<std::shared_ptr<const EffectCall>> effects;
  double still = 0;                          ///< mm; above 0, points that the operation moves by less need not be computed
  double effectAccuracy = 0;                 ///< mm; above 0, only those of `effects` run that change the skin by about as much

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
  std::vector<std::pair<std::string, std::shared_ptr<const Value>>> parts() const override;
  int index(int row, int column) const { return row * columns + column; }
  /// Of one layer.
  int points() const { return rows * columns; }
  /// The cell between layers l and l + 1 whose first corner is point (r, c): the others lie at r + 1 and c + 1.
  int cell(int l, int r, int c) const { return (l * (rows - 1) + r) * (columns - 1) + c; }
  int cells() const { return (layers() - 1) * (rows - 1) * (columns - 1); }
  int layers() const { return 2 + int(between.size()); }
  /// Layer 0 is `outer`, the last `inner`.
  const std::vector<Vec3>& layer(int l) const { return l == 0 ? outer : l + 1 == layers() ? inner : between[l - 1]; }
  const std::vector<double>& layerMass(int l) const { return l == 0 ? outerMass : l + 1 == layers() ? innerMass : betweenMass[l - 1]; }
};

/// The triangle mesh of one layer; normals point out of the body.
Mesh layerMesh(int rows, int columns, std::vector<Vec3> points);

/// How far each point of the skin lies from its place at rest, mm. `outer` are as many as Scene::outer.
std::vector<double> skinDisplacement(const Scene& scene, const std::vector<Vec3>& outer);
/// The skin with its points elsewhere, and the field "displacement" from rest.
Mesh displacedSkin(const Scene& scene, const std::vector<Vec3>& outer);

}  // namespace pectora
