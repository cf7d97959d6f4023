// Inner products of single lobes: what a solver on a small support needs of the dictionary.
#pragma once

#include <cstddef>
#include <vector>

namespace astrolith {

// A symmetric pair of Gaussians on the grid, amplitude * (g(f - m) + g(f + m)), as one profile an axis of
// g(f - m); the mirror image reads them backwards.
struct LobeProfile {
  std::vector<double> x;  // width values, the periodic Gaussian along a row
  std::vector<double> y;  // height values
  double amplitude = 1.0;
};

// Centre and deviation in bins, per axis.
LobeProfile make_lobe_profile(int width, int height, double center_x, double center_y, double deviation_x,
                              double deviation_y, double amplitude);

// <a, b> = sum over the grid of metric * a * b; metric: width * height values, symmetric under f -> -f. Parts
// of the Gaussians below 1e-14 of their peaks are left out.
double lobe_overlap(const std::vector<double>& metric, const LobeProfile& a, const LobeProfile& b);

// <a, s>: the same with any symmetric grid for b, sum over the grid of grid * a.
double lobe_sum(const std::vector<double>& grid, const LobeProfile& a);

// grid += factor * a.
void add_lobe(const LobeProfile& a, double factor, std::vector<double>& grid);

}  // namespace astrolith
