// Centrelines of the undeformed skeleton: ribs by the table, cartilages to the sternum and to the arch.
#pragma once

#include "rib_table.h"
#include "kernel/value/anatomy.h"

#include <vector>

namespace pectora::phantom {

/// A rib or a cartilage as a polyline in the body frame, mm of the unscaled body.
struct BoneLine {
  Side side = Side::right;
  int number = 0;
  int joins = 0;            ///< cartilages: 0 the sternum, n the cartilage of rib n
  std::vector<Vec3> line;   ///< rib: head to junction; cartilage: junction to its medial end
};

struct Skeleton {
  SternumPlan sternum;
  std::vector<BoneLine> ribs;         ///< rib 1 first, right before left
  std::vector<BoneLine> cartilages;   ///< rib 1 first, right before left
};

/// The skeleton of a chest whose depth is scaled by `depthScale` (1: the table). Rib lengths stay as in the table.
Skeleton buildSkeleton(double depthScale);

/// Half distance between the two rows of costochondral junctions at level z of the table's chest, mm.
double junctionX(const Skeleton& skeleton, double z);

}  // namespace pectora::phantom
