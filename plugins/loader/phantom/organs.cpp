#include "organs.h"

#include "smooth.h"

namespace pectora::phantom {
namespace {

/// First-order distance to an ellipsoid.
double ellipsoid(Vec3 d, Vec3 radii) {
  const Vec3 u{d.x / radii.x, d.y / radii.y, d.z / radii.z};
  const Vec3 g{u.x / radii.x, u.y / radii.y, u.z / radii.z};
  const double k = norm(u), gradient = norm(g);
  return gradient > 1e-9 ? k * (k - 1) / gradient : -std::min({radii.x, radii.y, radii.z});
}

double capsule(Vec3 p, Vec3 a, Vec3 b, double radius) {
  const Vec3 along = b - a;
  const double t = std::clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0);
  return distance(p, a + along * t) - radius;
}

/// Dome of one side of the diaphragm: height at (x, y).
double dome(Vec3 p, double sign, double top) {
  const double lateral = sign * p.x - 65, posterior = p.y + 45;
  const double u = lateral / (lateral > 0 ? 75 : 150), v = posterior / (posterior > 0 ? 70 : 170);
  return top - 90 * (u * u + v * v);
}

double smoothMinimum(double a, double b, double blend) {
  const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - h * h * blend / 4;
}

}  // namespace

OrganDistances Organs::at(Vec3 p) const {
  OrganDistances d{};
  const double shift = heartShift_;
  d.heart = ellipsoid(p - Vec3{20 + shift, -64, -174}, {50, 40, 50});
  // Ascending aorta, arch, descending aorta; pulmonary trunk; superior vena cava.
  d.vessels = capsule(p, {-8, -62, -66}, {-4, -60, -130}, 13);
  d.vessels = std::min(d.vessels, capsule(p, {-8, -60, -64}, {16, -18, -66}, 11.5));
  d.vessels = std::min(d.vessels, capsule(p, {17, -18, -68}, {12, -20, -420}, 9.5));
  d.vessels = std::min(d.vessels, capsule(p, {14, -66, -98}, {22, -60, -130}, 12));
  d.vessels = std::min(d.vessels, capsule(p, {-36, -38, -112}, {38, -34, -106}, 8.5));
  d.vessels = std::min(d.vessels, capsule(p, {-23, -52, -40}, {-22, -50, -140}, 8));
  d.airway = capsule(p, {0, -26, 60}, {0, -32, -88}, 8);
  d.airway = std::min(d.airway, capsule(p, {0, -32, -88}, {-34, -30, -116}, 5.5));
  d.airway = std::min(d.airway, capsule(p, {0, -32, -88}, {36, -28, -118}, 5));

  // Mediastinum: what surrounds them, a thin septum in front, the spine behind.
  const double septum = std::abs(p.x - 2) - 4.5 - 8 * step(-140, -220, p.z);
  const double spine = std::max(std::hypot(p.x, std::max(0.0, -p.y) * 1.1) - 19.5, -p.y - 40);
  const double hilum = ellipsoid(p - Vec3{0, -38, -80}, {25, 34, 72});
  d.mediastinum = std::min({smoothMinimum(septum, d.heart - 3, 12), spine, d.vessels - 2.5, d.airway - 2.5});
  d.mediastinum = smoothMinimum(d.mediastinum, hilum, 10);
  return d;
}

double Organs::aboveDiaphragm(Vec3 p) const {
  const double right = dome(p, -1, -214), left = dome(p, 1, -222);
  return 0.75 * (p.z + smoothMinimum(-right, -left, 20));
}

double Organs::lungLimits(Vec3 p) const {
  // The apex is a cap over each side, tilted forwards with the first rib.
  const double u = (std::abs(p.x) - 36) / 40, v = (p.y - 2) / 46;
  const double apex = 0.8 * (p.z - (6 - 26 * (u * u + v * v)));
  return std::max(apex, -aboveDiaphragm(p));
}

double Organs::liver(Vec3 p) const {
  const double leftEdge = p.x - (45 + 0.35 * (p.z + 300)), lowerEdge = -345 + 0.35 * (-p.x - 60) - p.z;
  return std::max(0.9 * leftEdge, 0.9 * lowerEdge);
}

namespace {

/// Discs lie at the ribs' heads, from the neck to the loin.
const std::vector<double>& discLevels() {
  static const std::vector<double> levels = [] {
    std::vector<double> list;
    for (double z = 90; z >= 18; z -= 18) list.push_back(z);
    for (int number = 1; number <= 12; ++number) list.push_back(ribRow(number).z);
    for (double z = -273, height = 28; z > -560; z -= height, height += 1) list.push_back(z);
    return list;
  }();
  return levels;
}

}  // namespace

SpineLevel::SpineLevel(double z) : z_(z), waist_(0), toEndPlate_(1e9), isDisc_(false) {
  const std::vector<double>& levels = discLevels();
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    const double upper = levels[i], lower = levels[i + 1];
    const double half = upper > -200 ? 2.3 : 3.5;
    toEndPlate_ = std::min(toEndPlate_, std::abs(std::abs(z - upper) - half));
    if (std::abs(z - upper) < half) isDisc_ = true;
    const double fromMiddle = (z - (upper + lower) / 2) / ((upper - lower) / 2);
    if (std::abs(fromMiddle) <= 1) waist_ = 1.6 * (1 - fromMiddle * fromMiddle);
    if (upper < z - 40 || upper > z + 45) continue;
    // Of the vertebra below this disc: necks of the ribs, pedicles, transverse and spinous processes.
    const bool isThoracic = upper <= 0 && upper > -250;
    for (double sign : {-1.0, 1.0}) {
      if (isThoracic) processes_.push_back({{sign * 13, 8, upper}, {sign * 18.5, kRibBack - 2, upper - 0.5}, 3.8});
      processes_.push_back({{sign * 10, 9, upper - 8}, {sign * 11, 24, upper - 8}, 3.6});
      processes_.push_back({{sign * 11, 25, upper - 7}, {sign * (isThoracic ? 25 : 30), isThoracic ? 41.0 : 28.0, upper - 6}, 4});
    }
    processes_.push_back({{0, 36, upper - 10}, {0, 54, upper - (isThoracic ? 24 : 14)}, 3.6});
  }
}

double SpineLevel::body(double x, double y) const {
  // An ellipse 32 wide and 28 deep, hollowed behind towards the canal.
  const Vec3 d{x, y, 0};
  const double oval = ellipsoid(d, {16 - waist_ * 0.9, 14 - waist_ * 0.35, 1e6});
  return std::max(oval, 13 - std::hypot(x, y - 25));
}

double SpineLevel::canal(double x, double y) const { return std::hypot(x / 1.1, y - 22.5) - 8.5; }

double SpineLevel::bone(double x, double y) const {
  const double ring = std::abs(std::hypot(x / 1.1, y - 22.5) - 10.7) - 2.2;
  double nearest = std::min(body(x, y), y > 20 ? ring : 1e9);
  for (const Capsule& c : processes_) nearest = std::min(nearest, capsule({x, y, z_}, c.start, c.end, c.radius));
  return std::max(nearest, -canal(x, y));
}

}  // namespace pectora::phantom
