// The sternum: a contour a slice, its axis, its joints and the places where cartilages join it.
#pragma once

#include "plugins/segmenter/thorax/outline.h"
#include "plugins/segmenter/thorax/spine.h"

#include "kernel/value/anatomy.h"

namespace pectora::thorax {

/// The sternum's contour in one slice, local mm.
struct SternumSlice {
  int slice = 0;
  Loop contour;
  Shape shape;
  bool isSeen = false;     ///< false: interpolated between its neighbours (an unossified joint)
};

/// Finds the sternum, cranial slice first. A path is followed through the slices by dynamic programming like the
/// spine's: bone in a box of 24 x 10 mm, less the bone before and behind it, in front of the spine and at most 70 mm
/// below the skin; the midline is the straight line x(z) that most of it lies on. In each slice the contours at `boneHu`
/// within 24 mm (manubrium: 34 mm) aside and 20 mm before or behind are taken whose middle is at most 18 mm aside (not calcified
/// cartilage, nor a clavicle's head), and their convex hull (outlineIn). The sternum is the longest run of slices in which bone crosses
/// the midline, with gaps of up to 12 mm; from its upper end it goes on, hardly wider from slice to slice, as long as there is bone:
/// between the clavicles' heads the path may have strayed to one of them. Where bone goes on beyond a window, the edge runs straight
/// between the slices above and below in which it does not. Empty if there is none longer than 25 mm.
std::vector<SternumSlice> findSternum(const Body& body, const Field& field, const Spine& spine, double boneHu);

/// The landmarks, from the slices, in local mm.
/// - Jugular notch and end of the xiphoid: first and last centroid.
/// - Xiphisternal joint: the lowest slice whose contour has at least 0.55 of the median area of the body's slices.
/// - Manubriosternal joint: where the bone stops to narrow and its axis bends: the place between 0.2 and 0.5 of the way from the
///   notch to the xiphisternal joint at which two straight pieces that meet there fit width and depth best, from 0.1 to 0.75 of
///   the way.
/// - Deepest: the most posterior point of the front surface in the body's caudal half, in the middle 0.84 of its width.
/// - Tilt by linear regression of the body's axis; torsion: sectionTorsion at the deepest level, by linear regression over
///   30 mm around it.
/// - Notches at the contour's lateral edge, midway between front and back, at fixed parts of the way: rib 1 at 0.37 of the manubrium, rib 2 at the
///   joint, ribs 3 to 7 at 0.27, 0.51, 0.71, 0.85 and 0.95 of the body (science basis, table 1).
/// `turnDeg` is the patient's turn about z (see patientTurn): torsion is against the patient's own transverse axis.
/// If the sternum's upper or lower end lies outside the CT, what hangs on it is only as good as that. Empty for fewer
/// than two slices.
Sternum measureSternum(const std::vector<SternumSlice>& slices, double sliceSpacing, double turnDeg);

}  // namespace pectora::thorax
