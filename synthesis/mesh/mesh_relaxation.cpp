#include "synthesis/mesh/mesh_relaxation.h"

#include <numeric>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::int64_t kGrain = 2048;

// The neighbours of each vertex, one vertex after the other.
class VertexNeighbours {
 public:
  VertexNeighbours(std::size_t num_vertices, std::span<const Triangle> triangles)
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

  // The neighbours of a vertex inside the surface, each once. Around a vertex at an open edge one is missing.
  std::span<const std::uint32_t> of(std::size_t v) const {
    return std::span(neighbours_).subspan(first_[v], first_[v + 1] - first_[v]);
  }
  // Around a vertex inside the surface each neighbour follows the vertex in one triangle and precedes it in
  // another. The numbers of the neighbours then cancel.
  bool is_inner(std::size_t v) const { return balance_[v] == 0 && first_[v] < first_[v + 1]; }

 private:
  std::vector<std::uint32_t> first_, neighbours_;
  std::vector<std::uint32_t> balance_;  // numbers of neighbours that follow less those that precede, mod 2^32
};

// The mean of the neighbours' places, projected along the normal onto the plane through the vertex.
Vec3f relaxed_place(std::span<const Vec3f> places, std::span<const std::uint32_t> neighbours,
                    const Vec3f& place, const Vec3f& normal) {
  Vec3f sum;
  for (const std::uint32_t n : neighbours) sum += places[n] - place;
  const Vec3f move = sum * (1.0f / static_cast<float>(neighbours.size()));
  return place + (move - normal * dot(move, normal));
}

}  // namespace

std::vector<Vec3f> relaxed_places(std::span<const MeshVertex> vertices, std::span<const Triangle> triangles,
                                  int sweeps) {
  const VertexNeighbours neighbours(vertices.size(), triangles);
  std::vector<Vec3f> places(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) places[v] = vertices[v].position;
  std::vector<Vec3f> next = places;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    parallel_for(
        0, static_cast<std::int64_t>(vertices.size()),
        [&](std::int64_t i) {
          const auto v = static_cast<std::size_t>(i);
          if (neighbours.is_inner(v))
            next[v] = relaxed_place(places, neighbours.of(v), places[v], vertices[v].normal);
        },
        kGrain);
    places.swap(next);
  }
  return places;
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
        kGrain);
    any = false;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (turned[i] == 0) continue;
      any = true;
      for (const std::uint32_t v : triangles[i]) moved[v] = plain[v];
    }
  }
}

}  // namespace astrolith
