#include "plugins/common/surface/balanced_order.h"

#include "kernel/physics/workers.h"

#include <algorithm>
#include <array>
#include <span>

namespace pectora {
namespace {

using Items = std::span<TreeItem>;

std::size_t splitAt(std::size_t count, std::size_t run) {
  std::size_t unit = run;
  while (2 * unit < count) unit *= 2;
  return unit;
}

struct Side {
  int axis = 0;
  float low = 0, high = 0;
};

Side longestSide(Items items) {
  std::array<float, 3> low, high;
  std::copy_n(items.front().center, 3, low.begin());
  high = low;
  for (const TreeItem& item : items)
    for (int a = 0; a < 3; ++a) {
      low[a] = item.center[a] < low[a] ? item.center[a] : low[a];
      high[a] = item.center[a] > high[a] ? item.center[a] : high[a];
    }
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
  return {axis, low[axis], high[axis]};
}

void selectNth(Items items, std::size_t middle, int axis) {
  std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(middle), items.end(), [axis](const TreeItem& l, const TreeItem& r) {
    return l.center[axis] != r.center[axis] ? l.center[axis] < r.center[axis] : l.id < r.id;
  });
}

// Brings the `middle` least items along the side to the front, from `items` to `target`: by counting them in bins, which no jump depends
// on, and comparing only within the bin that the middle falls into.
template <std::size_t kBins>
void divide(Items items, Items target, std::size_t middle, Side side) {
  const float scale = float(kBins - 1) / (side.high - side.low);
  const auto binOf = [&](const TreeItem& item) { return std::size_t((item.center[side.axis] - side.low) * scale); };
  std::array<std::uint32_t, kBins> counts{};
  for (const TreeItem& item : items) ++counts[binOf(item)];
  std::size_t bin = 0, below = 0;
  while (below + counts[bin] <= middle) below += counts[bin++];
  std::array<TreeItem*, 3> place{&target[0], &target[0] + below, &target[0] + below + counts[bin]};
  for (const TreeItem& item : items) {
    const std::size_t b = binOf(item);
    *place[(b >= bin) + (b > bin)]++ = item;
  }
  selectNth(target.subspan(below, counts[bin]), middle - below, side.axis);
}

// `items` and `other` take turns.
void sortItems(Items items, Items other, std::size_t run, std::int32_t* ids) {
  if (items.size() <= run) {
    for (std::size_t i = 0; i < items.size(); ++i) ids[i] = items[i].id;
    return;
  }
  const std::size_t middle = splitAt(items.size(), run);
  const Side side = longestSide(items);
  // (A side so short that the scale has no place in a float is no side.)
  if (!(side.high - side.low > 1e-30f)) {
    std::copy(items.begin(), items.end(), other.begin());
    selectNth(other, middle, side.axis);
  } else {
    items.size() > 4096 ? divide<1024>(items, other, middle, side) : divide<32>(items, other, middle, side);
  }
  const auto half = [&](std::size_t h) {
    h == 0 ? sortItems(other.first(middle), items.first(middle), run, ids)
           : sortItems(other.subspan(middle), items.subspan(middle), run, ids + middle);
  };
  constexpr std::size_t kTask = 1 << 14;
  if (items.size() > kTask) parallelFor(2, half);
  else half(0), half(1);
}

}  // namespace

std::vector<std::int32_t> balancedOrder(std::vector<TreeItem> items, std::size_t run) {
  std::vector<TreeItem> other(items.size());
  std::vector<std::int32_t> ids(items.size());
  sortItems(items, other, run, ids.data());
  return ids;
}

}  // namespace pectora
