// The labels of the phantom's voxels, and what each tissue looks like in a CT.
#pragma once

#include "kernel/value/anatomy.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pectora::phantom {

enum Label : std::uint8_t {
  kAir, kSkin, kFat, kMuscle, kLung, kMediastinum, kHeart, kVessel, kAirway, kLiver, kAbdomen, kVertebra, kDisc,
  kCanal, kSternum, kXiphoid, kCouch, kClothing,
  kFirstRib = 32,        // right 1 to 12, then left 1 to 12
  kFirstCartilage = 56,  // right 1 to 10, then left 1 to 10
  kLabels = 76,
};

inline std::uint8_t ribLabel(Side side, int number) {
  return std::uint8_t(kFirstRib + (side == Side::left ? 12 : 0) + number - 1);
}
inline std::uint8_t cartilageLabel(Side side, int number) {
  return std::uint8_t(kFirstCartilage + (side == Side::left ? 10 : 0) + number - 1);
}

/// Name of every label: "lung", "rib_right_4", "cartilage_left_7"; empty where a value is not used.
std::vector<std::string> labelNames();

/// Mean and texture of a tissue (science.md, section 1), HU.
struct Material {
  float hu = 0;
  float texture = 0;  ///< SD
};

constexpr Material kAirHu{-1000, 0}, kSkinHu{20, 5}, kFatHu{-100, 10}, kMuscleHu{55, 8}, kLungHu{-870, 30},
    kBloodHu{45, 3}, kLiverHu{60, 5}, kAbdomenHu{40, 14}, kMediastinumHu{10, 20}, kCartilageHu{100, 15},
    kCalcifiedHu{320, 60}, kCancellousHu{250, 60}, kCorticalHu{900, 40}, kSternumHu{150, 40}, kSternumCortexHu{600, 40},
    kVertebraHu{230, 50}, kVertebraCortexHu{650, 40}, kDiscHu{85, 8}, kCanalHu{30, 4}, kXiphoidHu{160, 30},
    kCouchShellHu{-150, 5}, kCouchFoamHu{-900, 5}, kClothingHu{-800, 40};

}  // namespace pectora::phantom
