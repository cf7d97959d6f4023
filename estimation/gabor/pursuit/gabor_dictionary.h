// The dictionary of bandwidth-quantised Gabor noise: symmetric pairs of Gaussians in the power spectrum.
// Fourier transforms compute its products.
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

// A pair of Gaussians of one bandwidth, periodic with the grid, centred at the bins +-(kx, ky).
struct GaborAtom {
  int bandwidth = 0;
  int kx = 0;  // bins of 1/width cycles per pixel, |kx| <= width/2
  int ky = 0;
};

// The matrix A of Galerne et al. 2012 with the columns a_j = c_j W (g(f - m_j) + g(f + m_j)). Rows are the
// frequencies of a width x height grid with weights W >= 0. Columns are atoms, and c_j makes every column a
// unit vector. For each bandwidth the centres lie on a lattice. It is the finest lattice of whole bins whose
// neighbours are correlated by at most 0.95. All entries of A are non-negative. Calls share scratch memory,
// so only one caller at a time is allowed. Inside a call the bandwidths run in parallel.
class GaborDictionary {
 public:
  // weight: width * height values, symmetric under f -> -f, not all zero. Throws WorkError where their number
  // does not match the grid.
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
    std::size_t begin = 0, end = 0;                // the band's range of atoms
    std::vector<double> transform_x, transform_y;  // transforms of the periodic Gaussian along each axis
    std::vector<double> grid;                      // scratch
    std::vector<std::complex<double>> half;        // scratch
  };
  void add_band(int bandwidth);
  template <typename Work>
  void for_each_band(const Work& work) const;  // in parallel
  void normalize_columns();
  void normalize_band(Band& band, const std::vector<double>& squared_weight);
  // Fills the band's grid with the scaled coefficients at the atoms' centres; returns whether any is not
  // zero.
  bool put_impulses(std::span<const double> x, Band& band) const;
  // half *= the outer product of the two transforms.
  void filter(const std::vector<double>& transform_x, const std::vector<double>& transform_y,
              std::span<std::complex<double>> half) const;
  std::size_t row(int kx, int ky) const;
  std::size_t center(const GaborAtom& atom) const { return row(atom.kx, atom.ky); }
  std::size_t mirrored_center(const GaborAtom& atom) const { return row(-atom.kx, -atom.ky); }

  FourierTransform fourier_;
  std::vector<double> weight_;
  std::vector<GaborAtom> atoms_;
  std::vector<double> scale_;
  mutable std::vector<Band> bands_;
  mutable std::vector<std::complex<double>> half_;
  mutable std::vector<double> grid_;
};

// One axis of a lobe on a grid of n bins: sum_k exp(-((i - center + k n) / deviation)^2 / 2) for i from 0 to
// n - 1. `center` and `deviation` are in bins.
std::vector<double> periodic_gaussian(int n, double center, double deviation);

// The narrowest bandwidth that the paper fits on a width x height grid: floor(log2(diagonal)), at most 12.
int narrowest_bandwidth(int width, int height);

}  // namespace astrolith
