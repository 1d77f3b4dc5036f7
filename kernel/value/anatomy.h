// What a segmenter finds in a CT: ribs, sternum, skin and pleura. Positions are LPS mm.
#pragma once

#include "kernel/value/value.h"
#include "kernel/value/vec3.h"

#include <array>
#include <memory>

namespace pectora {

enum class Side { right, left };
inline const char* sideName(Side side) { return side == Side::right ? "right" : "left"; }

/// One rib, tracked through the slices.
struct Rib {
  Side side = Side::right;
  int number = 0;                 ///< 1 to 12; 0 if it could not be told
  std::vector<Vec3> centerline;   ///< from the vertebra to the costochondral junction
  bool reachesVertebra = false;   ///< false: its back end lies outside the CT, or was lost
  bool reachesJunction = false;   ///< false: its front end lies outside the CT, or was lost
};

/// Where a costal cartilage joins the sternum.
struct Notch {
  Side side = Side::right;
  int rib = 0;      ///< 1 to 7
  Vec3 position;
};

/// The sternum as a stack of closed axial contours with its axis.
struct Sternum {
  std::vector<Vec3> axis;                        ///< centroids, from the jugular notch down to the xiphoid
  std::vector<std::vector<Vec3>> contours;       ///< closed, one a slice where it was seen, cranial first
  Vec3 jugularNotch;                             ///< cranial end of the manubrium
  Vec3 manubriosternalJoint;                     ///< angle of Louis
  Vec3 xiphisternalJoint;                        ///< caudal end of the body
  Vec3 deepest;                                  ///< most posterior point of the front surface of the body's caudal half
  double tiltDeg = 0;                            ///< body axis against the z axis, in the sagittal plane
  double torsionDeg = 0;                         ///< body's transverse axis against x; positive: left side deeper
  std::vector<Notch> notches;
};

/// One axial level of a layer: an open line over the front and the sides of the chest, from the patient's right
/// (first point, on the coronal plane) over the front to the left (last point, on the coronal plane).
struct LayerSlice {
  double z = 0;                   ///< LPS z of the level, mm
  std::vector<Vec3> points;
  bool clipped = false;           ///< part of it lies outside the field of view and is not to be trusted
};

/// Haller and correction index at one level (science: Haller 1987, St Peter 2011).
struct LevelMetrics {
  double z = 0;
  double transverse = 0;          ///< T, inner width of the chest, mm
  double sternumToVertebra = 0;   ///< B, mm
  double deepestInnerWall = 0;    ///< C, front of the vertebra to the most anterior inner wall, mm
  double depression() const { return deepestInnerWall - sternumToVertebra; }   ///< of the sternum behind that wall, mm
  double haller() const { return transverse / sternumToVertebra; }
  double correctionIndex() const { return 100 * (deepestInnerWall - sternumToVertebra) / deepestInnerWall; }
};

/// Closed 2-D outlines found in one slice, kept for the overlay pictures.
struct SliceContour {
  int slice = 0;                  ///< index along axis 2 of the CT
  std::string structure;          ///< "rib", "sternum", "vertebra", "scapula", "skin", "pleura", "cartilage"
  int number = 0;                 ///< rib number, else 0
  Side side = Side::right;
  std::vector<Vec3> points;
  bool closed = true;
};

struct Anatomy : Value {
  static constexpr const char* kName = "Anatomy";
  std::vector<Rib> ribs;                     ///< cranial first, right before left
  Sternum sternum;
  std::vector<LayerSlice> skin;              ///< caudal first, equally spaced levels
  std::vector<LayerSlice> pleura;            ///< same levels as skin
  std::vector<Vec3> vertebralFront;          ///< front of the vertebral bodies, caudal first
  std::vector<LevelMetrics> metrics;         ///< every level that has all three lengths, caudal first
  std::vector<SliceContour> contours;

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
  const Rib* rib(Side side, int number) const;   ///< nullptr if not found
  /// The level with the smallest sternum-to-vertebra distance in the caudal half of the sternal body; nullptr if none.
  const LevelMetrics* deepestLevel() const;
};

}  // namespace pectora
