// The figures that each value shows to scripts and summaries.
#include "kernel/value/anatomy.h"
#include "kernel/value/levels.h"
#include "kernel/value/mesh.h"
#include "kernel/value/rib_cage.h"
#include "kernel/value/truth.h"
#include "kernel/value/volume.h"

#include <algorithm>
#include <limits>

namespace pectora {

std::vector<Fact> Volume::facts() const {
  return {{"columns", double(grid.size[0]), ""},        {"rows", double(grid.size[1]), ""},
          {"slices", double(grid.size[2]), ""},         {"column_spacing", grid.spacing.x, "mm"},
          {"row_spacing", grid.spacing.y, "mm"},        {"slice_spacing", grid.spacing.z, "mm"},
          {"z_first", grid.toPatient({0, 0, 0}).z, "mm"}, {"z_last", grid.toPatient({0, 0, grid.size[2] - 1.0}).z, "mm"}};
}

std::vector<Fact> Mesh::facts() const {
  return {{"points", double(points.size()), ""}, {"triangles", double(triangles.size()), ""}};
}

std::vector<Fact> Points::facts() const { return {{"points", double(points.size()), ""}}; }

std::vector<Fact> Landmarks::facts() const { return {{"landmarks", double(points.size()), ""}}; }

const Landmark* Landmarks::find(const std::string& name) const {
  const auto found = std::find_if(points.begin(), points.end(), [&](const Landmark& l) { return l.name == name; });
  return found == points.end() ? nullptr : &*found;
}

const Rib* Anatomy::rib(Side side, int number) const {
  const auto found =
      std::find_if(ribs.begin(), ribs.end(), [&](const Rib& r) { return r.side == side && r.number == number; });
  return found == ribs.end() ? nullptr : &*found;
}

const LevelMetrics* Anatomy::deepestLevel() const {
  // Only the caudal half of the sternal body counts: the normal chest is narrowest at the body's upper end.
  const double middle = (sternum.manubriosternalJoint.z + sternum.xiphisternalJoint.z) / 2;
  const LevelMetrics* best = nullptr;
  for (const LevelMetrics& level : metrics) {
    if (level.z > middle || level.z < sternum.xiphisternalJoint.z) continue;
    if (!best || level.sternumToVertebra < best->sternumToVertebra) best = &level;
  }
  return best;
}

std::vector<Fact> Anatomy::facts() const {
  std::vector<Fact> facts{{"ribs_right", double(std::count_if(ribs.begin(), ribs.end(),
                                                              [](const Rib& r) { return r.side == Side::right; })), ""},
                          {"ribs_left", double(std::count_if(ribs.begin(), ribs.end(),
                                                             [](const Rib& r) { return r.side == Side::left; })), ""},
                          {"skin_levels", double(skin.size()), ""},
                          {"skin_levels_clipped", double(std::count_if(skin.begin(), skin.end(),
                                                                       [](const LayerSlice& s) { return s.clipped; })), ""},
                          {"sternum_tilt", sternum.tiltDeg, "deg"},
                          {"sternum_torsion", sternum.torsionDeg, "deg"}};
  // Without a level that has all three lengths there is no index.
  const LevelMetrics* level = deepestLevel();
  const double none = std::numeric_limits<double>::quiet_NaN();
  facts.push_back({"haller_index", level ? level->haller() : none, ""});
  facts.push_back({"correction_index", level ? level->correctionIndex() : none, "%"});
  facts.push_back({"deepest_level_z", level ? level->z : none, "mm"});
  if (level)
    for (Fact& fact : levelFacts(*level)) facts.push_back(std::move(fact));
  facts.push_back({"concavity_volume", metrics.empty() ? none : concavityVolume(metrics), "mL"});
  facts.push_back({"turn", turnDeg, "deg"});
  facts.push_back({"ranges_of_doubt", double(ranges.size()), ""});
  return facts;
}

std::vector<Fact> RibCage::facts() const {
  double worst = 0;
  for (const RibCurve& rib : ribs) worst = std::max(worst, rib.rmsError);
  return {{"ribs", double(ribs.size()), ""},
          {"cartilages", double(cartilages.size()), ""},
          {"worst_rib_rms", worst, "mm"}};
}

std::vector<Fact> Truth::facts() const {
  return {{"haller_index", hallerIndex, ""},
          {"correction_index", correctionIndex, "%"},
          {"pit_depth", pitDepth, "mm"},
          {"sternum_torsion", anatomy ? anatomy->sternum.torsionDeg : 0.0, "deg"}};
}

std::vector<std::pair<std::string, std::shared_ptr<const Value>>> Truth::parts() const {
  return {{"anatomy", anatomy},          {"labels", labels}, {"skin_before", skinBefore},
          {"skin_after", skinAfter},     {"pleura", pleura}};
}

}  // namespace pectora
