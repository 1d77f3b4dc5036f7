#include "plugins/comparer/surface/regions.h"

#include "kernel/stage/error.h"

#include <sstream>
#include <vector>

namespace pectora {

bool Region::contains(Vec3 p) const {
  if (isBall) return distance(p, center) <= radius;
  for (int a = 0; a < 3; ++a)
    if (p[a] < low[a] || p[a] > high[a]) return false;
  return true;
}

Region parseRegion(const std::string& text) {
  const auto wrong = [&](const char* what) {
    return Error(what).of("regions").given(text).allowed("\"NAME = ball X Y Z RADIUS\" or \"NAME = box X0 X1 Y0 Y1 Z0 Z1\", mm");
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw wrong("a region needs a name and a shape");
  Region region;
  std::istringstream before(text.substr(0, equals)), after(text.substr(equals + 1));
  std::string rest, shape;
  if (!(before >> region.name) || before >> rest || region.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
    throw wrong("the name of a region has small letters, digits and _");
  for (const char* taken : {"overlap", "pit", "hollow", "paper", "unchanged", "copied", "reverse", "symmetric"})
    if (region.name == taken) throw wrong("this name of a region is taken");
  after >> shape;
  region.isBall = shape == "ball";
  if (!region.isBall && shape != "box") throw wrong("the shape of a region is ball or box");
  std::vector<double> values;
  for (double value; after >> value;) values.push_back(value);
  if (!after.eof() || values.size() != (region.isBall ? 4u : 6u)) throw wrong("the shape has another number of figures");
  if (region.isBall) {
    region.center = {values[0], values[1], values[2]};
    region.radius = values[3];
    if (!(region.radius > 0)) throw wrong("the radius must be above 0");
  } else {
    region.low = {values[0], values[2], values[4]};
    region.high = {values[1], values[3], values[5]};
    if (!(region.low.x < region.high.x && region.low.y < region.high.y && region.low.z < region.high.z)) throw wrong("the sides of a box run from low to high");
  }
  return region;
}

}  // namespace pectora
