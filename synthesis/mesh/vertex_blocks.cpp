#include "synthesis/mesh/vertex_blocks.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// The number of a block along an axis.
std::size_t block_of(float coordinate, double low, double side) {
  return static_cast<std::size_t>(std::max((double{coordinate} - low) / side, 0.0));
}

// Sorts numbers by key(number), which lies below num_keys, in their order. Returns where each key begins, and
// the end.
template <typename Key>
std::vector<std::size_t> sort_by_key(std::span<std::uint32_t> numbers, std::size_t num_keys, const Key& key) {
  std::vector<std::size_t> first(num_keys + 1);
  for (const std::uint32_t number : numbers) ++first[key(number) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  const std::vector<std::uint32_t> unsorted(numbers.begin(), numbers.end());
  for (const std::uint32_t number : unsorted) numbers[next[key(number)]++] = number;
  return first;
}

}  // namespace

Box box_around(std::span<const Vec3f> places, std::span<const std::uint32_t> numbers) {
  Box box;
  for (const std::uint32_t v : numbers)
    box.extend({double{places[v].x}, double{places[v].y}, double{places[v].z}});
  return box;
}

VertexBlocks sort_into_blocks(std::span<const Vec3f> places, std::vector<std::uint32_t> numbers,
                              double side) {
  VertexBlocks sorted;
  if (numbers.empty()) return sorted;
  sorted.numbers = std::move(numbers);
  const Box box = box_around(places, sorted.numbers);
  const auto blocks_along = [&](double extent) { return static_cast<std::size_t>(extent / side) + 1; };
  const std::size_t along_x = blocks_along(box.extent().x), along_y = blocks_along(box.extent().y);
  sorted.slabs = sort_by_key(sorted.numbers, blocks_along(box.extent().z),
                             [&](std::uint32_t v) { return block_of(places[v].z, box.min.z, side); });
  const std::size_t num_slabs = sorted.slabs.size() - 1;
  std::vector<std::vector<VertexBlock>> of_slab(num_slabs);
  parallel_for(0, static_cast<std::int64_t>(num_slabs), [&](std::int64_t i) {
    const auto s = static_cast<std::size_t>(i);
    const std::size_t begin = sorted.slabs[s];
    const std::vector<std::size_t> first = sort_by_key(
        std::span(sorted.numbers).subspan(begin, sorted.slabs[s + 1] - begin), along_x * along_y,
        [&](std::uint32_t v) {
          return block_of(places[v].y, box.min.y, side) * along_x + block_of(places[v].x, box.min.x, side);
        });
    for (std::size_t b = 0; b + 1 < first.size(); ++b) {
      if (first[b] < first[b + 1]) of_slab[s].push_back({s, begin + first[b], begin + first[b + 1]});
    }
  });
  for (const std::vector<VertexBlock>& blocks : of_slab)
    sorted.blocks.insert(sorted.blocks.end(), blocks.begin(), blocks.end());
  return sorted;
}

}  // namespace astrolith
