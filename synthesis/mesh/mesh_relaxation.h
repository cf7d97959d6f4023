// Moves the vertices of a mesh along its surface, so that its triangles become more even. Triangles keep
// their vertices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh_sink.h"

namespace astrolith {

// The neighbours of each vertex of a manifold mesh, whose indices must be in range.
class MeshRelaxation {
 public:
  MeshRelaxation(std::size_t num_vertices, std::span<const Triangle> triangles);

  // Places of all vertices after some sweeps. A sweep moves each vertex to the mean of its neighbours, within
  // the plane through the vertex that its normal is perpendicular to. All vertices of a sweep move at once,
  // so that the result depends on the mesh alone. Vertices at open edges stay where they are.
  std::vector<Vec3f> places_after(std::span<const MeshVertex> vertices, int sweeps) const;

  // Places after half a sweep, in which only the corners of triangles below this quality move.
  std::vector<Vec3f> places_for_poor(std::span<const MeshVertex> vertices,
                                     std::span<const Triangle> triangles, float quality) const;

 private:
  bool is_inner(std::size_t v) const;
  std::span<const std::uint32_t> neighbours_of(std::size_t v) const;
  Vec3f move_of(std::span<const Vec3f> places, std::size_t v, const Vec3f& normal) const;

  std::vector<std::uint32_t> first_, neighbours_;  // the neighbours of one vertex after those of another
  std::vector<std::uint32_t> balance_;  // numbers of neighbours that follow less those that precede, mod 2^32
};

// Whether a triangle faces into the body, as the normals of its corners say.
bool is_turned_over(const MeshVertex& a, const MeshVertex& b, const MeshVertex& c);

// Puts vertices of `moved` back as they are in `plain`, until each triangle that is turned over has all its
// corners there. Such a triangle is turned over in the plain mesh already.
void put_back_turned(std::span<const MeshVertex> plain, std::span<const Triangle> triangles,
                     std::span<MeshVertex> moved);

}  // namespace astrolith
