// Draws one slice of the CT from the body's signed distances, with partial volume.
#pragma once

#include "organs.h"
#include "phantom.h"
#include "tubes.h"

namespace pectora::phantom {

/// A picture of what tubes do in a thin slice: for each pixel the distance to the nearest one, and which it is.
class TubeMap {
 public:
  explicit TubeMap(int pixels) : distance_(std::size_t(pixels), kFar), piece_(std::size_t(pixels), nullptr) {}
  /// Draws the pieces that the level z cuts; forgets what was drawn before.
  void draw(const std::vector<TubePiece>& pieces, const Grid& grid, double z);
  float distance(std::size_t pixel) const { return distance_[pixel]; }
  const TubePiece& piece(std::size_t pixel) const { return *piece_[pixel]; }
  static constexpr float kFar = 1e9f;

 private:
  std::vector<float> distance_;
  std::vector<const TubePiece*> piece_;
  std::vector<std::size_t> touched_;
};

/// What does not change between slices.
struct Drawing {
  Drawing(const Patient& patient, const Settings& settings);
  const Patient& patient;
  const Settings& settings;
  Organs organs;
  std::vector<TubePiece> ribs, cartilages, vessels;
  double couchTop = 0;  ///< y of the couch's surface in the CT, mm
};

/// Scratch memory of one thread's slice.
struct Canvas {
  explicit Canvas(const Grid& grid);
  TubeMap ribs, cartilages, vessels;
  std::vector<float> hu, texture;       ///< mean and texture SD of each pixel
  std::vector<std::uint8_t> label;
};

/// Draws an infinitely thin slice at CT level z into the canvas. A pixel that a surface crosses gets the mean of both
/// sides by the part that each covers (a box of one pixel across the surface).
void drawThinSlice(const Drawing& drawing, double z, Canvas& canvas);

}  // namespace pectora::phantom
