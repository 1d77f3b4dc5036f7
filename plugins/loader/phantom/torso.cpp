#include "torso.h"

#include "smooth.h"

namespace pectora::phantom {
namespace {

/// Points of a superellipse |x/a|^2.4 + |y/b|^2.4 = 1 between `front` and `back` at level z.
void addEllipse(std::vector<PolarSample>& samples, double z, double halfWidth, double front, double back,
                double weight) {
  const double middle = (front + back) / 2, halfDepth = (back - front) / 2;
  for (int i = 0; i <= 24; ++i) {
    const double t = kPi * i / 24, s = std::sin(t), c = std::cos(t);
    const double x = halfWidth * std::pow(s, 2 / 2.4);
    const double y = middle - halfDepth * (c < 0 ? -1 : 1) * std::pow(std::abs(c), 2 / 2.4);
    samples.push_back({{x, y, z}, weight});
  }
}

PolarTable fitWall(const Skeleton& skeleton, double depthScale) {
  std::vector<PolarSample> samples;
  for (const BoneLine& rib : skeleton.ribs)
    if (rib.side == Side::left)
      for (const Vec3& p : rib.line) samples.push_back({p, 1});
  for (const BoneLine& cartilage : skeleton.cartilages)
    if (cartilage.side == Side::left && cartilage.number <= 7)
      for (const Vec3& p : cartilage.line) samples.push_back({p, 0.7});
  const SternumPlan& sternum = skeleton.sternum;
  for (double s = sternum.top(); s <= sternum.bottom(); s += 2)
    for (double x : {0.0, 8.0, 16.0}) samples.push_back({sternum.at(s) + Vec3{x, 0, 0}, 1});
  // Behind, between the two rows of ribs.
  for (double z = -340; z <= 0; z += 5)
    for (double x : {0.0, 10.0}) samples.push_back({{x, kRibBack - 1, z}, 0.5});
  // The neck above and the abdomen below, where there are no ribs.
  const double front = kRibBack - (112 + kRibBack) * depthScale;
  for (double z = 22; z <= PolarTable::kTop; z += 6) addEllipse(samples, z, 52, -44, 38, 0.4);
  for (double z = -350; z >= PolarTable::kBottom; z -= 6) {
    const double waist = step(-330, -400, z), hips = step(-420, -520, z);
    addEllipse(samples, z, 124 - 6 * waist + 12 * hips, front + 14 * waist, kRibBack + 2, 0.3);
  }
  return PolarTable::fit(samples);
}

/// Depth of the inner surface (pleura) behind the wall's mid-surface, mm.
double innerDepth(const SternumPlan& sternum, double x, double angle, double z) {
  const double s = sternum.arcAt(z);
  const double behindRib = kRibThickness / 2 + kPleuraBehindRib;
  const double atSternum = step(sternum.top() - 12, sternum.top(), s) * step(sternum.bottom() + 10, 98, s) *
                           step(30, 18, std::abs(x)) * step(2.0, 1.2, std::abs(angle));
  const double behindSternum = sternum.thickness(s) / 2 + kPleuraBehindRib;
  const double neck = 3 * step(-5, 30, z);
  return behindRib + neck + std::max(0.0, behindSternum - behindRib) * atSternum;
}

/// Outside of the muscles over the wall's mid-surface, mm.
double muscleHeight(double x, double angle, double z) {
  const double front = std::abs(angle), ax = std::abs(x);
  // Pectoralis over ribs 2 to 5, fading towards the sternum and the flank.
  const double pectoralis = 12 * step(6, 34, ax) * step(-205, -160, z) * step(radians(100), radians(65), front);
  // Serratus, latissimus and the abdominal muscles.
  const double flank = 5 * step(radians(40), radians(75), front) + 4 * step(-210, -300, z) * step(10, 40, ax);
  // Back: erector spinae beside the spinous processes, scapular muscles above.
  const double behind = step(radians(115), radians(150), front);
  const double erector = behind * (9 * bell(ax - 30, 30) + 12);
  const double scapular = 8 * step(-200, -120, z) * step(radians(95), radians(130), front) * step(6, 50, ax);
  // Shoulder girdle: the axillary folds rise towards the raised arms, then the body narrows to the neck.
  const double shoulder = step(-170, -40, z) * step(80, 10, z) * step(radians(15), radians(75), front) *
                          step(radians(178), radians(125), front) * 26;
  const double neck = 14 * step(-40, 20, z);
  return 4.8 + std::max(pectoralis, flank) + erector + scapular + shoulder + neck;
}

double fatThickness(double x, double angle, double z, double bmi) {
  const double front = std::abs(angle), ax = std::abs(x);
  const double sternal = 4, nipple = 8, lateral = 10, epigastric = 15, abdominal = 14, dorsal = 8;
  const double anterior = sternal + (nipple - sternal) * step(10, 60, ax);
  const double chest = anterior + (lateral - anterior) * step(radians(60), radians(90), front) +
                       (dorsal - lateral) * step(radians(110), radians(140), front);
  const double belly = epigastric + (abdominal - epigastric) * step(-260, -330, z);
  const double low = belly + (lateral - belly) * step(radians(50), radians(95), front) +
                     (dorsal - lateral) * step(radians(110), radians(140), front);
  const double toLow = step(-195, -255, z);
  return (chest + (low - chest) * toLow) * (bmi / 20) * (bmi / 20);
}

}  // namespace

Torso buildTorso(double depthScale, double bmi) {
  Torso torso;
  torso.skeleton = buildSkeleton(depthScale);
  torso.wall = fitWall(torso.skeleton, depthScale);
  const SternumPlan& sternum = torso.skeleton.sternum;
  // Thicknesses are along the normal, tables along the radius.
  const auto offset = [](const PolarTable& from, auto&& thickness) {
    return PolarTable::of([&](double angle, double z) {
      const Vec3 p = from.at(angle, z);
      return from.radius(angle, z) + thickness(p.x, angle, z) / from.normalFactor(angle, z);
    });
  };
  torso.inner = offset(torso.wall, [&](double x, double a, double z) { return -innerDepth(sternum, x, a, z); });
  // Muscles and fat even out what single ribs do to the wall.
  PolarTable even = torso.wall;
  even.smooth(50);
  even = PolarTable::of([&](double a, double z) { return std::max(even.radius(a, z), torso.wall.radius(a, z)); });
  even.smooth(16);
  torso.muscle = offset(even, [&](double x, double a, double z) { return muscleHeight(x, a, z); });
  torso.skin = offset(even, [&](double x, double a, double z) {
    return muscleHeight(x, a, z) + fatThickness(x, a, z, bmi) + kSkinThickness;
  });
  torso.skin.smooth(24);
  return torso;
}

}  // namespace pectora::phantom
