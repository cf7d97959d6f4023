// Where the details fit looks at a body: a mesh of the base, as fine as the target's, whose vertices move out
// to whatever surface is asked about; and on it lines of three places at several lags, for the roughness.
// Heights between vertices are linear, as they are on the target's triangles.
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

  // Of a value that every vertex has, linear over the triangle.
  template <typename T>
  T interpolate(const std::vector<Triangle>& triangles, const std::vector<T>& of_vertices) const {
    const Triangle& t = triangles[triangle];
    return weights[0] * of_vertices[t[0]] + weights[1] * of_vertices[t[1]] + weights[2] * of_vertices[t[2]];
  }
};

struct ProbeLayout {
  TriangleMesh mesh;                               // of the base, closed, with outward normals
  std::vector<MeshPlace> places;                   // of the lines
  std::vector<double> lags;                        // fractions of the diagonal, ascending
  std::vector<std::vector<HeightTriple>> triples;  // of each lag, as indices of places

  std::vector<ProbePoint> vertex_points() const;
  std::vector<ProbePoint> place_points() const;
  // Heights at the places, of heights at the vertices.
  std::vector<double> at_places(const std::vector<double>& of_vertices) const;
};

// Of the point of a mesh that is nearest to p.
MeshPlace nearest_place(const TriangleMesh& mesh, const SurfaceTree& tree, const Vec3d& p);

// Edge of an equilateral triangle of the target's mean triangle area, in its unit.
double facet_edge(const TargetBody& target);

// The edge of the base's mesh: the target's own, but no less than what keeps the mesh below some 50,000
// triangles.
double probe_edge(const TargetBody& target);

// `base` in the target's frame. The lags lead from two edges, below which facets are flat, to about the
// distance of the base's spheres over the surface, beyond which the base follows the target itself; there are
// at least three. Lines start at `lines` random places, each lag in a direction of its own.
ProbeLayout lay_out_probes(const TargetBody& target, const MetaballBody& base, int lines, std::uint64_t seed);

}  // namespace astrolith
