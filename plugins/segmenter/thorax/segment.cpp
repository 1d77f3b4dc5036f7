#include "plugins/segmenter/thorax/segment.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"
#include "kernel/value/levels.h"
#include "plugins/segmenter/thorax/doubts.h"
#include "plugins/segmenter/thorax/frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectora::thorax {
namespace {

double medianOf(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// How far a point lies behind another along the axis of a patient who is turned about z.
double depthBehind(Vec3 p, Vec3 origin, double turnDeg) {
  const double a = turnDeg * std::numbers::pi / 180;
  return std::cos(a) * (p.y - origin.y) - std::sin(a) * (p.x - origin.x);
}

/// The part of the inner wall in front of the coronal plane, from right to left.
std::vector<Point2> wallOf(const PolarGrid& grid, const std::vector<double>& radius, int slice, int row, double degrees) {
  std::vector<Point2> line;
  for (int n = 0; n < PolarGrid::kAngles; ++n)
    if (std::abs(PolarGrid::degrees(n)) <= degrees + 1e-9)
      line.push_back(grid.at(slice, PolarGrid::degrees(n), radius[std::size_t(row) * PolarGrid::kAngles + n]));
  return line;
}

}  // namespace

std::shared_ptr<const Anatomy> segment(std::shared_ptr<const Volume> given, const Settings& settings, Host& host) {
  if (given->hu.size() != given->grid.voxels() || given->hu.empty())
    throw Error("the CT holds no voxels, or fewer than its grid says").advise("load the whole series");
  const auto part = [&](double from, double to, const char* what) {
    return [&host, from, to, what](double done) {
      host.checkCancel();
      host.progress(from + (to - from) * done, what);
    };
  };
  const std::shared_ptr<const Volume> ct = upright(given);
  const Grid& grid = ct->grid;
  if (grid.size[2] < 2 || grid.size[2] * grid.spacing.z < 30)
    throw Error("the CT is too short to hold a chest")
        .given(std::to_string(grid.size[2]) + " slices")
        .allowed("at least 30 mm of slices")
        .advise("load the whole series");

  if (grid.spacing.z > kThickestMm)
    throw Error("the slices are too thick: between them ribs cannot be followed")
        .given(std::to_string(grid.spacing.z) + " mm apart")
        .allowed("up to " + std::to_string(int(kThickestMm)) + " mm")
        .advise("ask for the thin reconstruction of the same scan");

  // Body, spine, sternum, ribs.
  const Body body = findBody(*ct, part(0, 0.15, "finding the body"));
  Field field(*ct, body.box, settings.smoothingMm, part(0.15, 0.35, "smoothing"));
  for (const BoneRegion& region : settings.regions)
    field.shift(toLocal(grid, region.low), toLocal(grid, region.high), settings.boneHu - region.boneHu);
  part(0.35, 0.4, "following the spine")(0);
  const Spine spine = findSpine(body, field, settings.boneHu);
  part(0.4, 0.45, "following the sternum")(0);
  const std::vector<SternumSlice> sternum = findSternum(body, field, spine, settings.boneHu);
  std::vector<std::string> warnings;
  const std::vector<FoundRib> ribs =
      findRibs(body, field, spine, findSecondNotches(sternum, grid.spacing.z), settings.boneHu, warnings, part(0.45, 0.6, "tracking the ribs"));
  for (const std::string& warning : warnings) host.warn(warning);
  if (ribs.empty()) host.warn("no ribs were found");
  if (sternum.empty()) host.warn("no sternum was found");
  else if (sternum.front().slice >= body.lastSlice - 1)
    host.warn("the sternum's upper end is not in view: its notch and joints are estimates");
  else if (sternum.back().slice <= body.firstSlice + 1)
    host.warn("the sternum's lower end is not in view: its joints are estimates");

  // The coronal plane: the front of the vertebral bodies, the median over all slices where the column was seen.
  std::vector<double> fronts;
  for (int k = spine.firstSlice; k <= spine.lastSlice; ++k) fronts.push_back(spine.front[k].y);
  PolarGrid polar;
  polar.poleY = medianOf(fronts);
  for (const Vec3& p : spine.front) polar.poleX.push_back(p.x);

  // Skin in every slice of the body, pleura through all of them.
  const int first = body.firstSlice, slices = body.lastSlice - first + 1;
  std::vector<SkinSlice> skin(slices);
  constexpr int kSlab = 16;
  for (int s = 0; s < slices; s += kSlab) {
    part(0.6, 0.75, "outlining the skin")(double(s) / slices);
    parallelFor(std::min(kSlab, slices - s), [&](std::size_t t) {
      skin[s + t] = findSkin(*ct, body, first + s + int(t), polar.poleY, settings.skin);
    });
  }
  const std::vector<double> wall = findPleura(field, body, polar, ribs, sternum, skin, first, settings.boneHu,
                                              settings.pleura, part(0.75, 0.9, "outlining the pleura"));

  // Into patient coordinates.
  part(0.9, 1, "measuring")(0);
  auto anatomy = std::make_shared<Anatomy>();
  const double turn = anatomy->turnDeg = patientTurn(ribs);
  const auto patient = [&](Vec3 p) { return toPatient(grid, p); };
  const auto lift = [&](const std::vector<Point2>& line, double z) {
    std::vector<Vec3> points;
    for (const Point2& p : line) points.push_back(patient({p.x, p.y, z}));
    return points;
  };
  for (const FoundRib& rib : ribs) {
    Rib r{rib.side, rib.number, {}, rib.body.reachesVertebra, rib.body.reachesJunction};
    for (const Vec3& p : rib.body.line) r.centerline.push_back(patient(p));
    anatomy->ribs.push_back(std::move(r));
  }
  anatomy->sternum = measureSternum(sternum, grid.spacing.z, turn);
  Sternum& bone = anatomy->sternum;
  if (!sternum.empty()) {
    for (Vec3& p : bone.axis) p = patient(p);
    for (auto& contour : bone.contours)
      for (Vec3& p : contour) p = patient(p);
    for (Notch& notch : bone.notches) notch.position = patient(notch.position);
    for (Vec3* p : {&bone.jugularNotch, &bone.manubriosternalJoint, &bone.xiphisternalJoint, &bone.deepest}) *p = patient(*p);
  }

  std::vector<std::vector<SliceContour>> bones(slices);
  parallelFor(slices, [&](std::size_t s) {
    if (int(s) % settings.everySlice == 0)
      bones[s] = classifyBones(field, first + int(s), settings.boneHu, ribs, sternum, spine);
  });
  std::size_t withoutSkin = 0;
  for (int s = 0; s < slices; s += settings.everySlice) {
    const int k = first + s;
    const double z = k * grid.spacing.z;
    const Vec3 front = spine.front[k];
    if (k >= spine.firstSlice && k <= spine.lastSlice) anatomy->vertebralFront.push_back(patient(front));
    for (SliceContour& contour : bones[s]) {
      // Couch and what lies on it is no bone.
      if (skin[s].whole.empty() || !isInside(skin[s].whole, {contour.points.front().x, contour.points.front().y})) continue;
      for (Vec3& p : contour.points) p = patient(p);
      anatomy->contours.push_back(std::move(contour));
    }
    if (skin[s].front.size() < 3) {
      ++withoutSkin;
      continue;
    }
    const double level = patient({front.x, front.y, z}).z;
    anatomy->skin.push_back({level, lift(skin[s].front, z), skin[s].clipped});
    anatomy->pleura.push_back({level, lift(wallOf(polar, wall, k, s, 90), z), skin[s].clipped});
    anatomy->contours.push_back({k, "skin", 0, Side::right, anatomy->skin.back().points, false});
    anatomy->contours.push_back({k, "pleura", 0, Side::right, anatomy->pleura.back().points, false});

    const auto here = std::find_if(sternum.begin(), sternum.end(), [&](const SternumSlice& x) { return x.slice == k; });
    if (here == sternum.end()) continue;
    LevelMetrics metrics = measureLevel(level, lift(here->contour, z), patient(front), lift(wallOf(polar, wall, k, s, 120), z), turn);
    // Outside: the whole outline's width, and its back.
    const LevelMetrics whole = measureLevel(level, {}, patient(front), lift(skin[s].whole, z), turn);
    double back = 0;
    for (const Vec3& p : lift(skin[s].whole, z)) back = std::max(back, depthBehind(p, patient(front), turn));
    if (!skin[s].clipped) measureSkin(metrics, anatomy->skin.back().points, patient(front), turn, whole.transverse, back);
    if (metrics.transverse > 0 && metrics.sternumToVertebra > 0 && metrics.deepestInnerWall > 0)
      anatomy->metrics.push_back(metrics);
  }
  if (withoutSkin) host.warn(std::to_string(withoutSkin) + " levels have no skin in front of the coronal plane");
  std::vector<char> isClipped;
  for (const SkinSlice& slice : skin) isClipped.push_back(slice.clipped);
  anatomy->ranges = findDoubts(*ct, body, isClipped, [&](int k) { return patient({spine.front[k].x, spine.front[k].y, k * grid.spacing.z}).z; });
  for (const SliceRange& range : anatomy->ranges) host.warn(sentence(range));
  host.progress(1, "segmented");
  return anatomy;
}

}  // namespace pectora::thorax
