// The surface of a recipe's body without layers, on which landforms are placed.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"

namespace astrolith {

// The body without its layers, as functions of a point in the recipe's frame and length unit.
struct BareBody {
  Box bounds;                                   // holds the surface; empty for an empty body
  std::function<double(const Vec3d&)> value;    // about the signed distance, length units, positive inside
  std::function<Vec3d(const Vec3d&)> gradient;  // gradient of value, pointing inwards
  std::function<TriangleMesh(int cells)> meshed_at;  // closed mesh with `cells` cells along the longest side
  double lipschitz_bound = 1.0;                      // bound of |gradient of value|

  bool inside(const Vec3d& p) const { return value(p) > 0.0; }
};

class BareSurface {
 public:
  explicit BareSurface(BareBody body) : body_(std::move(body)) {}

  bool empty() const { return body_.bounds.empty(); }
  // The longest side of the body's bounding box, length units.
  double longest_side() const;

  // The point of the surface at a place. Throws InputError, naming `where`, when the place has none.
  Vec3d find(const SurfacePlace& place, const std::string& where) const;
  // The unit normal at a point of the surface, outwards. Where the gradient is zero, it is the direction from
  // the centre of the bounding box.
  Vec3d normal(const Vec3d& p) const;

  // A closed mesh of the surface. It has no facet where the body is thinner than 1/64 of its longest side.
  const TriangleMesh& mesh() const;
  // The area of a mesh of the surface, in squared length units.
  double area() const;
  // Points of the surface, uniform over its area: one for each element of `random`, whose coordinates lie in
  // [0, 1). Empty for a body without a surface.
  std::vector<Vec3d> scatter(std::span<const Vec3d> random) const;
  // One such point. Expects area() to have been called, and to be above 0. It may be called from many
  // threads.
  Vec3d place(const Vec3d& random) const;
  // The point of the surface that lies about (east, north) from a point of it in the tangent plane, in length
  // units; none where the surface is not near there.
  std::optional<Vec3d> place_beside(const Vec3d& p, double east, double north) const;
  // The signed distance to first order, length units, positive inside; and a bound of its slope.
  double value(const Vec3d& p) const { return body_.value(p); }
  double lipschitz_bound() const { return body_.lipschitz_bound; }
  const Box& bounds() const { return body_.bounds; }
  // The surface's point near p, by two steps of Newton's method.
  Vec3d projected(const Vec3d& p) const { return nearer(nearer(p)); }

 private:
  void make_mesh() const;
  Vec3d on_mesh(const Vec3d& random) const;
  // The point after one step of Newton's method towards the surface.
  Vec3d nearer(const Vec3d& p) const;
  Vec3d nearest(const Vec3d& p, const std::string& where) const;
  Vec3d last_crossing(const Vec3d& direction, const std::string& where) const;

  BareBody body_;
  // The mesh is made at the first call of mesh(), area() or scatter(), which must not run in two threads at
  // once.
  mutable TriangleMesh mesh_;
  mutable std::vector<double> areas_;  // running sum over the mesh's triangles
};

}  // namespace astrolith
