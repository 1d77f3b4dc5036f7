#include "app/view/panels/scene_parts.h"

#include <algorithm>
#include <cmath>

namespace pectora::view {
namespace {

constexpr Rgb kSkin{0.87f, 0.72f, 0.62f}, kBone{0.90f, 0.86f, 0.76f}, kCartilage{0.60f, 0.70f, 0.82f}, kBar{0.74f, 0.77f, 0.80f}, kScan{0.62f, 0.70f, 0.66f},
    kMarker{0.98f, 0.62f, 0.25f};
constexpr double kCartilageRadius = 4.2;   // as they are drawn, mm

bool sameLook(const SceneOptions& a, const SceneOptions& b) {
  return a.skin == b.skin && a.hasBones == b.hasBones && a.hasBar == b.hasBar && a.hasScan == b.hasScan && a.hasSprings == b.hasSprings && a.isRangeFixed == b.isRangeFixed &&
         a.range == b.range && a.clip.isOn == b.clip.isOn && a.clip.offset == b.clip.offset && a.clip.normal == b.clip.normal;
}

}  // namespace

void SceneParts::update(const Context& context) {
  // While a corrected anatomy is on its way to a skin, the same patient's last scene stays.
  const Results& r = *context.results;
  const bool isOnTheWay = context.activity.isBusy && !r.skin && r.ct.value && r.ct.value == patientOf_;
  if (!isOnTheWay) {
    updateSkin(context);
    updateBones(context);
    updateScan(context);
    patientOf_ = r.skin ? r.ct.value : nullptr;
  }
  updatePicked(context);
  if (!sameLook(lastOptions_, context.scene)) ++version_;
  lastOptions_ = context.scene;
}

void SceneParts::updateSkin(const Context& context) {
  const Results& r = *context.results;
  const Scene* scene = r.sceneValue();
  const float part = context.scene.part;
  const std::shared_ptr<const void> made = scene ? r.scene.value : r.after.value, distances = context.scene.skin == SkinLook::distance ? r.scanDistances : nullptr;
  if (skinOf_ == r.skin && sceneOf_ == made && skinPart_ == part && distancesOf_ == distances) return;
  // While the bar moves, the triangles stay.
  const bool isKnown = made && sceneOf_ == made;
  skinOf_ = r.skin, sceneOf_ = made, skinPart_ = part, distancesOf_ = distances;
  ++version_;
  if (!isKnown) skin_ = {};
  const Mesh* before = Results::as<Mesh>(r.before);
  const auto kept = std::dynamic_pointer_cast<const Mesh>(r.after.value);
  if (scene || (before && kept)) {
    const std::vector<Vec3>& rest = scene ? scene->outer : before->points;
    if (!isKnown) skinAtRest_ = rest;
    skinAfter_ = r.skin;
    if (!scene) skinAfter_ = {kept, &kept->points};
    else if (!skinAfter_ || skinAfter_->size() != rest.size()) skinAfter_ = {r.scene.value, &scene->outer};
    const std::vector<Vec3>& after = *skinAfter_;
    if (!isKnown) skin_.triangles = scene ? layerMesh(scene->rows, scene->columns, {}).triangles : before->triangles;
    skin_.points.resize(rest.size());
    skin_.values.resize(rest.size());
    for (std::size_t i = 0; i < rest.size(); ++i) {
      skin_.points[i] = lerp(rest[i], after[i], part);
      skin_.values[i] = distance(rest[i], after[i]);
    }
    skin_.computeNormals();
    displacementLimit_ = roundLimit(skin_.values.data(), skin_.values.size());
    if (distances && r.scanDistances->size() == rest.size()) skin_.values = *r.scanDistances;
  }
  isKnown ? gpuSkin_.uploadPoints(skin_) : gpuSkin_.upload(skin_);
}

void SceneParts::updateBones(const Context& context) {
  const Results& r = *context.results;
  const RibCage* cage = r.cageValue();
  const Plan* plan = r.planValue();
  if (ribsOf_ != r.cage.value) {
    ribsOf_ = r.cage.value;
    ++version_;
    Surface ribs;
    sternumAtRest_ = {};
    if (cage) {
      for (const RibCurve& rib : cage->ribs) ribs.append(tube(rib.curve.sample(60), kRibRadius));
      sternumAtRest_ = loft(cage->anatomy->sternum.contours);
    }
    gpuRibs_.upload(ribs);
    movedOf_ = nullptr;
    movedPart_ = -1;
  }
  const std::shared_ptr<const void> moved = r.barMesh.value ? r.barMesh.value : r.plan.value;
  if (movedOf_ == moved && movedPart_ == context.scene.part) return;
  // Between live plans nothing is drawn at rest: the old plan stays until there is a new one.
  movedOf_ = moved, movedPart_ = context.scene.part;
  ++version_;
  Surface cartilages, sternum = sternumAtRest_, bar;
  barHandles_.clear();
  if (cage) {
    const double t = context.scene.part;
    for (std::size_t i = 0; i < cage->cartilages.size(); ++i) {
      std::vector<Vec3> line = cage->cartilages[i].curve.sample(30);
      if (plan && plan->frames.size() > 1) {
        const double at = t * double(plan->frames.size() - 1);
        const std::size_t f = std::min(plan->frames.size() - 2, std::size_t(at));
        const auto a = plan->frames[f][i].curve.sample(30), b = plan->frames[f + 1][i].curve.sample(30);
        for (std::size_t k = 0; k < line.size(); ++k) line[k] = lerp(a[k], b[k], at - double(f));
      }
      cartilages.append(tube(line, kCartilageRadius));
    }
  }
  if (plan) {
    const RigidMotion motion = plan->motion.part(context.scene.part);
    for (Vec3& p : sternum.points) p = motion(p);
    for (Vec3& n : sternum.normals) n = motion.rotate(n);
    for (const Bar& one : plan->bars) {
      bar.append(sweptBar(one.centerline, one.up, one.width, one.height));
      barHandles_.push_back(tube(one.centerline, 0.8 * one.width, 6));
    }
  }
  if (const Mesh* kept = Results::as<Mesh>(r.barMesh)) {
    bar.points = kept->points, bar.triangles = kept->triangles;
    bar.computeNormals();
  }
  gpuCartilages_.upload(cartilages);
  gpuSternum_.upload(sternum);
  gpuBar_.upload(bar);
}

void SceneParts::updateScan(const Context& context) {
  const Results& r = *context.results;
  const Comparison* comparison = r.comparisonValue();
  const std::shared_ptr<const Value> value = comparison ? comparison->sample : r.aligned.value;
  if (scanOf_ == value) return;
  scanOf_ = value;
  ++version_;
  Surface scan;
  const std::vector<PointField>* fields = nullptr;
  if (const auto* mesh = dynamic_cast<const Mesh*>(value.get())) {
    scan.points = mesh->points;
    scan.triangles = mesh->triangles;
    scan.computeNormals();
    fields = &mesh->fields;
  } else if (const auto* cloud = dynamic_cast<const Points*>(value.get())) {
    scan.points = cloud->points;
    scan.normals = cloud->normals;
    fields = &cloud->fields;
  }
  hasDistance_ = false;
  if (fields)
    for (const PointField& field : *fields)
      if (field.name == "distance") {
        scan.values = field.values;
        distanceLimit_ = roundLimit(scan.values.data(), scan.values.size());
        hasDistance_ = true;
      }
  gpuScan_.upload(scan);
}

void SceneParts::updatePicked(const Context& context) {
  const int point = context.picked ? context.picked->point : -1;
  const void* springs = context.picked ? context.picked->springs.data() : nullptr;
  if (pickedPoint_ == point && pickedSprings_ == springs && pickedVersion_ == version_) return;
  if (pickedPoint_ != point || pickedSprings_ != springs) ++version_;
  pickedPoint_ = point, pickedSprings_ = springs, pickedVersion_ = version_;
  Surface marker, lines;
  if (point >= 0 && std::size_t(point) < skin_.points.size()) {
    marker = ball(skin_.points[point], 3);
    for (const PickedSpring& s : context.picked->springs) {
      const std::array<Vec3, 2> ends{s.from, s.to};
      Surface line = tube(ends, 0.45, 6);
      line.values.assign(line.points.size(), s.force);
      lines.append(line);
    }
  }
  gpuPicked_.upload(marker);
  gpuSprings_.upload(lines);
}

const char* SceneParts::coloring(const Context& context) const {
  if (context.scene.hasScan && hasDistance_) return "Scan to predicted skin, mm";
  if (context.scene.skin == SkinLook::distance && context.results->scanDistances)
    return context.results->isLive ? "Scan to skin before it moved, mm" : "Scan to predicted skin, mm";
  if (context.scene.skin == SkinLook::displacement && !gpuSkin_.isEmpty()) return "Displacement, mm";
  return nullptr;
}
ColorMap SceneParts::map(const Context& context) const {
  const bool isDistance = hasDistance_ && (context.scene.hasScan || context.scene.skin == SkinLook::distance);
  return isDistance ? ColorMap::diverging : ColorMap::sequential;
}
double SceneParts::high(const Context& context) const {
  if (context.scene.isRangeFixed) return context.scene.range;
  return map(context) == ColorMap::diverging ? distanceLimit_ : displacementLimit_;
}
double SceneParts::low(const Context& context) const { return map(context) == ColorMap::diverging ? -high(context) : 0; }

std::vector<Item> SceneParts::items(const Context& context) const {
  const SceneOptions& o = context.scene;
  std::vector<Item> list;
  if (o.hasBones) {
    list.push_back({&gpuRibs_, {.color = kBone}});
    list.push_back({&gpuCartilages_, {.color = kCartilage}});
    list.push_back({&gpuSternum_, {.color = kBone}});
  }
  if (o.hasBar) list.push_back({&gpuBar_, {.color = kBar}});
  if (o.hasScan) list.push_back({&gpuScan_, {.color = kScan, .map = hasDistance_ ? ColorMap::diverging : ColorMap::none, .low = low(context), .high = high(context)}});
  if (o.hasSprings && context.picked && o.skin != SkinLook::hidden) {
    list.push_back({&gpuPicked_, {.color = kMarker, .isClipped = false}});
    if (o.part == 1) list.push_back({&gpuSprings_, {.map = ColorMap::diverging, .low = -1, .high = 1, .isClipped = false}});
  }
  Look skin{.color = kSkin};
  if (o.skin == SkinLook::glass) skin.isGlass = true;
  if (o.skin == SkinLook::displacement) skin.map = ColorMap::sequential, skin.low = 0, skin.high = o.isRangeFixed ? o.range : displacementLimit_;
  if (o.skin == SkinLook::distance && context.results->scanDistances) skin.map = ColorMap::diverging, skin.low = low(context), skin.high = high(context);
  if (o.skin != SkinLook::hidden) list.push_back({&gpuSkin_, skin});
  return list;
}

std::pair<Vec3, double> SceneParts::bounds() const {
  // At rest, so that where the camera stands does not depend on how far the solver had come when it was set.
  const std::vector<Vec3>& points = skin_.points.empty() ? sternumAtRest_.points : skinAtRest_;
  if (points.empty()) return {{}, 300};
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  return {(low + high) * 0.5, 0.5 * norm(Vec3{high.x - low.x, 0.3 * (high.y - low.y), high.z - low.z})};
}

}  // namespace pectora::view
