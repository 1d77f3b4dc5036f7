// Builds the rib cage's curves from the segmented anatomy.
#pragma once

#include "kernel/value/rib_cage.h"
#include "kernel/value/volume.h"

#include <functional>
#include <string>

namespace pectora {

struct CageSettings {
  double controlSpacing = 25;   ///< mm of rib for one control point
  double handle = 0.38;         ///< length of a guessed cartilage's end handles over the distance of its ends
  double cartilageHu = 100;     ///< mean of unossified cartilage
};

/// Ribs as least-squares splines; cartilages 1-7 from the costochondral junction to their notch; 8-10 to the cartilage
/// above, as the costal arch. With a CT they are fitted to the cartilage that can be seen there, each side by itself: first those of
/// the sternum together, from guesses of one shape (see bestShape), then one more at a time, guessed from the one above that is already
/// fitted. Where none can be seen, or without a CT, a cartilage is as guessed (see guessCourse). What is guessed or cannot be built is
/// said in `warnings`.
/// `poll` is called now and then, from either side's thread.
RibCage buildCage(std::shared_ptr<const Anatomy> anatomy, const Volume* ct, const CageSettings& settings,
                  std::vector<std::string>& warnings, const std::function<void()>& poll = [] {});

}  // namespace pectora
