// The tool window, as the program opens it.
#pragma once

#include "kernel/host/registry.h"

#include <string>

namespace pectora::view {

struct ViewOptions {
  std::string path;        ///< what to open at once; empty: nothing
  std::string tour;        ///< a folder: no window is opened, but its pictures for the README are written there
  int width = 0, height = 0;   ///< pixels; 0: as it was last time
  float scale = 0;         ///< pixels of one unit of the layout; 0: as the display says
};

/// Returns when the user closes the window. Throws Error if none can be opened.
void runView(Registry& registry, const ViewOptions& options);

}  // namespace pectora::view
