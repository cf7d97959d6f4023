// Heights are coefficients of a blend (relief_layer.h), which is smoother than they are. Here coefficients
// become the values of the blend at the places, and back. Where a body is thin, heights from elsewhere would
// cut it or close a gap: the room of a place is how far the surface may move there without meeting itself.
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/interval.h"
#include "synthesis/body/body_ground.h"
#include "synthesis/relief/relief_smoothing.h"
#include "synthesis/relief/relief_tiles.h"

namespace astrolith {

// Brings heights at places as near to `own` ones as the bare body needs there. A place has room below to the
// depth d if at each depth d' up to d the body is solid and s at least d' / 2, and room above likewise in
// empty space. Rooms are looked for up to R, three times the largest change D of any height. With the room R
// on both sides a height stays; with less, r on one of them, it moves by D u^2 at most, where
// u = max(r / R - .3, 0) / .7. `heights` and `own` are in the order of the points, and `scale` makes them
// lengths in the unit of the points.
void keep_room(const BodyGround& body, const ReliefPoints& points, double scale,
               const std::vector<double>& own, std::vector<double>& heights);

class ReliefValues {
 public:
  // The shares of each place in the blend at every other.
  ReliefValues(const ReliefPoints& points, const ReliefShares& shares);

  // The values at the places of the blend with these coefficients.
  std::vector<double> evaluate(const std::vector<double>& coefficients) const;

  // Coefficients that have nearly these values, by damped iterations. What lies at the finest waves of the
  // lattice is left to the spline. Where a body is thin, sheets share places and iterations would diverge:
  // coefficients stay near the values around them.
  std::vector<double> solve(const std::vector<double>& values) const;

 private:
  std::vector<Interval> neighbour_limits(const std::vector<double>& values) const;

  std::vector<std::size_t> first_;  // (places + 1) of the two lists below
  std::vector<std::uint32_t> places_;
  std::vector<float> shares_;
};

}  // namespace astrolith
