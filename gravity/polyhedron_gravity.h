// The gravity of a homogeneous polyhedron, for G times density = 1: potentials in squared length units,
// accelerations in length units. Multiply both by G times the density.
#pragma once

#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "gravity/gravity_tree.h"
#include "numerics/progress.h"

namespace astrolith {

struct Attraction {
  double potential = 0.0;  // positive, zero at infinity
  Vec3d acceleration;      // its gradient
};

// Estimates of the errors of one attraction, in its units. Errors are nearly always below, seldom by more
// than a factor of 100.
struct AttractionError {
  double potential = 0.0, acceleration = 0.0;
};
struct ExactAttractions {
  std::vector<Attraction> values;
  std::vector<AttractionError> errors;
};

// A closed mesh whose faces are counter-clockwise seen from outside has the attraction of its volume. Points
// may lie anywhere: inside, outside, on facets, edges and vertices. The value of a point is the same for any
// number of threads and whatever other points are given with it.
class PolyhedronGravity {
 public:
  // Indices of the mesh must be in range. Throws InputError for a mesh without a facet that has an area,
  // and WorkError when progress asks to stop.
  explicit PolyhedronGravity(const TriangleMesh& mesh, const GravityDetail& detail = {},
                             const Progress& progress = {})
      : tree_(make_gravity_tree(mesh, detail, progress)) {}

  // Near facets exactly, the others by multipoles, and beyond some radii the whole body by those of its
  // volume. The sum of the bounds of all multipoles' errors is at most `tolerance` times the acceleration at
  // a point. Where the acceleration nearly vanishes, as at the centre of a body, 0.05 of that of a ball of
  // equal volume takes its place. tolerance in [1e-12, 0.1]. Throws WorkError when progress asks to stop.
  std::vector<Attraction> at(std::span<const Vec3d> points, double tolerance,
                             const Progress& progress = {}) const;

  // Without a bound: nodes at more than 1 / 0.7 of their radius are taken by their multipoles to order 3.
  // Directions are right to some hundredths of a degree.
  std::vector<Attraction> roughly_at(std::span<const Vec3d> points) const;

  // All facets exactly, which takes time in proportion to points times facets. Where rounding would leave
  // more than the multipoles of the volume cut off, beyond some 15 radii, these are taken.
  ExactAttractions exactly_at(std::span<const Vec3d> points, const Progress& progress = {}) const;

  const GravityTree& tables() const { return tree_; }

 private:
  GravityTree tree_;
};

// The difference of accelerations from exact ones and the estimated errors of these, as fractions of the
// exact ones.
struct AchievedError {
  int points = 0;
  double largest = 0.0, rms = 0.0;
  double largest_of_potential = 0.0;
};

// Compares the values at `sample` of the points, chosen at random by the seed, with exact ones. All points
// are compared where there are no more. sample >= 0.
AchievedError achieved_error(const PolyhedronGravity& gravity, std::span<const Vec3d> points,
                             std::span<const Attraction> values, int sample, std::uint64_t seed,
                             const Progress& progress = {});

}  // namespace astrolith
