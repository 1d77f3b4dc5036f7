#include "kernel/physics/stencil_row.h"

#include "kernel/value/vec3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace pectora;
using namespace pectora::lattice;

namespace {

constexpr std::size_t kColumns = 37, kStride = 64;   // two whole chunks and a part; 11 columns beyond on the right, 16 on the left
constexpr std::size_t kRows = 3, kNumbers = (kRows + 1) * kStride;   // of one axis, with room beyond the last row

// Three crooked rows, of which the springs start in the first.
struct Room {
  std::vector<float> numbers = std::vector<float>(9 * kNumbers + 2 * kStride);
  Row<float> rowsOf(int vectors) {
    float* first = &numbers[std::size_t(3 * vectors) * kNumbers];
    return {first, first + kNumbers, first + 2 * kNumbers};
  }
  std::size_t place(std::size_t row, std::size_t column) const { return row * kStride + kChunk + column; }
  Vec3 at(int vectors, std::size_t row, std::size_t column) {
    const Row<float> v = rowsOf(vectors);
    const std::size_t i = place(row, column);
    return {double(v.x[i]), double(v.y[i]), double(v.z[i])};
  }

  Room() {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> jitter(-1, 1);
    const Row<float> moved = rowsOf(0), rest = rowsOf(1);
    for (std::size_t i = 0; i < kNumbers; ++i) rest.x[i] = rest.y[i] = rest.z[i] = kBeyond;
    for (std::size_t r = 0; r < kRows; ++r)
      for (std::size_t c = 0; c < kColumns; ++c) {
        const std::size_t i = place(r, c);
        rest.x[i] = 8 * float(c) + jitter(random), rest.y[i] = 8 * float(r) + jitter(random), rest.z[i] = jitter(random);
        moved.x[i] = jitter(random), moved.y[i] = jitter(random), moved.z[i] = jitter(random);
      }
  }
  StencilRow row(const std::vector<RowEntry>& entries) {
    const std::size_t start = place(0, 0);
    float* sums = &numbers[9 * kNumbers];
    return {kColumns, entries.data(), entries.data() + entries.size(), constant(pectora::at(rowsOf(0), start)), constant(pectora::at(rowsOf(1), start)),
            pectora::at(rowsOf(2), start), sums, sums + kStride};
  }
};

// In the same row, and obliquely to both others.
std::vector<RowEntry> entries() {
  std::vector<RowEntry> all;
  for (const int columns : {-2, -1, 0, 1, 2})
    for (const int rows : {0, 1, 2})
      if (rows > 0 || columns > 0)
        all.push_back({rows * std::ptrdiff_t(kStride) + columns, std::max(0, -columns), std::ptrdiff_t(kColumns) - std::max(0, columns), 0.3f, 0.1f});
  return all;
}

TEST(StencilRow, ForcesAndEnergiesAreThoseOfSpringsTakenOneByOne) {
  Room room;
  const std::vector<RowEntry> springs = entries();
  const StencilRow row = room.row(springs);
  ASSERT_FALSE(addRowForces(row));
  std::vector<Vec3> expected(kStride * kRows);
  std::vector<double> twice(kColumns), largest(kColumns);
  for (const RowEntry& s : springs)
    for (std::size_t c = std::size_t(s.first); c < std::size_t(s.end); ++c) {
      const std::size_t far = room.place(0, c) + std::size_t(s.far), r = far / kStride, fc = far % kStride - kChunk;
      const Vec3 rest = room.at(1, r, fc) - room.at(1, 0, c), now = rest + room.at(0, r, fc) - room.at(0, 0, c);
      const double longer = norm(now) - norm(rest), tension = double(longer < 0 ? s.compressed : s.stretched) * longer;
      expected[room.place(0, c)] += normalized(now) * -tension;
      expected[far] += normalized(now) * tension;
      twice[c] += tension * longer;
      largest[c] = std::max(largest[c], tension * tension);
    }
  for (std::size_t r = 0; r < kRows; ++r)
    for (std::size_t c = 0; c < kColumns; ++c) EXPECT_LT(distance(room.at(2, r, c), expected[room.place(r, c)]), 1e-6 * 15 * 0.3) << r << " " << c;   // digits of 15 springs
  for (std::size_t c = 0; c < kColumns; ++c) {
    EXPECT_NEAR(row.twiceEnergy[c], twice[c], 1e-5 * twice[c]);
    EXPECT_NEAR(row.largestSquared[c], largest[c], 1e-5 * largest[c]);
  }
}

TEST(StencilRow, GivesTheSameBitsForEveryWidthOfRegisters) {
  const std::vector<RowEntry> springs = entries();
  std::vector<float> first;
  for (const auto add : rowForcesByWidth()) {
    Room room;
    EXPECT_FALSE(add(room.row(springs)));
    // What lies beyond the columns may hold anything.
    std::vector<float> found;
    for (std::size_t r = 0; r < kRows; ++r)
      for (std::size_t c = 0; c < kColumns; ++c)
        for (const float* v : {room.rowsOf(2).x, room.rowsOf(2).y, room.rowsOf(2).z}) found.push_back(v[room.place(r, c)]);
    const StencilRow row = room.row(springs);
    found.insert(found.end(), row.twiceEnergy, row.twiceEnergy + kColumns);
    found.insert(found.end(), row.largestSquared, row.largestSquared + kColumns);
    if (first.empty()) first = found;
    EXPECT_EQ(found, first);
  }
}

TEST(StencilRow, TellsOfASpringWithoutLengthInAnyColumnAndOfNoneBeyondTheEdge) {
  const std::vector<RowEntry> springs = entries();
  for (const auto add : rowForcesByWidth())
    for (const std::size_t c : {0, 15, 16, 36}) {
      Room room;
      // The far end of the spring straight to the next row comes to lie on the near one.
      const std::size_t near = room.place(0, c), far = room.place(1, c);
      const Row<float> moved = room.rowsOf(0), rest = room.rowsOf(1);
      for (auto axis : {&Row<float>::x, &Row<float>::y, &Row<float>::z}) (moved.*axis)[far] = (rest.*axis)[near] + (moved.*axis)[near] - (rest.*axis)[far];
      EXPECT_TRUE(add(room.row(springs))) << c;
    }
}

}  // namespace
