// Builds the rib cage's curves from the segmented anatomy.
#pragma once

#include "kernel/value/rib_cage.h"

#include <string>

namespace pectora {

struct CageSettings {
  double controlSpacing = 25;   ///< mm of rib for one control point
  double handle = 0.38;         ///< length of a cartilage's end handles over the distance of its ends
};

/// Ribs as least-squares splines; cartilages 1-7 from the costochondral junction, along the rib, to their notch; 8-10 to
/// the middle of the cartilage above, as the costal arch. Seen from the front a cartilage is a cubic between its end tangents; in
/// depth it keeps along the pleura, which shows the shape of a pit, at the distance that its ends have from it. What cannot be built is left out and said in `warnings`.
RibCage buildCage(std::shared_ptr<const Anatomy> anatomy, const CageSettings& settings, std::vector<std::string>& warnings);

}  // namespace pectora
