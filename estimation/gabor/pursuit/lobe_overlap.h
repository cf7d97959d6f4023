// Inner products of single lobes, for solvers on a small support.
#pragma once

#include <cstddef>
#include <vector>

namespace astrolith {

// A symmetric pair of Gaussians on the grid, amplitude * (g(f - m) + g(f + m)). It is stored as one profile
// of g(f - m) per axis; reversed profiles give the mirror image g(f + m).
struct LobeProfile {
  std::vector<double> x;  // width values, the periodic Gaussian along a row
  std::vector<double> y;  // height values
  double amplitude = 1.0;
};

// Centres and deviations are in bins.
LobeProfile make_lobe_profile(int width, int height, double center_x, double center_y, double deviation_x,
                              double deviation_y, double amplitude);

// <a, b> = sum over the grid of metric * a * b. `metric` has width * height values, row-major, and is
// symmetric under f -> -f. Values of the Gaussians' products below 1e-14 along an axis are left out.
double lobe_overlap(const std::vector<double>& metric, const LobeProfile& a, const LobeProfile& b);

// The sum over the grid of grid * a. `grid` has width * height values and is symmetric under f -> -f.
double lobe_sum(const std::vector<double>& grid, const LobeProfile& a);

// grid += factor * a.
void add_lobe(const LobeProfile& a, double factor, std::vector<double>& grid);

}  // namespace astrolith
