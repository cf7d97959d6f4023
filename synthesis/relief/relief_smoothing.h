// The places of a relief as points of the surface, and means of heights around them.
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/box_tree.h"
#include "numerics/vec3.h"
#include "synthesis/relief/relief_places.h"

namespace astrolith {

// Places in length units, and how those near a point are found.
class ReliefPoints {
 public:
  ReliefPoints(const std::vector<ReliefPlace>& places, double spacing);

  std::size_t size() const { return at_.size(); }
  const Vec3d& at(std::size_t i) const { return at_[i]; }
  const Vec3d& normal(std::size_t i) const { return normals_[i]; }  // outwards, unit length
  double weight(std::size_t i) const { return weights_[i]; }        // in the blend of the maps, 0 .. 1

  // Calls visit(number, squared distance, cosine of the angle between the normals) for the places within
  // `radius` of a point that face the same side, by their numbers.
  template <typename Visit>
  void for_each_near(const Vec3d& p, const Vec3d& normal, double radius, const Visit& visit) const {
    const Vec3d side{radius, radius, radius};
    for (const std::uint32_t i : tree_.touching({p - side, p + side})) {
      const double squared = squared_norm(at_[i] - p), facing = dot(normals_[i], normal);
      if (squared < radius * radius && facing > 0.0) visit(i, squared, facing);
    }
  }

 private:
  std::vector<Vec3d> at_, normals_;
  std::vector<double> weights_;
  BoxTree tree_;
};

// Means of the heights around each place. The weights (1 - d^2 / R^2)^4 with R = sqrt(8) sigma have the
// standard deviation sigma (length units) along an axis, nearly.
std::vector<double> smoothed_heights(const ReliefPoints& points, const std::vector<double>& heights,
                                     double sigma);

}  // namespace astrolith
