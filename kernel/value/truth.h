// What a phantom knows of itself: the exact anatomy that a segmentation is judged by.
#pragma once

#include "kernel/value/anatomy.h"
#include "kernel/value/mesh.h"
#include "kernel/value/volume.h"

namespace pectora {

/// Centreline of one costal cartilage, from the costochondral junction to the sternum or the arch.
struct CartilageLine {
  Side side = Side::right;
  int rib = 0;
  int joins = 0;   ///< 0: the sternum; n: the cartilage of rib n on the same side
  std::vector<Vec3> centerline;
};

struct Truth : Value {
  static constexpr const char* kName = "Truth";
  std::shared_ptr<const Anatomy> anatomy;           ///< ribs, sternum, layers, vertebral fronts, metrics
  std::vector<CartilageLine> cartilages;
  std::shared_ptr<const Labels> labels;
  std::shared_ptr<const Mesh> skinBefore, skinAfter;  ///< whole skin, before and after the correction
  std::shared_ptr<const Mesh> pleura;
  double hallerIndex = 0;                           ///< measured on the label volume, at the deepest level
  double correctionIndex = 0;                       ///< %, at the same level
  double pitDepth = 0;                              ///< of the bony deformity, mm

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
  std::vector<std::pair<std::string, std::shared_ptr<const Value>>> parts() const override;
};

}  // namespace pectora
