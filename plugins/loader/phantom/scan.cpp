// What a hand-held scanner sees of the chest some months after the operation.
#include "phantom.h"

#include "noise.h"
#include "smooth.h"
#include "kernel/value/curve.h"

namespace pectora::phantom {
namespace {

/// A rotation and a shift.
struct Rigid {
  std::array<Vec3, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 shift;

  Vec3 turn(Vec3 p) const { return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)}; }
  Vec3 operator()(Vec3 p) const { return turn(p) + shift; }
};

/// Rotation by an angle about a unit axis (Rodrigues).
Rigid rotation(Vec3 axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Rigid rigid;
  for (int row = 0; row < 3; ++row) {
    Vec3 unit;
    unit[row] = 1;
    // Row r of R is e_r^T R.
    rigid.rows[row] = unit * c - cross(axis, unit) * s + axis * (dot(axis, unit) * (1 - c));
  }
  return rigid;
}

Vec3 normals3(Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

/// The skin as rows of points, closely spaced, to be looked up bilinearly.
class SkinSheet {
 public:
  SkinSheet(const Body& body, double bottom, double top) : bottom_(bottom), rows_(int((top - bottom) / kStep) + 1) {
    for (int row = 0; row < rows_; ++row) {
      const Level level = body.level(bottom + row * kStep);
      for (int i = 0; i <= kColumns; ++i)
        points_.push_back(body.surfacePoint(body.torso->skin, level, radians(i - 180.0)));
    }
  }
  Vec3 at(double angleDeg, double z) const {
    const double u = std::clamp(angleDeg + 180, 0.0, kColumns - 1e-6);
    const double v = std::clamp((z - bottom_) / kStep, 0.0, rows_ - 1 - 1e-6);
    const int i = int(u), j = int(v);
    const Vec3* row = &points_[std::size_t(j) * (kColumns + 1) + i];
    const Vec3* above = row + kColumns + 1;
    return lerp(lerp(row[0], row[1], u - i), lerp(above[0], above[1], u - i), v - j);
  }
  Vec3 normal(double angleDeg, double z) const {
    return normalized(cross(at(angleDeg + 1, z) - at(angleDeg - 1, z), at(angleDeg, z + 2) - at(angleDeg, z - 2)));
  }

 private:
  static constexpr int kColumns = 360;
  static constexpr double kStep = 2;
  double bottom_;
  int rows_;
  std::vector<Vec3> points_;
};

/// How well the scanner sees a place: the armpits stay in the shade of the raised arms.
bool isInArmpit(double angleDeg, double z) {
  const double across = (std::abs(angleDeg) - 92) / 22, up = (z + 48) / 48;
  return across * across + up * up < 1;
}

}  // namespace

Landmarks skinLandmarks(const Body& body) {
  const SternumPlan& sternum = body.torso->skeleton.sternum;
  const auto at = [&](double angleDeg, double z) {
    return body.surfacePoint(body.torso->skin, body.level(z), radians(angleDeg));
  };
  // Raised arms draw the nipples to the level of the third intercostal space.
  const double nippleZ = sternum.at(58).z, nippleAngle = 52;
  Landmarks landmarks;
  landmarks.points = {{"neck", at(0, sternum.at(sternum.top()).z + 4)},
                      {"navel", at(0, navelLevel(sternum))},
                      {"nipple_right", at(-nippleAngle, nippleZ)},
                      {"nipple_left", at(nippleAngle, nippleZ)}};
  return landmarks;
}

Scan scanSkin(const Patient& patient, const Settings& settings) {
  Random random(hash(std::uint64_t(settings.seed), 41));
  const double bottom = navelLevel(patient.after.torso->skeleton.sternum) - 60, top = 45;
  const SkinSheet sheet(patient.after, bottom - 4, top + 4);

  // The scanner's frame: x to the patient's left, y up, z forwards (as it stands before the patient), then anyhow.
  Rigid toScanner;
  {
    const Rigid tilt = rotation(normalized(normals3(random)), radians(25) * (0.2 + 0.8 * random.uniform()));
    const Rigid frame{{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}}, {}};
    for (int row = 0; row < 3; ++row) {
      const Vec3 r = tilt.rows[row];
      toScanner.rows[row] = {dot(r, frame.turn({1, 0, 0})), dot(r, frame.turn({0, 1, 0})), dot(r, frame.turn({0, 0, 1}))};
    }
    toScanner.shift = normals3(random) * 120 + Vec3{150, 80, 420};
  }

  auto points = std::make_shared<Points>();
  // Overlapping sweeps up and down the body; each consists of lines across it.
  constexpr int kSweeps = 7;
  constexpr double kReachDeg = 118, kHalfSweepDeg = 27;
  const double scale = patient.after.pose.scale;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const double middle = -kReachDeg + kHalfSweepDeg + (2 * kReachDeg - 2 * kHalfSweepDeg) * sweep / (kSweeps - 1);
    // The tracker's error is nearly constant during a sweep.
    const Vec3 slip = normals3(random) * (settings.scanMisregistration / std::sqrt(3.0));
    for (double z = bottom; z <= top; z += settings.scanSpacing / scale * (0.9 + 0.2 * random.uniform())) {
      // A line wavers, and its ends are ragged.
      const double lean = 3 * std::sin(z / 40 + sweep);
      const double from = middle - kHalfSweepDeg - 4 * random.uniform();
      const double to = middle + kHalfSweepDeg + 4 * random.uniform();
      for (double angle = from; angle <= to;) {
        const double level = z + lean * (angle - middle) / kHalfSweepDeg;
        const Vec3 p = sheet.at(angle, level), next = sheet.at(angle + 0.5, level);
        const double noise = settings.scanNoise * random.normal();
        const bool isLost = random.uniform() < 0.03;
        if (!isLost && !isInArmpit(angle, level) && level >= bottom && level <= top) {
          const Vec3 normal = sheet.normal(angle, level);
          points->points.push_back(toScanner(p + slip + normal * noise));
          points->normals.push_back(toScanner.turn(normal));
          points->sweeps.push_back(sweep);
        }
        angle += settings.scanSpacing * 0.5 / std::max(0.2, distance(p, next)) * (0.9 + 0.2 * random.uniform());
      }
    }
  }

  auto landmarks = std::make_shared<Landmarks>(skinLandmarks(patient.after));
  for (Landmark& landmark : landmarks->points)
    landmark.position = toScanner(landmark.position + normals3(random) * settings.landmarkNoise);
  return {points, landmarks};
}

}  // namespace pectora::phantom
