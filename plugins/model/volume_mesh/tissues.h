// What the cells of the wall are made of.
#pragma once

#include "kernel/value/scene.h"
#include "kernel/value/volume.h"

namespace pectora {

/// Places of the wall's tissues in Scene::tissues. The skin is no cell: the effects of the outer layer are its sheet.
enum WallTissue : std::uint8_t { kFat, kMuscle, kBone };

/// Fills cellTissue by the mean of 27 CT values in each cell: below -30 HU fat, from 150 HU bone or cartilage, muscle between.
/// Values below -300 HU, of air and lung at the faces, do not count; a cell that has no others is muscle.
void sampleTissues(const Volume& ct, Scene& scene);

/// The same without a CT, by the thickness of fat in a slim chest (science, section 1): 4 mm over the sternum, 8 mm over the
/// nipples 100 mm to the side, 10 mm from 150 mm on; below the sternum 15 mm in the middle. What is deeper is muscle.
void assumeTissues(Scene& scene);

}  // namespace pectora
