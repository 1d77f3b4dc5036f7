#include "plugins/segmenter/thorax/segment.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr double kLeastAreaMm2 = 8;
constexpr double kVertebraMm = 45;   // from the column's middle
constexpr double kAcrossMm = 6;      // on both sides of the column
constexpr double kNeckMm = 30;       // nearer to the column a rib is part of the vertebra's contour
constexpr double kBladeHu1 = 0.35;   // Hu's first moment: 0.16 for a disc, 0.35 for an ellipse of 4 : 1

}  // namespace

std::vector<SliceContour> classifyBones(const Field& field, int slice, double boneHu, const std::vector<FoundRib>& ribs,
                                        const std::vector<SternumSlice>& sternum, const Spine& spine) {
  const Box& box = field.box();
  const Vec3 spacing = field.spacing();
  Plane plane(box.size(0), box.size(1));
  for (int j = 0; j < plane.height; ++j)
    for (int i = 0; i < plane.width; ++i) plane.at(i, j) = field.voxel(i + box.low[0], j + box.low[1], slice);
  const double z = slice * spacing.z, reach = std::max(1.5, 0.6 * spacing.z);
  const SternumSlice* breastbone = nullptr;
  for (const SternumSlice& s : sternum)
    if (s.slice == slice && s.isSeen) breastbone = &s;

  std::vector<SliceContour> result;
  if (breastbone) {
    result.push_back({.slice = slice, .structure = "sternum", .points = {}});
    for (const Point2& p : breastbone->contour) result.back().points.push_back({p.x, p.y, z});
  }
  for (Loop& loop : isoContours(plane, float(boneHu))) {
    for (Point2& p : loop) p = {(p.x + box.low[0]) * spacing.x, (p.y + box.low[1]) * spacing.y};
    const Shape shape = shapeOf(loop);
    if (shape.area < kLeastAreaMm2) continue;
    SliceContour contour;
    contour.slice = slice;
    const Point2 c = shape.centroid;
    for (const Point2& p : loop) contour.points.push_back({p.x, p.y, z});

    const double fromColumn = std::hypot(c.x - spine.centre[slice].x, c.y - spine.centre[slice].y);
    if (breastbone && isInside(breastbone->contour, c)) continue;
    // Around the middle of the column, or across it behind: at a disc the arch may be one with the ribs of both sides.
    const auto [right, left] = std::minmax_element(loop.begin(), loop.end(), [](Point2 a, Point2 b) { return a.x < b.x; });
    const bool isAcross = right->x < spine.centre[slice].x - kAcrossMm && left->x > spine.centre[slice].x + kAcrossMm && fromColumn < kVertebraMm;
    if (contour.structure.empty() && (isAcross || isInside(loop, {spine.centre[slice].x, spine.centre[slice].y})))
      contour.structure = "vertebra";
    for (std::size_t r = 0; r < ribs.size() && contour.structure.empty(); ++r)
      for (const Vec3& p : ribs[r].body.line)
        if (std::abs(p.z - z) < reach && isInside(loop, {p.x, p.y}) &&
            std::hypot(p.x - spine.centre[slice].x, p.y - spine.centre[slice].y) > kNeckMm) {
          contour.structure = "rib";
          contour.number = ribs[r].number;
          contour.side = ribs[r].side;
          break;
        }
    if (contour.structure.empty() && fromColumn < kVertebraMm && c.y > spine.front[slice].y) contour.structure = "vertebra";
    if (contour.structure.empty())
      contour.structure = shape.hu[0] > kBladeHu1 && shape.area > 60 && c.y > spine.front[slice].y - 40 ? "scapula" : "other";
    result.push_back(std::move(contour));
  }
  return result;
}

}  // namespace pectora::thorax
