// Builds the rib cage's curves from the segmented anatomy.
#pragma once

#include "plugins/splines/cartilage/trace.h"

#include "kernel/value/rib_cage.h"

#include <string>

namespace pectora {

struct CageSettings {
  double controlSpacing = 25;   ///< mm of rib for one control point
  double handle = 0.38;         ///< length of a guessed cartilage's end handles over the distance of its ends
  TraceSettings trace;
};

/// Ribs as least-squares splines; cartilages 1-7 from the costochondral junction to their notch; 8-10 to the cartilage
/// above, as the costal arch. With a CT each is followed through the cartilage that can be seen there. Where it cannot, or without
/// one, it is guessed: seen from the front a cubic that leaves along the rib, and in depth along the pleura, which shows the shape
/// of a pit, at the distance that its ends have from it. What is guessed or cannot be built is said in `warnings`.
/// `poll` is called now and then.
RibCage buildCage(std::shared_ptr<const Anatomy> anatomy, const Volume* ct, const CageSettings& settings,
                  std::vector<std::string>& warnings, const std::function<void()>& poll = [] {});

}  // namespace pectora
