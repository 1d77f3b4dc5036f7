#include "plugins/segmenter/thorax/doubts.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <cmath>

namespace pectora::thorax {
namespace {

constexpr int kMetalHu = 2500;         // above the densest bone; a CT of 12 bits ends at 3071
constexpr int kLeastMetalVoxels = 8;
constexpr double kNextToNothing = 0.1; // of the body's usual area
constexpr int kBridged = 2;            // slices between two runs

/// The runs of marked slices.
void addRuns(std::vector<SliceRange>& ranges, const std::vector<char>& isMarked, int first, const std::function<double(int)>& heightOf,
             const char* what, const char* meaning) {
  const int count = int(isMarked.size());
  for (int s = 0; s < count; ++s) {
    if (!isMarked[s]) continue;
    int last = s;
    for (int t = s + 1; t < count && t <= last + 1 + kBridged; ++t)
      if (isMarked[t]) last = t;
    ranges.push_back({what, heightOf(first + s), heightOf(first + last), meaning});
    s = last;
  }
}

}  // namespace

std::vector<SliceRange> findDoubts(const Volume& ct, const Body& body, const std::vector<char>& isClipped,
                                   const std::function<double(int)>& heightOf) {
  const int first = body.firstSlice, count = body.lastSlice - first + 1;
  std::vector<char> hasMetal(count, 0), isMissing(count, 0);
  std::vector<double> areas(count, 0);
  parallelFor(count, [&](std::size_t s) {
    const int k = first + int(s);
    int metal = 0;
    for (int j = body.box.low[1]; j < body.box.high[1]; ++j) {
      const std::int16_t* row = &ct.hu[ct.grid.index(0, j, k)];
      for (int i = body.box.low[0]; i < body.box.high[0]; ++i)
        if (row[i] > kMetalHu && body.isTorso(std::min(i / body.factor, body.size[0] - 1), std::min(j / body.factor, body.size[1] - 1), k)) ++metal;
    }
    hasMetal[s] = metal >= kLeastMetalVoxels;
    for (int j = 0; j < body.size[1]; ++j)
      for (int i = 0; i < body.size[0]; ++i) areas[s] += body.isTorso(i, j, k);
  });
  std::vector<double> sorted = areas;
  std::nth_element(sorted.begin(), sorted.begin() + count / 2, sorted.end());
  for (int s = 0; s < count; ++s) isMissing[s] = areas[s] < kNextToNothing * sorted[count / 2];

  std::vector<SliceRange> ranges;
  addRuns(ranges, isClipped, first, heightOf, "clipped skin", "the skin leaves the field of view and is not to be trusted there");
  addRuns(ranges, hasMetal, first, heightOf, "metal", "streaks may have moved what was found near to it");
  addRuns(ranges, isMissing, first, heightOf, "missing slices", "nothing can be seen there; what was found is drawn on from above and below");
  if (ct.grid.spacing.z > kThickMm)
    ranges.push_back({"thick slices", heightOf(first), heightOf(body.lastSlice), "ribs and cartilages are a few millimetres less sure than in slices of up to 3 mm"});
  return ranges;
}

std::string sentence(const SliceRange& range) {
  const auto whole = [](double z) { return std::to_string(std::lround(z)); };
  return range.what + " at z " + whole(range.low) + " to " + whole(range.high) + " mm: " + range.meaning;
}

}  // namespace pectora::thorax
