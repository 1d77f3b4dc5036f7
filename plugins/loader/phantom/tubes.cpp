#include "tubes.h"

#include "noise.h"
#include "smooth.h"

namespace pectora::phantom {

double TubePiece::distanceTo(Vec3 p) const {
  const double length2 = dot(along, along);
  const Vec3 fromStart = p - start;
  const double t = length2 > 0 ? std::clamp(dot(fromStart, along) / length2, 0.0, 1.0) : 0;
  const Vec3 q = fromStart - along * t;
  const double u = dot(q, thin), v = dot(q, high);
  // What is left lies beyond an end: it counts like the thin direction.
  const double w2 = std::max(0.0, dot(q, q) - u * u - v * v);
  const double a2 = halfThin * halfThin, b2 = halfHigh * halfHigh;
  const double k2 = (u * u + w2) / a2 + v * v / b2;
  const double gradient2 = (u * u + w2) / (a2 * a2) + v * v / (b2 * b2);
  if (gradient2 < 1e-9) return -std::min(halfThin, halfHigh);
  // First-order distance to k = 1.
  return (k2 - std::sqrt(k2)) / std::sqrt(gradient2);
}

namespace {

/// Direction out of the wall at a point of the undeformed body.
Vec3 wallNormal(const PolarTable& wall, Vec3 p) {
  const double angle = polarAngle(p.x, p.y, p.z), h = 0.03;
  const Vec3 around = wall.at(angle + h, p.z) - wall.at(angle - h, p.z);
  const Vec3 up = wall.at(angle, p.z + 4) - wall.at(angle, p.z - 4);
  return normalized(cross(around, up));
}

/// Cuts a line of the undeformed body into pieces of the deformed, placed tube.
template <class Size>
void addTube(std::vector<TubePiece>& pieces, const Body& body, const std::vector<Vec3>& line, std::uint8_t label,
             Size&& halves) {
  std::vector<Vec3> placed;
  for (const Vec3& p : line) placed.push_back(body.place(p));
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    TubePiece piece;
    piece.start = placed[i];
    piece.along = placed[i + 1] - placed[i];
    const Vec3 normal = wallNormal(body.torso->wall, line[i]);
    const Vec3 out = body.pose.toCt(line[i] + normal) - body.pose.toCt(line[i]);
    const Vec3 tangent = normalized(piece.along);
    piece.thin = normalized(out - tangent * dot(out, tangent));
    piece.high = cross(tangent, piece.thin);
    const auto [thin, high] = halves(i, double(i) / double(line.size() - 1));
    piece.halfThin = thin * body.pose.scale;
    piece.halfHigh = high * body.pose.scale;
    piece.label = label;
    pieces.push_back(piece);
  }
}

}  // namespace

std::vector<TubePiece> ribTubes(const Body& body) {
  std::vector<TubePiece> pieces;
  for (const BoneLine& rib : body.torso->skeleton.ribs)
    addTube(pieces, body, rib.line, ribLabel(rib.side, rib.number), [&](std::size_t, double t) {
      // The neck and a floating rib's tip are more slender.
      const double slender = (0.8 + 0.2 * step(0, 0.08, t)) * (rib.number > 10 ? 1 - 0.5 * step(0.6, 1, t) : 1);
      return std::pair(kRibThickness / 2 * slender, kRibHeight / 2 * slender);
    });
  return pieces;
}

std::vector<TubePiece> cartilageTubes(const Body& body, double calcifiedShare, std::uint64_t seed) {
  std::vector<TubePiece> pieces;
  for (const BoneLine& cartilage : body.torso->skeleton.cartilages) {
    const std::size_t first = pieces.size();
    const std::uint8_t label = cartilageLabel(cartilage.side, cartilage.number);
    addTube(pieces, body, cartilage.line, label, [&](std::size_t, double t) {
      // Starts with the rib's section and widens medially.
      const double widened = step(0, 0.35, t);
      return std::pair((kRibThickness + (kCartilageThickness - kRibThickness) * widened) / 2,
                       (kRibHeight + (kCartilageHeight - kRibHeight) * widened) / 2);
    });
    for (std::size_t i = first; i < pieces.size(); ++i)
      pieces[i].isCalcified = uniform(hash(seed, label, (i - first) / 2)) < calcifiedShare;
  }
  return pieces;
}

std::vector<TubePiece> lungVessels(const Body& body, std::uint64_t seed) {
  std::vector<TubePiece> pieces;
  Random random(hash(seed, 77));
  for (double sign : {-1.0, 1.0})
    for (int vessel = 0; vessel < 90; ++vessel) {
      // Each starts at the hilum (or on a vessel's way) and wanders outwards, growing thinner.
      Vec3 p{sign * (24 + 10 * random.uniform()), -22 - 16 * random.uniform(), -105 - 40 * random.uniform()};
      Vec3 direction = normalized({sign * (0.25 + random.uniform()), random.uniform() * 2 - 1, random.uniform() * 2.4 - 1.4});
      double radius = 1.2 + 2.2 * random.uniform() * random.uniform();
      std::vector<Vec3> line{p};
      std::vector<double> radii{radius};
      for (int i = 0; i < 16; ++i) {
        direction = normalized(direction + Vec3{random.normal(), random.normal(), random.normal()} * 0.16);
        p += direction * 6;
        radius *= 0.92;
        line.push_back(p);
        radii.push_back(radius);
      }
      addTube(pieces, body, line, kVessel, [&](std::size_t i, double) { return std::pair(radii[i], radii[i]); });
    }
  return pieces;
}

}  // namespace pectora::phantom
