// Slides of loose ground between the columns of a surface: the vertices of a mesh, or clusters of them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// Slides aim at a slope a little below the talus angle and begin a little above their aim, so that they end.
inline constexpr double kSlideAim = 1.0 - 2e-3;

// Two columns between which ground may slide, a < b.
struct GroundPair {
  std::uint32_t a, b;
  friend bool operator==(const GroundPair&, const GroundPair&) = default;
  friend auto operator<=>(const GroundPair&, const GroundPair&) = default;
};

// The columns of a surface. `area` is the volume that a unit of height adds to a column, and 0 for rock.
struct Ground {
  std::span<const Vec3d> positions;
  std::span<const Vec3d> up;  // a unit vector for each column that is not rock
  std::span<const double> area;
  std::span<const GroundPair> pairs;  // neighbours that are not rock
};

// The drop and the horizontal length from column a to column b, length units.
struct Incline {
  double drop, length;
};
Incline incline(std::span<const Vec3d> positions, std::span<const Vec3d> up, GroundPair pair);

// A pair of columns with its slope. With heights along the verticals its drop is drop + h_a - h_b.
struct GroundEdge {
  GroundPair ends;
  double drop;   // height of a above b before anything moved
  double limit;  // magnitude of the drop at the slope that slides aim at
};

// The edges of some pairs. `slope` is what slides aim at, a tangent.
std::vector<GroundEdge> ground_edges(const Ground& ground, std::span<const GroundPair> pairs, double slope);

struct GroundSlides {
  int sweeps = 0;
  bool any = false;      // whether any ground slid
  bool at_rest = false;  // whether the last sweep moved nothing
};

// Gives edges their turns in sweeps until a sweep moves nothing, or until most_sweeps are done. heights[v] is
// the rise of column v since the edges were measured. The sum of area times height stays the same.
// after_sweep(sweeps done) may throw, which ends the slides.
GroundSlides slide_ground(std::span<const GroundEdge> edges, std::span<const double> area, int most_sweeps,
                          const std::function<void(int)>& after_sweep, std::span<double> heights);

// Slides of loose ground over far distances, on clusters of columns instead of on the columns themselves.
//
// A slope of n columns takes about n^2 sweeps to settle, because a sweep moves ground by about one column.
// Clusters are some times wider than columns, so that their slope settles in fewer sweeps, each of fewer
// edges. Clusters of clusters go on until few are left. The coarsest ones slide first, and each level begins
// with what the coarser one has moved. What is left to a level is local: it takes a number of sweeps that
// hardly grows with the mesh.
//
// Returns the rise of each column that the slides of all coarser levels give, length units. `slope` is what
// slides on the columns aim at, a tangent. A sweep over n clusters moves ground as far as N / n sweeps over N
// columns do, so that a level makes at most most_sweeps n / N sweeps. All rises are 0 where that is less than
// one. They keep the volume but for a few hundredths of what moves. after_sweep() may throw, which ends the
// slides.
std::vector<double> coarse_slides(const Ground& ground, double slope, double most_sweeps,
                                  const std::function<void(int)>& after_sweep);

}  // namespace astrolith
