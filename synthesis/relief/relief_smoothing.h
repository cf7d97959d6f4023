// The places of a relief as points of the surface, and means of heights around them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "numerics/vec3.h"
#include "synthesis/relief/cell_rows.h"
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
  const CellRows& rows() const { return rows_; }                    // cells of four spacings

  // Calls visit(number, squared distance, cosine of the angle between the normals) for the places within
  // `radius` of a point that face the same side, cell by cell.
  template <typename Visit>
  void for_each_near(const Vec3d& p, const Vec3d& normal, double radius, const Visit& visit) const {
    rows_.for_each_row(Box{p, p}, radius, [&](std::size_t first, std::size_t end) {
      for (std::uint32_t k = rows_.first_in_cell(first); k < rows_.first_in_cell(end); ++k) {
        const std::uint32_t i = rows_.order()[k];
        const double squared = squared_norm(at_[i] - p), facing = dot(normals_[i], normal);
        if (squared < radius * radius && facing > 0.0) visit(i, squared, facing);
      }
    });
  }

 private:
  std::vector<Vec3d> at_, normals_;
  std::vector<double> weights_;
  CellRows rows_;
};

// Means of the heights around each place. The weights (1 - d^2 / R^2)^4 with R = sqrt(8) sigma have the
// standard deviation sigma (length units) along an axis, nearly. Places that are near each other for the
// width of a mean count as one in it.
std::vector<double> smoothed_heights(const ReliefPoints& points, const std::vector<double>& heights,
                                     double sigma);

// The means of three fields at once, which take hardly longer than those of one.
using ThreeFields = std::array<std::vector<double>, 3>;
ThreeFields smoothed_fields(const ReliefPoints& points, const ThreeFields& fields, double sigma);

// The means of three fields around the places of cells all over the body: all of them, or some thousand.
struct SampledMeans {
  std::vector<std::uint32_t> places;
  ThreeFields means;  // around each of these
};
SampledMeans sampled_means(const ReliefPoints& points, const ThreeFields& fields, double sigma);

}  // namespace astrolith
