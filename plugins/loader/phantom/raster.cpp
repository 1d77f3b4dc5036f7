#include "raster.h"

#include "noise.h"
#include "smooth.h"


namespace pectora::phantom {

void TubeMap::draw(const std::vector<TubePiece>& pieces, const Grid& grid, double z) {
  for (std::size_t pixel : touched_) distance_[pixel] = kFar;
  touched_.clear();
  constexpr double margin = 2;
  for (const TubePiece& piece : pieces) {
    if (piece.lowest() - margin > z || piece.highest() + margin < z) continue;
    const double reach = piece.reach() + margin;
    const Vec3 end = piece.start + piece.along;
    const auto first = [&](double low, int axis) {
      return std::max(0, int(std::ceil((low - reach - grid.origin[axis]) / grid.spacing[axis])));
    };
    const auto last = [&](double high, int axis) {
      return std::min(grid.size[axis] - 1, int(std::floor((high + reach - grid.origin[axis]) / grid.spacing[axis])));
    };
    const int i1 = last(std::max(piece.start.x, end.x), 0), j1 = last(std::max(piece.start.y, end.y), 1);
    for (int j = first(std::min(piece.start.y, end.y), 1); j <= j1; ++j)
      for (int i = first(std::min(piece.start.x, end.x), 0); i <= i1; ++i) {
        const Vec3 p{grid.origin.x + i * grid.spacing.x, grid.origin.y + j * grid.spacing.y, z};
        const float d = float(piece.distanceTo(p));
        const std::size_t pixel = std::size_t(j) * grid.size[0] + i;
        if (d > margin || d >= distance_[pixel]) continue;
        if (distance_[pixel] == kFar) touched_.push_back(pixel);
        distance_[pixel] = d;
        piece_[pixel] = &piece;
      }
  }
}

Drawing::Drawing(const Patient& p, const Settings& s)
    : patient(p), settings(s), organs(std::min(18.0, 0.35 * p.pitDepth / p.before.pose.scale)),
      ribs(ribTubes(p.before)), cartilages(cartilageTubes(p.before, s.calcification, hash(std::uint64_t(s.seed), 11))),
      vessels(lungVessels(p.before, std::uint64_t(s.seed))) {
  // The couch touches the back where it is furthest behind, 2 mm of sheet between.
  couchTop = -1e9;
  const Pose& pose = p.before.pose;
  for (double z = pose.levelToBody(p.grid.origin.z); z < 20; z += 10)
    for (int degree = 100; degree <= 260; degree += 2)
      couchTop = std::max(couchTop, pose.toCt(p.before.torso->skin.at(radians(degree > 180 ? degree - 360 : degree), z)).y + 2);
}

Canvas::Canvas(const Grid& grid)
    : ribs(int(grid.sliceVoxels())), cartilages(int(grid.sliceVoxels())), vessels(int(grid.sliceVoxels())),
      hu(grid.sliceVoxels()), texture(grid.sliceVoxels()), label(grid.sliceVoxels()) {}

namespace {

/// One pixel while materials are laid over each other, deepest last.
struct Pixel {
  float hu = kAirHu.hu, texture = kAirHu.texture;
  std::uint8_t label = kAir;
  float perMm;  // 1 / pixel size

  void cover(double distance, Material material, std::uint8_t as) {
    const float share = std::clamp(0.5f - float(distance) * perMm, 0.0f, 1.0f);
    if (share <= 0) return;
    hu += (material.hu - hu) * share;
    texture += (material.texture - texture) * share;
    if (share > 0.5f) label = as;
  }
};

/// Polar surfaces at one level, ready for quick distances.
struct PolarLevel {
  std::vector<float> radii, factors;
  PolarLevel(const PolarTable& table, double z) : radii(table.levelRadii(z)), factors(table.levelNormalFactors(z)) {}
  double distance(int i, float t, double r) const {
    return (r - (radii[i] + (radii[i + 1] - radii[i]) * t)) * (factors[i] + (factors[i + 1] - factors[i]) * t);
  }
};

double sternumDistance(const SternumPlan& sternum, double s, double x, double y) {
  const double tilt = radians(sternum.manubriumTiltDeg) +
                      radians(sternum.bodyTiltDeg - sternum.manubriumTiltDeg) * step(-8, 8, s);
  const double inS = std::clamp(s, sternum.top(), sternum.bottom());
  const double half = sternum.thickness(inS) / 2 / std::cos(tilt), round = std::min(3.0, half - 0.5);
  const double u = std::abs(x) - sternum.halfWidth(inS) + round, v = std::abs(y - sternum.at(inS).y) - half + round;
  const double inPlane = std::min(std::max(u, v), 0.0) + std::hypot(std::max(u, 0.0), std::max(v, 0.0)) - round;
  return std::max({inPlane, sternum.top() - s, s - sternum.bottom()});
}

/// Everything of one level that pixels ask for.
struct ThinSlice {
  const Drawing& drawing;
  double z;
  Level level;
  PolarLevel wall, inner, muscle, skin;
  SpineLevel spine;
  double arc, outermost;

  ThinSlice(const Drawing& d, double bodyZ)
      : drawing(d), z(bodyZ), level(d.patient.before.level(bodyZ)), wall(torso().wall, z), inner(torso().inner, z),
        muscle(torso().muscle, z), skin(torso().skin, z), spine(z), arc(torso().skeleton.sternum.arcAt(z)),
        outermost(*std::max_element(skin.radii.begin(), skin.radii.end()) + 6) {}
  const Torso& torso() const { return *drawing.patient.before.torso; }

  void drawInside(Pixel& pixel, Vec3 p, double toInner, bool isSmallVessel, double toSmallVessel) const {
    const Organs& organs = drawing.organs;
    const double belowDiaphragm = organs.aboveDiaphragm(p);
    const OrganDistances at = organs.at(p);
    pixel.cover(toInner, kMediastinumHu, kMediastinum);
    const double abdomen = std::max(toInner, belowDiaphragm);
    if (abdomen < 2) {
      pixel.cover(abdomen, kMuscleHu, kMuscle);
      pixel.cover(abdomen + 2.5, kAbdomenHu, kAbdomen);
      pixel.cover(std::max(abdomen + 3, organs.liver(p)), kLiverHu, kLiver);
    }
    const double lung = std::max({toInner, organs.lungLimits(p), -at.mediastinum});
    if (lung < 2) {
      pixel.cover(lung, kLungHu, kLung);
      if (isSmallVessel) pixel.cover(std::max(lung + 2, toSmallVessel), kBloodHu, kVessel);
    }
    pixel.cover(std::max({at.heart, toInner + 3, belowDiaphragm < 0 ? 3.0 : -99.0}), kBloodHu, kHeart);
    pixel.cover(at.vessels, kBloodHu, kVessel);
    pixel.cover(at.airway - 1.2, kMuscleHu, kMediastinum);
    pixel.cover(at.airway, kAirHu, kAirway);
  }

  void drawSpine(Pixel& pixel, double x, double y) const {
    const double bone = spine.bone(x, y), body = spine.body(x, y);
    if (bone > 2) {
      pixel.cover(spine.canal(x, y), kCanalHu, kCanal);
      return;
    }
    if (spine.isDisc() && body < 0) {
      pixel.cover(body, kDiscHu, kDisc);
      return;
    }
    pixel.cover(bone, kVertebraCortexHu, kVertebra);
    pixel.cover(std::max(bone + 1.0, 1.0 - spine.toEndPlate()), kVertebraHu, kVertebra);
    pixel.cover(spine.canal(x, y), kCanalHu, kCanal);
  }

  void drawSternum(Pixel& pixel, double x, double y) const {
    const double distance = sternumDistance(torso().skeleton.sternum, arc, x, y);
    if (distance > 2) return;
    if (arc > torso().skeleton.sternum.bodyLength + 1) {
      pixel.cover(distance, kXiphoidHu, kXiphoid);
      return;
    }
    pixel.cover(distance, kSternumCortexHu, kSternum);
    pixel.cover(distance + 1.1, kSternumHu, kSternum);
  }
};

void drawCouch(Pixel& pixel, const Drawing& drawing, Vec3 p) {
  const double depth = p.y - drawing.couchTop;
  const double shape = std::max({-depth, depth - 45, std::abs(p.x) - 210});
  pixel.cover(shape, kCouchShellHu, kCouch);
  pixel.cover(shape + 2, kCouchFoamHu, kCouch);
}

}  // namespace

void drawThinSlice(const Drawing& drawing, double ctZ, Canvas& canvas) {
  const Grid& grid = drawing.patient.grid;
  const Pose& pose = drawing.patient.before.pose;
  canvas.ribs.draw(drawing.ribs, grid, ctZ);
  canvas.cartilages.draw(drawing.cartilages, grid, ctZ);
  canvas.vessels.draw(drawing.vessels, grid, ctZ);
  const ThinSlice slice(drawing, pose.levelToBody(ctZ));
  const double toBody = 1 / pose.scale, center = polarCenterY(slice.z);

  for (int j = 0; j < grid.size[1]; ++j)
    for (int i = 0; i < grid.size[0]; ++i) {
      const std::size_t index = std::size_t(j) * grid.size[0] + i;
      const Vec3 ct{grid.origin.x + i * grid.spacing.x, grid.origin.y + j * grid.spacing.y, ctZ};
      Pixel pixel;
      pixel.perMm = float(1 / grid.spacing.x);
      if (drawing.settings.hasCouch) drawCouch(pixel, drawing, ct);
      pixel.perMm = float(pose.scale / grid.spacing.x);

      Vec3 p = pose.toBody(ct);
      p.y = slice.level.undeformedY(p.x, p.y);
      const double r = std::hypot(p.x, p.y - center);
      if (r < slice.outermost) {
        const double u = std::clamp(std::atan2(p.x, center - p.y) * 180 / kPi + 180, 0.0, 359.999);
        const int a = int(u);
        const float t = float(u - a);
        const double toSkin = slice.skin.distance(a, t, r);
        if (drawing.settings.hasClothing) {
          pixel.cover(toSkin - 3.2, kClothingHu, kClothing);
          pixel.cover(toSkin - 1.7, kAirHu, kAir);
        }
        if (toSkin < 2) {
          pixel.cover(toSkin, kSkinHu, kSkin);
          pixel.cover(toSkin + kSkinThickness * toBody, kFatHu, kFat);
          const double toMuscle = slice.muscle.distance(a, t, r), toWall = slice.wall.distance(a, t, r);
          const double toInner = slice.inner.distance(a, t, r);
          pixel.cover(toMuscle, kMuscleHu, kMuscle);
          // Thin layers of fat part the intercostals from the muscles outside and from the pleura.
          if (slice.z < 0 && slice.z > -300) pixel.cover(std::max(std::abs(toWall - 4.6) - 0.5, toMuscle + 2), kFatHu, kFat);
          pixel.cover(toInner - 1.3, kFatHu, kFat);
          const float toVessel = canvas.vessels.distance(index);
          if (toInner < 2) slice.drawInside(pixel, p, toInner, toVessel < 2, toVessel * toBody);
          // Skeleton, in the order of what lies over what; tubes' distances are in CT mm.
          if (canvas.cartilages.distance(index) < TubeMap::kFar) {
            const TubePiece& piece = canvas.cartilages.piece(index);
            const double d = canvas.cartilages.distance(index) * toBody;
            pixel.cover(d, kCartilageHu, piece.label);
            if (piece.isCalcified) pixel.cover(d + 1, kCalcifiedHu, piece.label);
          }
          slice.drawSternum(pixel, p.x, p.y);
          if (SpineLevel::isNear(p.x, p.y)) slice.drawSpine(pixel, p.x, p.y);
          if (canvas.ribs.distance(index) < TubeMap::kFar) {
            const double d = canvas.ribs.distance(index) * toBody;
            pixel.cover(d, kCorticalHu, canvas.ribs.piece(index).label);
            pixel.cover(d + 1.0, kCancellousHu, canvas.ribs.piece(index).label);
          }
        }
      }
      canvas.hu[index] = pixel.hu;
      canvas.texture[index] = pixel.texture;
      canvas.label[index] = pixel.label;
    }
}

}  // namespace pectora::phantom
