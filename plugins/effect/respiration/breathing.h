// How ribs, cartilages and sternum move as a patient breathes out.
#pragma once

#include "kernel/value/scene.h"

#include <vector>

namespace pectora {

/// Angles by which ribs turn from full inspiration to the end of a quiet expiration, degrees, from rib 3 to rib 7 (Wilson et al.,
/// J Appl Physiol 1987): as a pump handle about the transverse axis through the rib's head, as a bucket handle about the
/// axis from its head to its costochondral junction. Between the ribs in proportion, beyond them as there.
struct BreathAngles {
  double pumpThird = 11, pumpSeventh = 7;
  double bucketThird = 13, bucketSeventh = 10;
};

/// The chest breathed out by part `exhaled` (1: from full inspiration to the end of a quiet expiration; negative: in).
class Breathing {
 public:
  Breathing(const RibCage& cage, double exhaled, BreathAngles angles = {});
  /// How far a point of a body goes, mm. The sternum goes by the mean way of the second to seventh junction, a cartilage between
  /// its ends like a beam clamped at both.
  Vec3 displacement(const Anchor& anchor) const;
  Vec3 sternum() const { return sternum_; }

 private:
  struct Turn {
    Vec3 head, axis;         // axis of the bucket handle, unit
    double pump = 0, bucket = 0;   // rad
    Vec3 operator()(Vec3 p) const;
  };
  struct Ends {
    Vec3 junction, medial;
  };
  std::vector<Turn> ribs_;
  std::vector<Ends> cartilages_;
  Vec3 sternum_;
};

}  // namespace pectora
