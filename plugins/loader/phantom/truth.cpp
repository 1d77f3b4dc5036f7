// The exact anatomy of the patient, as a perfect segmentation of the CT would give it.
#include "phantom.h"
#include "skeleton.h"

#include "smooth.h"
#include "kernel/value/curve.h"

namespace pectora::phantom {
namespace {

constexpr double kLayerSpacingMm = 2;  // of points along a layer's line
constexpr double kMeshSpacing = 3;     // of mesh rows, unscaled mm

std::vector<Vec3> place(const Body& body, const std::vector<Vec3>& line) {
  std::vector<Vec3> placed;
  for (const Vec3& p : line) placed.push_back(body.place(p));
  return placed;
}

/// Closed axial contour of the sternum at a level: a rectangle with round corners, as the CT shows it.
std::vector<Vec3> sternumContour(const Body& body, const Level& level, double s) {
  const SternumPlan& plan = body.torso->skeleton.sternum;
  const double half = plan.thickness(s) / 2 / std::cos(plan.tiltAt(s)), width = plan.halfWidth(s);
  const double round = std::min(3.0, half - 0.5), middle = plan.at(s).y;
  std::vector<Vec3> contour;
  const double cornersX[] = {1, -1, -1, 1}, cornersY[] = {1, 1, -1, -1};
  for (int corner = 0; corner < 4; ++corner)
    for (int i = 0; i <= 6; ++i) {
      const double angle = kPi / 2 * (corner + i / 6.0);
      const double x = cornersX[corner] * (width - round) + round * std::cos(angle);
      const double y = middle + cornersY[corner] * (half - round) + round * std::sin(angle);
      contour.push_back(body.pose.toCt({x, y + level.bone(x), level.z()}));
    }
  return contour;
}

Sternum makeSternum(const Body& body, const Grid& grid) {
  const SternumPlan& plan = body.torso->skeleton.sternum;
  Sternum sternum;
  for (double s = plan.top(); s <= plan.bodyLength + 1e-9; s += 3) sternum.axis.push_back(body.place(plan.at(s)));
  for (int k = grid.size[2] - 1; k >= 0; --k) {
    const double z = body.pose.levelToBody(grid.origin.z + k * grid.spacing.z), s = plan.arcAt(z);
    if (s >= plan.top() && s <= plan.bodyLength) sternum.contours.push_back(sternumContour(body, body.level(z), s));
  }
  sternum.jugularNotch = body.place(plan.at(plan.top()));
  sternum.manubriosternalJoint = body.place(plan.at(0));
  sternum.xiphisternalJoint = body.place(plan.at(plan.bodyLength));

  // Deepest point of the front surface of the body's caudal half.
  double deepest = -1e9, where = 0, column = 0;
  for (double s = plan.bodyLength / 2; s <= plan.bodyLength; s += 1) {
    const Vec3 middle = plan.at(s);
    const Level level = body.level(middle.z);
    const double half = plan.halfWidth(s) - 3;
    for (double x = -half; x <= half + 1e-9; x += half / 16) {
      const double y = middle.y - plan.thickness(s) / 2 / std::cos(plan.tiltAt(s)) + level.bone(x);
      if (y > deepest) deepest = y, where = s, column = x;
    }
  }
  sternum.deepest = body.pose.toCt({column, deepest, plan.at(where).z});

  // Tilt of the body's axis and torsion of its section at the deepest level, both of the deformed bone.
  const Vec3 axis = sternum.xiphisternalJoint - sternum.manubriosternalJoint;
  sternum.tiltDeg = std::atan2(-axis.y, -axis.z) * 180 / kPi;
  const double z = plan.at(where).z, width = 12;
  const Level level = body.level(z);
  sternum.torsionDeg = std::atan2(level.bone(width) - level.bone(-width), 2 * width) * 180 / kPi;

  for (int number = 1; number <= 7; ++number)
    for (Side side : {Side::right, Side::left}) {
      Vec3 p = plan.at(ribRow(number).notch);
      p.x = side == Side::right ? -18 : 18;
      sternum.notches.push_back({side, number, body.place(p)});
    }
  return sternum;
}

/// The line of a surface at one level from the patient's right over the front to the left, between the two places
/// where it crosses the coronal plane y = plane (CT).
LayerSlice layer(const Body& body, const PolarTable& surface, const Level& level, double plane, const Grid& grid) {
  LayerSlice slice;
  slice.z = body.pose.levelToCt(level.z());
  std::vector<Vec3> front;
  for (int i = -360; i <= 360; ++i) {
    const Vec3 p = body.surfacePoint(surface, level, radians(i * 0.45));
    if (!front.empty() || p.y < plane) front.push_back(p);
    if (front.size() > 1 && p.y >= plane) {
      const Vec3 before = front[front.size() - 2];
      front.back() = lerp(before, p, (plane - before.y) / (p.y - before.y));
      break;
    }
    // The first point is where the plane was crossed.
    if (front.size() == 1 && i > -360) {
      const Vec3 before = body.surfacePoint(surface, level, radians((i - 1) * 0.45));
      front.insert(front.begin(), lerp(before, p, (plane - before.y) / (p.y - before.y)));
    }
  }
  slice.points = resamplePolyline(front, std::max(8, int(polylineLength(front) / kLayerSpacingMm) + 1));
  for (const Vec3& p : slice.points) {
    const Vec3 voxel = grid.toVoxel(p);
    slice.clipped |= voxel.x < 0 || voxel.y < 0 || voxel.x > grid.size[0] - 1 || voxel.y > grid.size[1] - 1;
  }
  return slice;
}

}  // namespace

std::shared_ptr<const Truth> makeTruth(const Patient& patient, std::shared_ptr<const Labels> labels) {
  const Body& body = patient.before;
  const Skeleton& skeleton = body.torso->skeleton;
  const Grid& grid = patient.grid;
  auto anatomy = std::make_shared<Anatomy>();
  for (const BoneLine& rib : skeleton.ribs) {
    Rib found{rib.side, rib.number, place(body, rib.line), true, true};
    found.reachesJunction = found.centerline.back().z >= grid.origin.z;
    anatomy->ribs.push_back(std::move(found));
  }
  anatomy->sternum = makeSternum(body, grid);

  // Layers from the costal arch up to the apex of the lungs; beyond them there is no inner wall.
  const double plane = body.pose.toCt({0, 0, 0}).y;
  const double top = std::min(-12.0, skeleton.sternum.at(skeleton.sternum.top()).z + 30);
  for (int k = 0; k < grid.size[2]; ++k) {
    const double z = body.pose.levelToBody(grid.origin.z + k * grid.spacing.z);
    anatomy->vertebralFront.push_back(body.pose.toCt({0, kVertebralFront, z}));
    if (z > top) continue;
    const Level level = body.level(z);
    anatomy->skin.push_back(layer(body, body.torso->skin, level, plane, grid));
    anatomy->pleura.push_back(layer(body, body.torso->inner, level, plane, grid));
    const LevelMetrics metrics = body.measure(z);
    if (metrics.sternumToVertebra > 0) anatomy->metrics.push_back(metrics);
  }

  auto truth = std::make_shared<Truth>();
  for (const BoneLine& cartilage : skeleton.cartilages)
    truth->cartilages.push_back({cartilage.side, cartilage.number, cartilage.joins, place(body, cartilage.line)});
  const double low = -500, high = 50;
  truth->skinBefore = patient.before.tube(body.torso->skin, low, high, kMeshSpacing);
  truth->skinAfter = patient.after.tube(body.torso->skin, low, high, kMeshSpacing);
  truth->pleura = body.tube(body.torso->inner, -320, top, kMeshSpacing);
  if (const LevelMetrics* deepest = anatomy->deepestLevel()) {
    truth->hallerIndex = deepest->haller();
    truth->correctionIndex = deepest->correctionIndex();
  }
  truth->pitDepth = patient.pitDepth;
  truth->anatomy = std::move(anatomy);
  truth->labels = std::move(labels);
  return truth;
}

}  // namespace pectora::phantom
