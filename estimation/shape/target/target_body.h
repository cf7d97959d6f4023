// The body to be fitted. Its mesh is checked, welded and oriented outwards, and moved into a frame of its
// own, in which the diagonal of its bounding box is 1. Every tolerance of the fit is therefore a fraction of
// the diagonal.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"
#include "numerics/errors.h"
#include "numerics/progress.h"
#include "numerics/vec3.h"
#include "recipe/recipe.h"

namespace astrolith {

// Points in the target's frame, whose unit is the diagonal of the bounding box.
struct FitPoints {
  std::vector<Vec3d> on_surface;  // the model's surface must pass through them
  std::vector<Vec3d> inside;      // they must lie inside the model
  std::vector<Vec3d> outside;     // they must lie outside the model
};

// A mesh that passes through itself.
class CrossingMesh : public InputError {
 public:
  using InputError::InputError;
};

struct TargetBody {
  TriangleMesh mesh;     // closed, manifold edges, oriented, positive volume; diagonal 1, centred on the box
  SurfaceTree tree;      // made of `mesh`
  TriangleMesh surface;  // `mesh` without the walls that are buried where components overlap
  double area;           // area of `surface`
  double volume;         // volume of `mesh`, > 0; overlaps count twice
  std::int64_t components;                        // number of components of the union
  std::vector<std::uint32_t> triangle_component;  // (#F of mesh) 0 .. components - 1
  // p_in_file = center + diagonal * p_in_body, in the file's unit.
  Vec3d center;
  double diagonal;
  std::vector<std::string> remarks;  // what was mended, one line each
};

// Throws InputError "name: what is wrong; what to do" if the mesh has no faces, is open, is not manifold, is
// flat, or passes through itself (CrossingMesh). Whole components may overlap. Repeated vertices and faces
// and faces that look inwards are mended, with a remark each. Between its steps the preparation calls
// `progress` with the share of its time that is over, of a usual mesh. It cannot give half a target: a
// progress that asks to stop throws, or is not heeded.
TargetBody prepare_target(TriangleMesh mesh, const std::string& name, const Progress& progress = {});

// Moves a body from the file's frame and unit into the target's.
MetaballBody in_target_frame(const TargetBody& target, MetaballBody body);

// Adds random points that lie at least `depth` inside the body and as many at least `depth` outside it. There
// are up to `count` of each, and fewer if the body is thin. They lie within a box of 1.3 times the body's
// size. Point i depends on the seed and i only.
void add_containment_points(const TargetBody& target, double depth, int count, std::uint64_t seed,
                            FitPoints& points);

// Adds points about `distance` above and below random places of the surface, up to `count` of each. Islands
// and cavities of a fit begin there.
void add_shell_points(const TargetBody& target, double distance, int count, std::uint64_t seed,
                      FitPoints& points);

// Adds points inside the body where it is so thin that a shell at `distance` has none: below random places of
// the surface, up to `count`, about as far from one wall as from the other.
void add_middle_points(const TargetBody& target, double distance, int count, std::uint64_t seed,
                       FitPoints& points);

}  // namespace astrolith
