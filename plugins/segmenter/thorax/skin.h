// The skin's outline, slice by slice.
#pragma once

#include "plugins/segmenter/thorax/body.h"
#include "plugins/segmenter/thorax/outline.h"

namespace pectora::thorax {

enum class Edge {
  subpixel,  ///< where the value crosses half-way between air and skin, after a light smoothing
  paper,     ///< the first pixel whose gradient is above a threshold, along columns and rows (lies 2 to 4 mm outside)
};

struct SkinSettings {
  Edge edge = Edge::subpixel;
  double levelHu = -490;           ///< subpixel: half-way between air (-1000) and skin (20)
  double sigmaMm = 0.5;            ///< subpixel: smoothing
  double paperSigmaPx = 2.5;       ///< paper: smoothing
  double paperThreshold = 0.25;    ///< paper: part of the slice's greatest gradient
};

/// The skin in one slice, local mm.
struct SkinSlice {
  std::vector<Point2> whole;   ///< closed outline of the torso; empty if there is none
  std::vector<Point2> front;   ///< open, from the patient's right on the coronal plane over the front to the left
  bool clipped = false;        ///< the front touches the border of the field of view
};

/// Outline of one slice, cut at the coronal plane y = coronalY (local mm). What is not body (couch, clothes, separate
/// arms, metal on the skin) is replaced by air before; of several pieces the one with the largest area is the torso. `front` is empty where
/// the outline does not cross the coronal plane twice.
SkinSlice findSkin(const Volume& ct, const Body& body, int slice, double coronalY, const SkinSettings& settings);

/// The part of a closed outline from its rightmost (least x) crossing of y = coronalY over the front (lesser y) to its
/// leftmost one. Empty if there are not two crossings.
std::vector<Point2> frontOf(const Loop& outline, double coronalY);

}  // namespace pectora::thorax
