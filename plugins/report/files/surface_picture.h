// Distance maps: a surface seen from the front, coloured by a field.
#pragma once

#include "plugins/report/files/canvas.h"

#include "kernel/value/mesh.h"

namespace pectora {

/// The surface from the front (patient's right on the left), shaded and coloured by the field of that name in mm, with a colour
/// bar from -limit to +limit and `caption` lines below. Points are drawn as small discs. `field` may be empty: plain shading.
Canvas surfacePicture(const Value& surface, const std::string& field, double limit, const std::string& title,
                      const std::vector<std::string>& caption);
/// A round limit that holds 98 % of the absolute values.
double roundLimit(std::vector<double> values);

}  // namespace pectora
