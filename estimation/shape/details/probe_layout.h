// The places at which the details fit measures a surface. The first are the vertices of a mesh of the base,
// about as fine as the target's mesh, which move to the surface. The second are lines of three places on this
// mesh with several lags, for the roughness. Heights between vertices are interpolated linearly, as on the
// target's triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "estimation/shape/details/roughness.h"
#include "estimation/shape/details/surface_probe.h"
#include "estimation/shape/target/target_body.h"

namespace astrolith {

// A place on a triangle of the base's mesh.
struct MeshPlace {
  std::uint32_t triangle = 0;
  std::array<double, 3> weights{};  // barycentric

  // Interpolates a value that every vertex has linearly over the triangle.
  template <typename T>
  T interpolate(const std::vector<Triangle>& triangles, const std::vector<T>& of_vertices) const {
    const Triangle& t = triangles[triangle];
    return weights[0] * of_vertices[t[0]] + weights[1] * of_vertices[t[1]] + weights[2] * of_vertices[t[2]];
  }
};

struct ProbeLayout {
  TriangleMesh mesh;                               // the base, closed, with outward normals
  std::vector<MeshPlace> places;                   // the places of all lines
  std::vector<double> lags;                        // fractions of the diagonal, ascending
  std::vector<std::vector<HeightTriple>> triples;  // (#lags) the lines with this lag, as indices of places

  // Vertices and places with the directions in which they move: the normals.
  std::vector<ProbePoint> vertex_points() const;
  std::vector<ProbePoint> place_points() const;
  // Interpolates heights at the vertices to heights at the places.  (#V in, #places out)
  std::vector<double> at_places(const std::vector<double>& of_vertices) const;
};

// The place on a mesh that is nearest to p. `tree` was made of `mesh`.
MeshPlace nearest_place(const TriangleMesh& mesh, const SurfaceTree& tree, const Vec3d& p);

// The edge of an equilateral triangle with the target's mean triangle area, as a fraction of the diagonal.
double facet_edge(const TargetBody& target);

// The edge of the base's mesh, as a fraction of the diagonal: the target's edge, or a longer one that keeps
// the mesh below about 50,000 triangles.
double probe_edge(const TargetBody& target);

// `base` is in the target's frame. The shortest lag is two edges, since facets are flat below. The longest is
// about the distance between the base's metaballs on the surface, since the base follows the target beyond.
// There are at least three lags. Every one of `lines` random places is the middle of one line for each lag,
// each in a random direction.
ProbeLayout lay_out_probes(const TargetBody& target, const MetaballBody& base, int lines, std::uint64_t seed);

}  // namespace astrolith
