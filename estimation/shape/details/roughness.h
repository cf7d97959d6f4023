// The roughness of a surface at each scale: the root mean square second difference of its heights t,
//   nu(r)^2 = < (t(q + r u) - 2 t(q) + t(q - r u))^2 >   over places q and directions u.
// This is a structure function of second order, in length units. Unlike a histogram with coarse bins, it
// separates amplitude and frequency. Unlike the difference of first order (the RMS deviation of Shepard et
// al., "The roughness of natural terrain", JGR 2001), it hardly depends on the errors of a smooth base at
// larger scales.
#pragma once

#include <span>
#include <vector>

#include "estimation/shape/details/detail_parameters.h"

namespace astrolith {

// Three places on a line, as indices of heights.
struct HeightTriple {
  std::uint32_t before, middle, after;
};

// The roughness at each lag. The triples of a lag are its lines.  (#lags)
std::vector<double> roughness(std::span<const double> heights,
                              const std::vector<std::vector<HeightTriple>>& lag_triples);

// The roughness nu(r) of fractal sums, in closed form with one table for each noise. Octaves are independent,
// so their squares add up:
//   nu(r)^2 = amplitude^2 sum_o gain^2o nu_noise(lacunarity^o frequency r)^2.
class RoughnessModel {
 public:
  // Tabulates the noises from random triples in space. The tables are always the same.
  RoughnessModel();

  // The roughness for amplitude 1. Gradient modulation, scale, bias and weight do not enter.  (#lags)
  std::vector<double> of(const PlainNoise& noise, std::span<const double> lags) const;

 private:
  double squared(std::size_t which, double cycles) const;

  std::vector<double> tables_[3];  // nu_noise^2 at a geometric series of cycles, one table for each noise
};

// For each number of octaves, finds the amplitude, frequency and gain that make a noise as rough as wanted at
// every lag: least squares of log nu. `which` is an index into kDetailNoises. The frequencies of all octaves
// stay within the ranges. A number of octaves is left out if its misfit exceeds the best one by more than the
// error of a roughness. The result is ordered by the number of octaves.
std::vector<PlainNoise> noises_as_rough_as(std::span<const double> wanted, std::span<const double> lags,
                                           std::size_t which, const DetailRanges& ranges,
                                           const RoughnessModel& model);

// The root mean square of log(a / b), with each logarithm clipped to [-3, 3]. It is about 0.1 if a is a tenth
// too large or too small.
double roughness_misfit(std::span<const double> a, std::span<const double> b);

}  // namespace astrolith
