// The dictionary of bandwidth-quantised Gabor noise: symmetric pairs of Gaussians in the power spectrum,
// applied and transposed by Fourier transforms.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "estimation/gabor/spectrum/fourier_transform.h"
#include "recipe/recipe.h"

namespace astrolith {

// Standard deviation of a lobe in cycles per pixel: the full width at half maximum is 2^-bandwidth.
double lobe_deviation(int bandwidth);

// A Gaussian of one bandwidth, periodic with the grid, centred at bins +-(kx, ky).
struct GaborAtom {
  int bandwidth = 0;
  int kx = 0;  // bins of 1/width cycles per pixel, |kx| <= width/2
  int ky = 0;
};

// Columns a_j = c_j W (g(f - m_j) + g(f + m_j)): rows are the frequencies of a width x height grid with
// weights W >= 0, columns are atoms; c_j makes every column a unit vector. For each bandwidth the centres lie
// on a lattice as coarse as leaves neighbours correlated by at most 0.95 (Galerne et al. 2012). All entries
// are non-negative. Calls share scratch memory: one caller at a time; inside, bandwidths run in parallel.
class GaborDictionary {
 public:
  // weight: width * height values, symmetric under f -> -f, not all zero.
  GaborDictionary(int width, int height, int lowest_bandwidth, int highest_bandwidth,
                  std::vector<double> weight);

  int width() const { return fourier_.width(); }
  int height() const { return fourier_.height(); }
  std::size_t rows() const { return fourier_.grid_size(); }
  std::size_t size() const { return atoms_.size(); }
  const GaborAtom& atom(std::size_t j) const { return atoms_[j]; }
  // c_j: a coefficient x puts the spectrum x c_j (g(f - m_j) + g(f + m_j)) on the grid, before weighting.
  double scale(std::size_t j) const { return scale_[j]; }
  const std::vector<double>& weight() const { return weight_; }

  // out = A x; x has size() values, out rows().
  void synthesize(std::span<const double> x, std::span<double> out) const;
  // out = A' r; r has rows() values, out size().
  void analyze(std::span<const double> r, std::span<double> out) const;

 private:
  struct Band {
    int bandwidth = 0;
    std::size_t begin = 0, end = 0;                // its atoms
    std::vector<double> transform_x, transform_y;  // of the periodic Gaussian along each axis
    std::vector<double> grid;                      // scratch
    std::vector<std::complex<double>> half;        // scratch
  };
  void add_band(int bandwidth);
  void normalize_columns();
  void filter(const std::vector<double>& transform_x, const std::vector<double>& transform_y,
              std::span<std::complex<double>> half) const;
  std::size_t row(int kx, int ky) const;

  FourierTransform fourier_;
  std::vector<double> weight_;
  std::vector<GaborAtom> atoms_;
  std::vector<double> scale_;
  mutable std::vector<Band> bands_;
  mutable std::vector<std::complex<double>> half_;
  mutable std::vector<double> grid_;
};

// One axis of a lobe on a grid of n bins: sum_k exp(-((i - center + k n) / deviation)^2 / 2) for i = 0 ..
// n-1; center and deviation in bins.
std::vector<double> periodic_gaussian(int n, double center, double deviation);

// floor(log2(diagonal)): the narrowest bandwidth the paper fits on a width x height grid; at most 12.
int narrowest_bandwidth(int width, int height);

}  // namespace astrolith
