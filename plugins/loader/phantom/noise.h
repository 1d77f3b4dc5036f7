// Random numbers that are the same everywhere, and the noise of a CT.
#pragma once

#include <cstdint>
#include <vector>

namespace pectora::phantom {

/// A well mixed 64-bit number from up to four (SplitMix64's finaliser, Steele 2014).
std::uint64_t hash(std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0, std::uint64_t d = 0);
/// The upper 53 bits as a number in [0, 1).
inline double uniform(std::uint64_t bits) { return double(bits >> 11) * 0x1p-53; }

/// A stream of random numbers; the same for the same seed on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double uniform() { return phantom::uniform(next()); }
  /// Normal with mean 0 and SD 1 (Box-Muller).
  double normal();

 private:
  std::uint64_t next() { return hash(state_++); }
  std::uint64_t state_;
  double spare_ = 0;
  bool hasSpare_ = false;
};

/// Two independent noise slices of `size` x `size` pixels with SD 1: white noise filtered by |f| exp(-(f / fc)^2),
/// the shape of a filtered back-projection's noise. `cutoff` is fc in cycles per pixel.
struct NoisePair {
  std::vector<float> first, second;
};
NoisePair ctNoise(int size, double cutoff, std::uint64_t seed);

/// Smooth field of SD about 1 whose grains are one unit wide, at (x, y, z).
class GrainSlice {
 public:
  /// The grains that a slice at height z cuts, for x and y from 0 to `extent`.
  GrainSlice(double z, int extent, std::uint64_t seed);
  float at(float x, float y) const;

 private:
  int extent_;
  std::vector<float> values_;
};

}  // namespace pectora::phantom
