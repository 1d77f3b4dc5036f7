// Blocks of cells for tests: x along the columns, z along the rows, and the layers from y = -height to y = 0, as in a scene.
#pragma once

#include "plugins/effect/common/cells.h"

#include "tests/kernel/physics/derivatives.h"

namespace pectora {

/// A block of layers x rows x columns nodes, width x height x depth mm (x, y, z). All nodes free, without terms.
inline System block(int layers, int rows, int columns, Vec3 size) {
  System system;
  system.layers = layers, system.rows = rows, system.columns = columns;
  system.freeNodes = system.anchorNode(0);
  system.rest = NodeVectors(system.freeNodes);
  for (int l = 0; l < layers; ++l)
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c)
        system.rest.set(system.node(l, std::size_t(r) * columns + c),
                        {size.x * c / (columns - 1), size.y * (double(l) / (layers - 1) - 1), size.z * r / (rows - 1)});
  system.mass.assign(system.freeNodes, 1e-3);
  return system;
}

inline std::size_t cellsOf(const System& s) { return std::size_t(s.layers - 1) * (s.rows - 1) * (s.columns - 1); }

}  // namespace pectora
