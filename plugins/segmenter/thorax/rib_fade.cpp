#include "plugins/segmenter/thorax/rib_fade.h"

#include <algorithm>

namespace pectora::thorax {
namespace {

constexpr std::size_t kTrendCuts = 12;
constexpr double kStep = 0.83, kFaintest = 0.55, kRise = 0.1;

}  // namespace

RibFade::RibFade(std::vector<double> soFar, double usualHu) : usualHu_(usualHu), faintest_(usualHu) {
  for (double meanHu : soFar) add(meanHu);
}

void RibFade::add(double meanHu) {
  cuts_.push_back(meanHu);
  faintest_ = std::min(faintest_, meanHu);
}

bool RibFade::goesOn(double meanHu) const {
  if (meanHu < kFaintest * usualHu_) return false;
  if (faintest_ < kStep * usualHu_ && meanHu > faintest_ + kRise * usualHu_) return false;
  // The regression line's value at the next cut.
  const std::size_t count = std::min(cuts_.size(), kTrendCuts), first = cuts_.size() - count;
  double expected = usualHu_;
  if (count >= kTrendCuts / 2) {
    double x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t n = 0; n < count; ++n) x += double(n), y += cuts_[first + n], xx += double(n * n), xy += double(n) * cuts_[first + n];
    const double c = double(count), slope = (c * xy - x * y) / (c * xx - x * x);
    expected = std::min(expected, (y + slope * (c * c - x)) / c);
  }
  return meanHu >= kStep * expected;
}

}  // namespace pectora::thorax
