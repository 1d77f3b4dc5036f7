// The inner wall where costal cartilages show it.
#pragma once

#include "plugins/segmenter/thorax/pleura.h"

namespace pectora::thorax {

/// Samples of faint weight 1 mm behind the costal cartilages, on rays up to 75 degrees from the front: the outermost 4 to 18 mm in a
/// row of more than 85 HU (cartilage; muscle is fainter, liver and heart are thicker, bone is brighter than 220 HU in the mean and counts
/// only far from bone that is known: fronts of ribs that were not tracked), 6 to 70 mm below the skin (a large breast), with 2 mm of
/// less behind it. A sample counts if five of the eight around it (1.5 degrees, 2.5 mm of slices) lie within 3 mm of it, so that noise
/// and vessels do not, and if it lies between 10 mm inside and 30 mm outside `bonySurface` (indices as in findPleura, also of
/// `isFarFromBone`), so that bowel with contrast agent does not. There is none where lung lies within 8 mm, which shows the wall unless it is more than `deepestLungMm` inside `bonySurface`, nor where `sternum` has one, whose marrow is as bright as
/// cartilage. `skinRadius[s][n]` and `lung[s][n]` are negative where unknown.
std::vector<WallSample> cartilageWall(const Field& field, const PolarGrid& grid, const std::vector<std::vector<double>>& skinRadius,
                                      const std::vector<std::vector<double>>& lung, const std::vector<WallSample>& sternum,
                                      const std::vector<double>& bonySurface, const std::vector<char>& isFarFromBone, int firstSlice,
                                      double deepestLungMm);

}  // namespace pectora::thorax
