#include "tissue.h"

namespace pectora::phantom {

std::vector<std::string> labelNames() {
  std::vector<std::string> names{"air",     "skin",    "fat",      "muscle", "lung",  "mediastinum",
                                 "heart",   "vessel",  "airway",   "liver",  "abdomen", "vertebra",
                                 "disc",    "canal",   "sternum",  "xiphoid", "couch", "clothing"};
  names.resize(kLabels);
  for (Side side : {Side::right, Side::left}) {
    for (int n = 1; n <= 12; ++n) names[ribLabel(side, n)] = std::string("rib_") + sideName(side) + "_" + std::to_string(n);
    for (int n = 1; n <= 10; ++n)
      names[cartilageLabel(side, n)] = std::string("cartilage_") + sideName(side) + "_" + std::to_string(n);
  }
  return names;
}

}  // namespace pectora::phantom
