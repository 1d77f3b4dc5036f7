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
  bool isGiven = false;   ///< set by hand: the cartilage ends there, whatever the CT shows
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

/// Lengths of the chest at one axial level, mm, in the axes of the patient (turned about z as he lies), and the indices made of
/// them. 0: not known. All depths of the bony chest are counted forwards from the front of the vertebral body, those of the skin
/// from its most posterior point at that level.
struct LevelMetrics {
  double z = 0;
  double transverse = 0;          ///< T, inner width of the chest
  double sternumToVertebra = 0;   ///< B, to the most posterior point of the sternum
  double deepestInnerWall = 0;    ///< C, to the most anterior point of the inner wall
  double rightDepth = 0;          ///< as C, of the patient's right half alone
  double leftDepth = 0;           ///< as C, of his left half alone
  double eccentricity = 0;        ///< how far B's point lies to the left of the vertebra's middle; negative: right
  double torsionDeg = 0;          ///< of the sternum's section, degrees; positive: left side deeper
  double externalWidth = 0;       ///< of the skin, arms excluded as far as the segmentation could
  double externalPit = 0;         ///< depth of the chest where the skin lies deepest between its two summits
  double externalFront = 0;       ///< depth of the chest at the most anterior skin
  double concavityArea = 0;       ///< between the skin and its convex hull, from summit to summit, mm^2

  double depression() const { return deepestInnerWall - sternumToVertebra; }   ///< C - B, of the sternum behind the wall, mm
  double haller() const { return transverse / sternumToVertebra; }             ///< T / B (Haller 1987)
  double correctionIndex() const { return 100 * depression() / deepestInnerWall; }   ///< 100 (C - B) / C, % (St Peter 2011)
  double depressionIndex() const { return deepestInnerWall / sternumToVertebra; }    ///< C / B (after Park)
  /// Greater over lesser depth of the two halves (after Park).
  double asymmetry() const { return rightDepth > leftDepth ? rightDepth / leftDepth : leftDepth / rightDepth; }
  double flatness() const { return transverse / (rightDepth > leftDepth ? rightDepth : leftDepth); }   ///< T / greatest depth
  double externalHaller() const { return externalWidth / externalPit; }        ///< width / depth at the pit, on the skin
  double externalCorrectionIndex() const { return 100 * (externalFront - externalPit) / externalFront; }   ///< %
};

/// Slices of which something must be known before they are trusted.
struct SliceRange {
  std::string what;     ///< "clipped skin", "metal", "missing slices", "thick slices"
  double low = 0, high = 0;   ///< LPS z, mm
  std::string meaning;  ///< what it does to the result, in words
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
  double turnDeg = 0;                        ///< how far the patient is turned about z against x; positive: his left side to the back
  std::vector<SliceRange> ranges;            ///< what is wrong with the CT, and where

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
  const Rib* rib(Side side, int number) const;   ///< nullptr if not found
  /// The level with the smallest sternum-to-vertebra distance in the caudal half of the sternal body; nullptr if none.
  const LevelMetrics* deepestLevel() const;
};

}  // namespace pectora
