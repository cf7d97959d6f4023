// The body to be fitted: checked, welded, facing outwards, and moved into a frame of its own in which its
// bounding-box diagonal is 1, so that every tolerance of the fit is a fraction of the diagonal.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimation/shape/target/fit_points.h"
#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"

namespace astrolith {

struct TargetBody {
  TriangleMesh mesh;     // closed, manifold edges, oriented, positive volume; diagonal 1, centred on the box
  SurfaceTree tree;      // of mesh
  TriangleMesh surface;  // mesh without walls that are buried where parts overlap: what a fit can follow
  double area;           // of surface
  double volume;         // of mesh, > 0; overlaps count twice
  std::int64_t components;                           // of the union of the parts
  std::vector<std::uint32_t> component_of_triangle;  // (#F of mesh) 0 .. components - 1
  // p_in_file = center + diagonal * p_in_body, in the file's unit.
  Vec3d center;
  double diagonal;
  std::vector<std::string> remarks;  // what was mended, one line each
};

// Throws InputError "name: what is wrong; what to do" when the mesh has no faces, is open, is not manifold,
// is flat or passes through itself other than where whole parts overlap. Mends repeated vertices and faces,
// and faces that look inwards, and says so.
TargetBody prepare_target(TriangleMesh mesh, const std::string& name);

// A body in the file's frame and unit, moved into the target's.
MetaballBody in_target_frame(const TargetBody& target, MetaballBody body);

// Points at random places at least `depth` inside and outside of the body, up to `count` of each (fewer in a
// thin body), within a box of 1.3 times its size. Point i depends on the seed and i alone.
void add_containment_points(const TargetBody& target, double depth, int count, std::uint64_t seed,
                            FitPoints& points);

// Points about `distance` above and below random places of the surface, up to `count` of each: where the
// islands and cavities of a fit begin.
void add_shell_points(const TargetBody& target, double distance, int count, std::uint64_t seed,
                      FitPoints& points);

}  // namespace astrolith
