#include "tissue.h"

namespace pectora::phantom {

std::vector<std::string> labelNames() {
  std::vector<std::string> names{"air",     "skin",    "fat",      "muscle", "lung",  "mediastinum",
                                 "heart",   "vessel",  "airway",   "liver",  "abdomen", "vertebra",
                                 "disc",    "canal",   "sternum",  "xiphoid", "couch", "clothing"};
  names.resize(kLabels);
  for (Side side : {Side::right, Side::left}) {
    const std::string of = std::string("_") + sideName(side) + "_";
    for (int n = 1; n <= 12; ++n) names[ribLabel(side, n)] = "rib" + of + std::to_string(n);
    for (int n = 1; n <= 10; ++n) names[cartilageLabel(side, n)] = "cartilage" + of + std::to_string(n);
  }
  return names;
}

}  // namespace pectora::phantom
