// Heights of surfaces over a base body at fixed points, without meshing the surfaces. The surface is that of
// the measured target, of the base itself, or of a candidate for the base's details.
//
// A point v moves along its direction n, a unit vector that points out of the base, until it meets the
// surface:
//   t <- t + F(v + t n),
// where F is a distance to first order, positive inside. All surfaces are met by these steps, so that their
// heights over the same points can be compared point by point.
//
// A layout has the places at which the details fit measures. The first are the vertices of a mesh of the
// base, about as fine as the target's mesh, which move to the surface. The second are lines of three places
// on this mesh with several lags, for the roughness. Heights between vertices are interpolated linearly, as
// on the target's triangles.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cuda/candidate_evaluator.h"
#include "estimation/shape/details/roughness.h"
#include "estimation/shape/target/target_body.h"
#include "geometry/surface/surface_tree.h"
#include "recipe/recipe.h"
#include "synthesis/body/metaball_body.h"

namespace astrolith {

struct ProbePoint {
  Vec3d start, direction;
};

// The heights of the target at the points. They are clipped to [-reach, reach], in length units.  (#points)
std::vector<double> target_heights(const SurfaceTree& target, std::span<const ProbePoint> points,
                                   double reach);

class SurfaceProbe {
 public:
  // Heights are clipped to [-reach, reach], in length units.
  SurfaceProbe(const MetaballBody& base, const std::vector<ProbePoint>& points, double reach);

  // The height of every point, for the base with these layers as synthesis makes them from a recipe with this
  // seed. Runs in parallel, and may be called from many threads.  (#points)
  std::vector<double> heights(std::span<const FractalLayer> layers, std::uint64_t seed) const;

  // The heights for each candidate, computed by the evaluator. They have the bits of the function above.
  // (#candidates x #points)
  std::vector<std::vector<double>> heights(CandidateEvaluator& evaluator,
                                           std::span<const std::vector<FractalLayer>> candidates,
                                           std::uint64_t seed) const;

 private:
  // A group of points that lie close together, and the metaballs that reach them.
  struct Block {
    std::vector<std::int32_t> points;                    // indices
    std::array<std::vector<float>, 3> start, direction;  // (#points of the block)
    PreparedMetaballs metaballs;
  };
  void add_block(const PreparedMetaballs& base, const std::vector<ProbePoint>& points,
                 std::vector<std::int32_t> indices);

  void add_lines(const Block& block);

  std::size_t size_;
  double reach_;
  Box domain_;
  std::vector<Block> blocks_;
  ProbeLines lines_;  // the points of all blocks, one block after the other
};

// A place on a triangle of the base's mesh.
struct MeshPlace {
  std::uint32_t triangle = 0;
  std::array<double, 3> weights{};  // barycentric

  // Interpolates a value that every vertex has linearly over the triangle.
  template <typename T>
  T interpolate(const std::vector<Triangle>& triangles, const std::vector<T>& vertex_values) const {
    const Triangle& t = triangles[triangle];
    return weights[0] * vertex_values[t[0]] + weights[1] * vertex_values[t[1]] +
           weights[2] * vertex_values[t[2]];
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
  std::vector<double> at_places(const std::vector<double>& vertex_values) const;
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
