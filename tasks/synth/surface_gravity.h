// Gravity on the surface of a recipe's body, for synth: at the vertices of its mesh, or of a patch.
#pragma once

#include <span>
#include <vector>

#include "geometry/io/ply_values.h"
#include "geometry/triangle_mesh.h"
#include "gravity/polyhedron_gravity.h"
#include "gravity/surface_gravity.h"
#include "recipe/recipe.h"
#include "tasks/gravity/gravity_table.h"
#include "tasks/job/job.h"
#include "tasks/synth/body_mesh.h"

namespace astrolith {

// Throws InputError for a density that is not above 0, a period below 0, and a recipe without a length unit.
void check_gravity(const std::vector<double>& density_and_period, const Recipe& recipe);

// The whole body of a patch, in the recipe's coordinates: with so many cells along its longest side that its
// gravity at the patch is right to .05 degrees (docs/gravity.md), and coarser for means over its surface.
struct PatchBody {
  TriangleMesh mesh, coarse;
};
PatchBody make_patch_body(const Job& job, const MeshPart& patch);

// The gravity of a closed mesh in the recipe's coordinates, to 1e-6 of the acceleration.
class SurfaceGravity {
 public:
  SurfaceGravity(const Job& job, const MeshPart& part, const TriangleMesh& body);

  // Places in the recipe's coordinates.
  std::vector<PointGravity> at(std::span<const Vec3d> points) const;

  // Potentials, accelerations, slopes and elevations at the vertices of the body itself, or of a patch whose
  // coordinates are relative to `center`. Elevations are over the mean geopotential at the vertices of
  // `body`, which may be the same mesh. The summary states their ranges and the error of a random sample.
  std::vector<VertexValues> at_vertices(Job& job, const TriangleMesh& mesh, const Vec3d& center,
                                        const TriangleMesh& body) const;

 private:
  std::vector<PointGravity> find_values(std::span<const Vec3d> points,
                                        std::span<const Attraction> attractions) const;

  double density_, metres_;
  PolyhedronGravity gravity_;
  Rotation rotation_;
  const Job& job_;
};

}  // namespace astrolith
