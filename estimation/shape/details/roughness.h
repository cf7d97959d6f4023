// How rough a surface is at each scale: the root mean square second difference of its heights,
//   nu(r)^2 = < (t(q + r u) - 2 t(q) + t(q - r u))^2 >   over places q and directions u,
// a structure function of second order. Unlike a histogram of coarse bins it tells amplitude and frequency
// apart; unlike the difference of first order (the RMS deviation of Shepard et al., "The roughness of natural
// terrain", JGR 2001) it hardly sees what a smooth base left over at larger scales.
#pragma once

#include <span>
#include <vector>

#include "estimation/shape/details/detail_parameters.h"

namespace astrolith {

// Three places on a line, as indices of heights.
struct HeightTriple {
  std::uint32_t before, middle, after;
};

// Of each lag, whose triples are given.  (#lags)
std::vector<double> roughness(std::span<const double> heights,
                              const std::vector<std::vector<HeightTriple>>& triples_of_lag);

// nu(r) of fractal sums in closed form but for one table a noise: octaves are independent, so their squares
// add up,
//   nu(r)^2 = amplitude^2 sum_o gain^2o nu_noise(lacunarity^o frequency r)^2.
class RoughnessModel {
 public:
  // Tabulates the noises by random triples in space; the same tables every time.
  RoughnessModel();

  // For amplitude 1; gradient modulation, scale, bias and weight do not enter.  (#lags)
  std::vector<double> of(const PlainNoise& noise, std::span<const double> lags) const;

 private:
  double squared(std::size_t which, double cycles) const;

  std::vector<double> tables_[3];  // nu_noise^2 at kLeastCycles * kTableStep^i cycles
};

// For each number of octaves the amplitude, frequency and gain that make one noise (of kDetailNoises) as
// rough as wanted at every lag, least squares of log nu; all octaves' frequencies stay within the ranges.
// Numbers of octaves that do worse than the best, by more than a roughness is known, are left out; fewest
// octaves first.
std::vector<PlainNoise> noises_as_rough_as(std::span<const double> wanted, std::span<const double> lags,
                                           std::size_t which, const DetailRanges& ranges,
                                           const RoughnessModel& model);

// Root mean square of log(a / b), each term at most 3: 0.1 for a tenth too much or too little.
double roughness_misfit(std::span<const double> a, std::span<const double> b);

}  // namespace astrolith
