// The whole way from a CT to the anatomy of a chest.
#pragma once

#include "plugins/segmenter/thorax/pleura.h"

#include "kernel/stage/host.h"

namespace pectora::thorax {

/// A box of the chest in which bone has a threshold of its own, LPS mm.
struct BoneRegion {
  Vec3 low, high;
  double boneHu = 160;
};

struct Settings {
  double boneHu = 160;           ///< iso-value of bone
  double smoothingMm = 1.0;      ///< Gaussian before bone and lung are looked for
  int everySlice = 1;            ///< levels of skin and pleura: every n-th slice
  std::vector<BoneRegion> regions;
  SkinSettings skin;
  PleuraSettings pleura;
};

/// Segments a CT (science: Moreira et al., SPIE 2012). Throws Error if the CT is too small, or holds no body or no spine;
/// what else was not found is left out of the result and reported through host.warn.
std::shared_ptr<const Anatomy> segment(std::shared_ptr<const Volume> ct, const Settings& settings, Host& host);

/// Bone contours of one slice told apart by what was found there before, by position, size and Hu's first moment:
/// "rib" (with side and number) around a rib's centreline, "sternum" (the outline that was found, in place of the bone in it),
/// "vertebra" within 45 mm of the column's middle, "scapula" for long thin ones outside the inner wall, "other" otherwise. Local mm, closed.
std::vector<SliceContour> classifyBones(const Field& field, int slice, double boneHu, const std::vector<FoundRib>& ribs,
                                        const std::vector<SternumSlice>& sternum, const Spine& spine);

}  // namespace pectora::thorax
