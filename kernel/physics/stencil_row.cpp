#include "kernel/physics/stencil_row.h"

#include "kernel/physics/lattice_rows.h"

#include <cmath>
#include <cstring>

// Vectors are passed between functions that are always inlined.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace pectora::lattice {
namespace {

namespace narrow {
constexpr int W = 4;
#include "kernel/physics/stencil_row_lanes.h"
}  // namespace narrow
#ifdef __x86_64__
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v3")
namespace wide {
constexpr int W = 8;
#include "kernel/physics/stencil_row_lanes.h"
}  // namespace wide
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
namespace widest {
constexpr int W = 16;
#include "kernel/physics/stencil_row_lanes.h"
}  // namespace widest
#pragma GCC pop_options
#endif

}  // namespace

std::vector<bool (*)(const StencilRow&)> rowForcesByWidth() {
  std::vector<bool (*)(const StencilRow&)> all;
#ifdef __x86_64__
  if (__builtin_cpu_supports("x86-64-v4")) all.push_back(widest::addForces);
  if (__builtin_cpu_supports("x86-64-v3")) all.push_back(wide::addForces);
#endif
  all.push_back(narrow::addForces);
  return all;
}

bool addRowForces(const StencilRow& row) {
  static const auto add = rowForcesByWidth().front();
  return add(row);
}

}  // namespace pectora::lattice
