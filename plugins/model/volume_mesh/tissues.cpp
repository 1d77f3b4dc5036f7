#include "plugins/model/volume_mesh/tissues.h"

#include "plugins/model/volume_mesh/cells.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

constexpr double kFatBelow = -30, kBoneFrom = 150, kAirBelow = -300;   // HU
constexpr double kSamplePlaces[3] = {1.0 / 6, 0.5, 5.0 / 6};

// Calls f(cell index, its corners) for all cells.
template <class F>
void forEachCell(const Scene& scene, F&& f) {
  parallelFor(std::size_t(scene.layers() - 1) * (scene.rows - 1), [&](std::size_t i) {
    const int l = int(i) / (scene.rows - 1), r = int(i) % (scene.rows - 1);
    for (int c = 0; c + 1 < scene.columns; ++c) f(scene.cell(l, r, c), cellCorners(scene, l, r, c), l);
  });
}

Vec3 placeIn(const std::array<Vec3, 8>& corners, double c, double r, double l) {
  const auto face = [&](int a) { return lerp(lerp(corners[a], corners[a + 1], c), lerp(corners[a + 2], corners[a + 3], c), r); };
  return lerp(face(0), face(4), l);
}

// Thickness of fat at a place, mm.
double fatThickness(double besideMiddle, double belowSternum) {
  const double x = std::abs(besideMiddle);
  const double chest = x < 100 ? 4 + 4 * x / 100 : std::min(10.0, 8 + 2 * (x - 100) / 50);
  const double belly = std::max(10.0, 15 - 5 * x / 150);
  return std::lerp(chest, belly, std::clamp(belowSternum / 30, 0.0, 1.0));
}

}  // namespace

void sampleTissues(const Volume& ct, Scene& scene) {
  scene.cellTissue.assign(scene.cells(), kMuscle);
  forEachCell(scene, [&](int cell, const std::array<Vec3, 8>& corners, int) {
    double sum = 0;
    int count = 0;
    for (const double l : kSamplePlaces)
      for (const double r : kSamplePlaces)
        for (const double c : kSamplePlaces) {
          const Vec3 v = ct.grid.toVoxel(placeIn(corners, c, r, l));
          const int i = int(std::lround(v.x)), j = int(std::lround(v.y)), k = int(std::lround(v.z));
          if (i < 0 || j < 0 || k < 0 || i >= ct.grid.size[0] || j >= ct.grid.size[1] || k >= ct.grid.size[2]) continue;
          const int hu = ct.at(i, j, k);
          if (hu >= kAirBelow) sum += hu, ++count;
        }
    if (count > 0) scene.cellTissue[cell] = sum < kFatBelow * count ? kFat : sum < kBoneFrom * count ? kMuscle : kBone;
  });
}

void assumeTissues(Scene& scene) {
  const Sternum& sternum = scene.cage->anatomy->sternum;
  scene.cellTissue.assign(scene.cells(), kMuscle);
  forEachCell(scene, [&](int cell, const std::array<Vec3, 8>& corners, int l) {
    const Vec3 middle = placeIn(corners, 0.5, 0.5, 0.5), outside = placeIn(corners, 0.5, 0.5, 0);
    // The middle of the cell below the skin: l whole cells and a half.
    const double depth = distance(middle, outside) * (2 * l + 1);
    if (depth < fatThickness(middle.x - sternum.jugularNotch.x, sternum.xiphisternalJoint.z - middle.z)) scene.cellTissue[cell] = kFat;
  });
}

}  // namespace pectora
