// Discrete Fourier transforms of real grids: plans are made once and used for every grid of the same size.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace astrolith {

// Bin 0 .. n-1 of a transform as a signed frequency in -floor(n/2) .. ceil(n/2)-1.
inline int signed_frequency(int bin, int n) { return bin < (n + 1) / 2 ? bin : bin - n; }
// The bin of any integer frequency, aliased.
inline int frequency_bin(int frequency, int n) { return ((frequency % n) + n) % n; }

// Owns the plans for one grid of width x height, row-major. Plans are chosen by rule and not by timing
// (FFTW_ESTIMATE), so results never depend on the load of the machine. Thread-safe once constructed.
class FourierTransform {
 public:
  FourierTransform(int width, int height);  // both >= 1
  ~FourierTransform();
  FourierTransform(const FourierTransform&) = delete;
  FourierTransform& operator=(const FourierTransform&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t grid_size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  // Columns kept of the transform: width/2 + 1; the others follow by conjugate symmetry.
  int half_width() const { return width_ / 2 + 1; }
  std::size_t half_size() const {
    return static_cast<std::size_t>(half_width()) * static_cast<std::size_t>(height_);
  }

  // out(k) = sum_x in(x) exp(-2 pi i k.x), no factor. Spans start at 16-byte boundaries, as every
  // std::vector of double does.
  void forward(std::span<const double> in, std::span<std::complex<double>> out) const;
  // out(x) = 1/(width*height) sum_k in(k) exp(2 pi i k.x); in is used as scratch.
  void inverse(std::span<std::complex<double>> in, std::span<double> out) const;

 private:
  int width_;
  int height_;
  void* forward_plan_;
  void* inverse_plan_;
};

}  // namespace astrolith
