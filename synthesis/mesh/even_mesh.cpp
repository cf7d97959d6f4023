#include "synthesis/mesh/even_mesh.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "geometry/mesh_measure.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// The number of a block along an axis.
std::size_t block_index(float coordinate, double low, double side) {
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

constexpr std::int64_t kRelaxationGrain = 2048;

std::vector<Vec3f> vertex_positions(std::span<const MeshVertex> vertices) {
  std::vector<Vec3f> places(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) places[v] = vertices[v].position;
  return places;
}

// Marks the corners of the triangles below this quality.
std::vector<char> mark_poor_corners(std::span<const MeshVertex> vertices, std::span<const Triangle> triangles,
                                    float quality) {
  std::vector<char> marked(vertices.size());
  for (const Triangle& t : triangles) {
    if (triangle_quality(vertices[t[0]].position, vertices[t[1]].position, vertices[t[2]].position) < quality)
      for (const std::uint32_t v : t) marked[v] = 1;
  }
  return marked;
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
                             [&](std::uint32_t v) { return block_index(places[v].z, box.min.z, side); });
  const std::size_t num_slabs = sorted.slabs.size() - 1;
  std::vector<std::vector<VertexBlock>> slab_blocks(num_slabs);
  parallel_for(0, static_cast<std::int64_t>(num_slabs), [&](std::int64_t i) {
    const auto s = static_cast<std::size_t>(i);
    const std::size_t begin = sorted.slabs[s];
    const std::vector<std::size_t> first =
        sort_by_key(std::span(sorted.numbers).subspan(begin, sorted.slabs[s + 1] - begin), along_x * along_y,
                    [&](std::uint32_t v) {
                      return block_index(places[v].y, box.min.y, side) * along_x +
                             block_index(places[v].x, box.min.x, side);
                    });
    for (std::size_t b = 0; b + 1 < first.size(); ++b) {
      if (first[b] < first[b + 1]) slab_blocks[s].push_back({s, begin + first[b], begin + first[b + 1]});
    }
  });
  for (const std::vector<VertexBlock>& blocks : slab_blocks)
    sorted.blocks.insert(sorted.blocks.end(), blocks.begin(), blocks.end());
  return sorted;
}

MeshRelaxation::MeshRelaxation(std::size_t num_vertices, std::span<const Triangle> triangles)
    : first_(num_vertices + 1), neighbours_(3 * triangles.size()), balance_(num_vertices) {
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) ++first_[v + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = t[k], after = t[(k + 1) % 3], before = t[(k + 2) % 3];
      neighbours_[next[v]++] = after;
      balance_[v] += after - before;
    }
  }
}

// Around a vertex inside the surface each neighbour follows the vertex in one triangle and precedes it in
// another. The numbers of the neighbours then cancel.
bool MeshRelaxation::is_inner(std::size_t v) const { return balance_[v] == 0 && first_[v] < first_[v + 1]; }

// The neighbours of a vertex inside the surface, each once. Around a vertex at an open edge one is missing.
std::span<const std::uint32_t> MeshRelaxation::neighbours(std::size_t v) const {
  return std::span(neighbours_).subspan(first_[v], first_[v + 1] - first_[v]);
}

// The way to the mean of the neighbours, without its part along the normal.
Vec3f MeshRelaxation::vertex_move(std::span<const Vec3f> places, std::size_t v, const Vec3f& normal) const {
  Vec3f sum;
  for (const std::uint32_t n : neighbours(v)) sum += places[n] - places[v];
  const Vec3f move = sum * (1.0f / static_cast<float>(neighbours(v).size()));
  return move - normal * dot(move, normal);
}

std::vector<Vec3f> MeshRelaxation::places_after(std::span<const MeshVertex> vertices, int sweeps) const {
  std::vector<Vec3f> places = vertex_positions(vertices), next = places;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    parallel_for(
        0, static_cast<std::int64_t>(vertices.size()),
        [&](std::int64_t i) {
          const auto v = static_cast<std::size_t>(i);
          if (is_inner(v)) next[v] = places[v] + vertex_move(places, v, vertices[v].normal);
        },
        kRelaxationGrain);
    places.swap(next);
  }
  return places;
}

std::vector<Vec3f> MeshRelaxation::places_for_poor(std::span<const MeshVertex> vertices,
                                                   std::span<const Triangle> triangles, float quality) const {
  const std::vector<char> marked = mark_poor_corners(vertices, triangles, quality);
  const std::vector<Vec3f> places = vertex_positions(vertices);
  std::vector<Vec3f> next = places;
  for (std::size_t v = 0; v < places.size(); ++v) {
    if (marked[v] != 0 && is_inner(v)) next[v] += vertex_move(places, v, vertices[v].normal) * 0.5f;
  }
  return next;
}

bool is_turned_over(const MeshVertex& a, const MeshVertex& b, const MeshVertex& c) {
  const Vec3f across = cross(b.position - a.position, c.position - a.position);
  return !(dot(across, a.normal + b.normal + c.normal) > 0.0f);
}

void put_back_turned(std::span<const MeshVertex> plain, std::span<const Triangle> triangles,
                     std::span<MeshVertex> moved) {
  const auto stays = [&](std::uint32_t v) { return moved[v].position == plain[v].position; };
  std::vector<char> turned(triangles.size());
  for (bool any = true; any;) {
    parallel_for(
        0, static_cast<std::int64_t>(triangles.size()),
        [&](std::int64_t i) {
          const Triangle& t = triangles[static_cast<std::size_t>(i)];
          turned[static_cast<std::size_t>(i)] = is_turned_over(moved[t[0]], moved[t[1]], moved[t[2]]) &&
                                                !(stays(t[0]) && stays(t[1]) && stays(t[2]));
        },
        kRelaxationGrain);
    any = false;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (turned[i] == 0) continue;
      any = true;
      for (const std::uint32_t v : triangles[i]) moved[v] = plain[v];
    }
  }
}

}  // namespace astrolith
