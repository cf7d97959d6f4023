// Heights are coefficients of a blend (relief_layer.h), which is smoother than they are. Here coefficients
// become the values of the blend at the places, and back.
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/interval.h"
#include "synthesis/relief/relief_shares.h"
#include "synthesis/relief/relief_smoothing.h"

namespace astrolith {

class ReliefValues {
 public:
  // The shares of each place in the blend at every other.
  ReliefValues(const ReliefPoints& points, const ReliefShares& shares);

  // The values at the places of the blend with these coefficients.
  std::vector<double> values_of(const std::vector<double>& coefficients) const;

  // Coefficients that have nearly these values, by damped iterations. What lies at the finest waves of the
  // lattice is left to the spline. Where a body is thin, sheets share places and iterations would diverge:
  // coefficients stay near the values around them.
  std::vector<double> coefficients_of(const std::vector<double>& values) const;

 private:
  std::vector<Interval> limits_of(const std::vector<double>& values) const;

  std::vector<std::size_t> first_;  // (places + 1) of the two lists below
  std::vector<std::uint32_t> places_;
  std::vector<float> shares_;
};

}  // namespace astrolith
