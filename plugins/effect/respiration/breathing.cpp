#include "plugins/effect/respiration/breathing.h"

#include "kernel/value/plan.h"

#include <algorithm>
#include <numbers>

namespace pectora {
namespace {

double beam(double s) { return s * s * (3 - 2 * s); }

Vec3 turned(Vec3 p, Vec3 about, Vec3 axis, double angle) {
  RigidMotion turn;
  turn.pivot = about;
  turn.axis = axis;
  turn.angle = angle;
  return turn(p);
}

}  // namespace

// Breathing out, the front goes down and back and the side goes down.
Vec3 Breathing::Turn::operator()(Vec3 p) const { return turned(turned(p, head, axis, bucket), head, {1, 0, 0}, pump) - p; }

Breathing::Breathing(const RibCage& cage, double exhaled, BreathAngles angles) {
  const double degree = std::numbers::pi / 180;
  Vec3 sum;
  int counted = 0;
  for (const RibCurve& rib : cage.ribs) {
    Turn turn;
    turn.head = rib.curve.at(0);
    const Vec3 junction = rib.curve.at(1);
    turn.axis = normalized(junction - turn.head);
    // A rib without a number turns like one in the middle.
    const double s = rib.number > 0 ? std::clamp((rib.number - 3) / 4.0, 0.0, 1.0) : 0.5;
    turn.pump = exhaled * degree * (angles.pumpThird + s * (angles.pumpSeventh - angles.pumpThird));
    turn.bucket = (rib.side == Side::left ? -1 : 1) * exhaled * degree * (angles.bucketThird + s * (angles.bucketSeventh - angles.bucketThird));
    ribs_.push_back(turn);
    if (rib.number < 2 || rib.number > 7) continue;
    sum += turn(junction);
    ++counted;
  }
  // Forwards, backwards, up and down: the two sides hold it in the middle.
  if (counted > 0) sternum_ = {0, sum.y / counted, sum.z / counted};

  for (const Cartilage& cartilage : cage.cartilages) {
    Ends ends;
    for (std::size_t i = 0; i < cage.ribs.size(); ++i)
      if (cage.ribs[i].side == cartilage.side && cage.ribs[i].number == cartilage.rib) ends.junction = ribs_[i](cartilage.curve.at(0));
    ends.medial = sternum_;
    for (std::size_t j = 0; j < cartilages_.size(); ++j)
      if (cartilage.joins > 0 && cage.cartilages[j].side == cartilage.side && cage.cartilages[j].rib == cartilage.joins)
        ends.medial = lerp(cartilages_[j].junction, cartilages_[j].medial, beam(cartilage.joinsAt));
    cartilages_.push_back(ends);
  }
}

Vec3 Breathing::displacement(const Anchor& anchor) const {
  switch (anchor.body) {
    case BodyKind::rib: return ribs_[anchor.index](anchor.rest);
    case BodyKind::cartilage: return lerp(cartilages_[anchor.index].junction, cartilages_[anchor.index].medial, beam(anchor.u));
    case BodyKind::sternum: return sternum_;
    case BodyKind::still: break;
  }
  return {};
}

}  // namespace pectora
