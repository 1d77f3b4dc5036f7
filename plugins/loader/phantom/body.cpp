#include "body.h"

#include "smooth.h"

namespace pectora::phantom {

Vec3 Pose::toCt(Vec3 body) const {
  const Vec3 d = body - kTurnCenter;
  const double c = std::cos(radians(turnDeg)), s = std::sin(radians(turnDeg));
  return (kTurnCenter + Vec3{c * d.x - s * d.y, s * d.x + c * d.y, d.z}) * scale + shift;
}

Vec3 Pose::toBody(Vec3 ct) const {
  const Vec3 d = (ct - shift) / scale - kTurnCenter;
  const double c = std::cos(radians(turnDeg)), s = std::sin(radians(turnDeg));
  return kTurnCenter + Vec3{c * d.x + s * d.y, -s * d.x + c * d.y, d.z};
}

namespace {

/// y of a surface's front in each column: walks from straight ahead to the side as long as x grows.
std::vector<float> frontLine(const PolarTable& surface, double z, int half) {
  std::vector<float> line(2 * half + 1);
  Vec3 inside = surface.at(0, z);
  line[half] = float(inside.y);
  int column = 1;
  for (int degree = 1; degree <= 110 && column <= half; ++degree) {
    const Vec3 next = surface.at(radians(degree), z);
    if (next.x <= inside.x) break;
    for (; column <= half && column <= next.x; ++column) {
      const double t = (column - inside.x) / (next.x - inside.x);
      line[half + column] = line[half - column] = float(inside.y + t * (next.y - inside.y));
    }
    inside = next;
  }
  for (; column <= half; ++column) line[half + column] = line[half - column] = float(inside.y);
  return line;
}

}  // namespace

Level::Level(const Torso& torso, const Deformity& deformity, double z)
    : z_(z), inner_(frontLine(torso.inner, z, kHalf)), outer_(frontLine(torso.muscle, z, kHalf)),
      skin_(frontLine(torso.skin, z, kHalf)) {
  for (int x = -kHalf; x <= kHalf; ++x) {
    bone_.push_back(float(deformity.bone(x, z)));
    skinMove_.push_back(float(deformity.skin(x, z)));
  }
}

double Level::lookup(const std::vector<float>& table, double x) const {
  const double u = std::clamp(x + kHalf, 0.0, 2.0 * kHalf);
  const int i = std::min(int(u), 2 * kHalf - 1);
  return table[i] + (table[i + 1] - table[i]) * (u - i);
}

// In a column the displacement is 0 behind the vertebral front, grows linearly to the pleura, is that of the bone up
// to the outside of the bone, and goes linearly over to that of the skin in the fat.
double Level::displacement(double x, double y) const {
  const double bone = lookup(bone_, x), skinMove = lookup(skinMove_, x);
  if ((bone == 0 && skinMove == 0) || y >= kVertebralFront) return 0;
  const double inner = lookup(inner_, x);
  if (y > inner) return bone * (kVertebralFront - y) / (kVertebralFront - inner);
  const double outer = lookup(outer_, x), skin = lookup(skin_, x);
  return bone + (skinMove - bone) * std::clamp((outer - y) / (outer - skin), 0.0, 1.0);
}

double Level::undeformedY(double x, double y) const {
  const double bone = lookup(bone_, x), skinMove = lookup(skinMove_, x);
  if ((bone == 0 && skinMove == 0) || y >= kVertebralFront) return y;
  const double inner = lookup(inner_, x);
  if (y > inner + bone) {
    // y = Y + bone (v - Y) / (v - inner), solved for Y.
    const double ratio = bone / (kVertebralFront - inner);
    return (y - ratio * kVertebralFront) / (1 - ratio);
  }
  const double outer = lookup(outer_, x), skin = lookup(skin_, x);
  if (y >= outer + bone) return y - bone;
  const double skinNow = skin + skinMove;
  if (y <= skinNow) return y - skinMove;
  return skin + (outer - skin) * (y - skinNow) / (outer + bone - skinNow);
}

Vec3 Body::place(Vec3 p) const {
  p.y += level(p.z).displacement(p.x, p.y);
  return pose.toCt(p);
}

Vec3 Body::surfacePoint(const PolarTable& surface, const Level& at, double angle) const {
  Vec3 p = surface.at(angle, at.z());
  p.y += at.displacement(p.x, p.y);
  return pose.toCt(p);
}

std::shared_ptr<const Mesh> Body::tube(const PolarTable& surface, double bottom, double top, double spacing) const {
  auto mesh = std::make_shared<Mesh>();
  const int around = 240, rows = int((top - bottom) / spacing) + 1;
  for (int row = 0; row < rows; ++row) {
    const Level at = level(bottom + row * spacing);
    for (int i = 0; i < around; ++i) mesh->points.push_back(surfacePoint(surface, at, 2 * kPi * i / around - kPi));
  }
  // Angle grows towards the patient's left over the front: with z upwards this order points outwards.
  for (int row = 0; row + 1 < rows; ++row)
    for (int i = 0; i < around; ++i) {
      const int a = row * around + i, b = row * around + (i + 1) % around, c = a + around, d = b + around;
      mesh->triangles.push_back({a, b, d});
      mesh->triangles.push_back({a, d, c});
    }
  return mesh;
}

double Body::sternalBodyBottom() const {
  const SternumPlan& sternum = torso->skeleton.sternum;
  return sternum.at(sternum.bodyLength - 2).z;
}
double Body::sternalBodyTop() const { return torso->skeleton.sternum.at(8).z; }

LevelMetrics Body::measure(double z) const {
  LevelMetrics metrics;
  metrics.z = pose.levelToCt(z);
  const Level at = level(z);
  // T: the widest place of the inner wall. C: its most anterior one.
  double halfWidth = 0, front = kVertebralFront;
  for (int degree = -110; degree <= 110; ++degree) {
    const Vec3 p = torso->inner.at(radians(degree), z);
    halfWidth = std::max(halfWidth, std::abs(p.x));
    front = std::min(front, p.y + at.displacement(p.x, p.y));
  }
  metrics.transverse = 2 * halfWidth * pose.scale;
  const SternumPlan& sternum = torso->skeleton.sternum;
  const double s = sternum.arcAt(z);
  if (s < sternum.top() || s > sternum.bodyLength) return metrics;
  // B: the most posterior point of the sternum's back.
  const double half = sternum.halfWidth(s) - 3, middle = sternum.at(s).y;
  const double back = sternum.thickness(s) / 2 / std::cos(sternum.tiltAt(s));
  double deepest = -1e9;
  for (double x = -half; x <= half + 1e-9; x += half / 32) deepest = std::max(deepest, middle + back + at.bone(x));
  metrics.sternumToVertebra = (kVertebralFront - deepest) * pose.scale;
  metrics.deepestInnerWall = (kVertebralFront - front) * pose.scale;
  return metrics;
}

}  // namespace pectora::phantom
