// The whole way from a CT to the anatomy of a chest.
#pragma once

#include "plugins/segmenter/thorax/pleura.h"

#include "kernel/stage/host.h"

namespace pectora::thorax {

struct Settings {
  double boneHu = 160;           ///< iso-value of bone
  double smoothingMm = 1.0;      ///< Gaussian before bone and lung are looked for
  int everySlice = 1;            ///< levels of skin and pleura: every n-th slice
  SkinSettings skin;
  PleuraSettings pleura;
};

/// Segments a CT (science: Moreira et al., SPIE 2012). Throws Error if the CT is too small, or holds no body or no spine;
/// what else was not found is left out of the result and reported through host.warn.
std::shared_ptr<const Anatomy> segment(std::shared_ptr<const Volume> ct, const Settings& settings, Host& host);

/// T, B and C of one level from the sternum's contour there (may be empty), the front of the vertebral body and the inner
/// wall, all local mm, in the axes of a patient who is turned about z by `turnDeg`: T is the inner width; B and C are depths
/// from the front of the vertebral body to the most posterior point of the sternum and to the most anterior point of the inner
/// wall. Zero where it is not known.
LevelMetrics measureLevel(double z, const Loop& sternum, Vec3 vertebralFront, const std::vector<Point2>& innerWall, double turnDeg);

/// Bone contours of one slice told apart by what was found there before, by position, size and Hu's first moment:
/// "rib" (with side and number) around a rib's centreline, "sternum", "vertebra" within 45 mm of the column's middle,
/// "scapula" for long thin ones outside the inner wall, "other" otherwise. Local mm, closed.
std::vector<SliceContour> classifyBones(const Field& field, int slice, double boneHu, const std::vector<FoundRib>& ribs,
                                        const std::vector<SternumSlice>& sternum, const Spine& spine);

}  // namespace pectora::thorax
