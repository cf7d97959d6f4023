// The surface of a recipe's body without layers, as a place to put things on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"
#include "synthesis/implicit_field.h"

namespace astrolith {

class BareSurface {
 public:
  // Expects a recipe with a body.
  explicit BareSurface(const Recipe& recipe);

  bool empty() const { return field_.bounds().empty(); }
  // Of its bounding box, length units.
  double longest_side() const;

  // A point of the surface. Throws InputError, naming `where`, when there is none.
  Vec3d find(const SurfacePlace& place, const std::string& where) const;
  // Unit, outwards; from the middle of the body where the surface has none.
  Vec3d normal(const Vec3d& p) const;

  // For scattering: a mesh stands for the surface. Squared length units.
  double area() const;
  // Points of the surface, uniform over its area by three numbers in [0, 1) each.
  std::vector<Vec3d> scatter(std::span<const Vec3d> random) const;

 private:
  void make_mesh() const;
  Vec3d on_mesh(const Vec3d& random) const;
  // One step of Newton's towards the surface.
  Vec3d nearer(const Vec3d& p) const;
  Vec3d nearest(const Vec3d& p, const std::string& where) const;
  Vec3d last_crossing(const Vec3d& direction, const std::string& where) const;

  ImplicitField field_;
  // Made when first asked for.
  mutable TriangleMesh mesh_;
  mutable std::vector<double> areas_;  // running sum over the mesh's triangles
};

}  // namespace astrolith
