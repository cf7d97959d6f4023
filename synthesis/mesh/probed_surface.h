// A coarse mesh of a surface, from which places are drawn where a finer mesh is looked at.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/box_tree.h"

namespace astrolith {

class ProbedSurface {
 public:
  ProbedSurface() = default;
  // Points are drawn from the triangles whose centres lie within the box, and area() is theirs.
  ProbedSurface(TriangleMesh mesh, const Box& within);

  bool empty() const { return !(area() > 0.0); }
  double area() const { return areas_.empty() ? 0.0 : areas_.back(); }  // square length units

  struct Point {
    Vec3d position;
    Vec3d normal;  // unit length, outwards
  };
  // The point number `index` of a sequence whose beginnings all lie evenly over the area. Expects a surface
  // that is not empty.
  Point point(int index) const;

  // The largest share of the area that lies in a slab of this height across the z axis; 0 to 1.
  double largest_share(double height) const;

  // The area within a box, of all triangles.
  double area_within(const Box& box) const;

 private:
  TriangleMesh mesh_;
  std::vector<double> areas_;  // of the triangles up to this one
  BoxTree tree_;               // of the triangles' boxes
};

}  // namespace astrolith
