// A smoothed copy of the CT that can be sampled between its voxels.
#pragma once

#include "kernel/value/volume.h"

#include <functional>

namespace pectora::thorax {

/// Half-open range of voxels along the three axes.
struct Box {
  std::array<int, 3> low{}, high{};
  int size(int axis) const { return high[axis] - low[axis]; }
};

/// Weights of a sampled Gaussian from -radius to radius (radius = ceil(3 sigma)), with sum 1; sigma in samples.
/// Sigma 0 gives the single weight 1.
std::vector<float> gaussianKernel(double sigma);

/// A plane of numbers, row by row.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> value;
  Plane() = default;
  Plane(int w, int h, float fill = 0) : width(w), height(h), value(std::size_t(w) * h, fill) {}
  float& at(int i, int j) { return value[std::size_t(j) * width + i]; }
  float at(int i, int j) const { return value[std::size_t(j) * width + i]; }
};

/// Smooths a plane in both directions by a Gaussian; sigma in pixels; the border is repeated outwards.
void smooth(Plane& plane, double sigmaX, double sigmaY);

/// Smoothed Hounsfield units on a box of the CT's voxels. Positions are local mm of the whole CT.
class Field {
 public:
  /// Smooths by a Gaussian of `sigmaMm` along each axis; an axis whose spacing is above twice that is left as it is.
  /// `step` is called now and then from the calling thread's loop over slabs (for progress and cancel).
  Field(const Volume& ct, const Box& box, double sigmaMm, const std::function<void(double)>& step = {});

  /// Trilinear value; positions outside the box take the value at its nearest border.
  float at(Vec3 localMm) const;
  std::int16_t voxel(int i, int j, int k) const {
    return hu_[(std::size_t(k - box_.low[2]) * box_.size(1) + (j - box_.low[1])) * box_.size(0) + (i - box_.low[0])];
  }
  const Box& box() const { return box_; }
  Vec3 spacing() const { return spacing_; }
  /// Adds `hu` to what is between half and twice as bright as bone (80 to 400 HU) between two corners, so that one level outlines
  /// bone that is fainter or brighter there. Local mm.
  void shift(Vec3 corner, Vec3 opposite, double hu);
  /// Whether a position lies within the box of voxel centres, with `marginMm` to spare.
  bool contains(Vec3 localMm, double marginMm = 0) const;

 private:
  Box box_;
  Vec3 spacing_;
  std::vector<std::int16_t> hu_;
};

}  // namespace pectora::thorax
