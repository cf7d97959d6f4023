// The surface of a recipe's body without layers, as a place to put things on.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"

namespace astrolith {

// The body without its layers, as functions of a point in the recipe's frame and length unit.
struct BareBody {
  Box bounds;                                        // holds the surface; empty where the body is
  std::function<double(const Vec3d&)> value;         // close to the signed distance, positive inside
  std::function<Vec3d(const Vec3d&)> gradient;       // of value, inwards
  std::function<TriangleMesh(int cells)> meshed_at;  // closed, with so many cells along the longest side

  bool inside(const Vec3d& p) const { return value(p) > 0.0; }
};

class BareSurface {
 public:
  explicit BareSurface(BareBody body) : body_(std::move(body)) {}

  bool empty() const { return body_.bounds.empty(); }
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

  BareBody body_;
  // Made when first asked for.
  mutable TriangleMesh mesh_;
  mutable std::vector<double> areas_;  // running sum over the mesh's triangles
};

}  // namespace astrolith
