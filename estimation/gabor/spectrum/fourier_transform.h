// Discrete Fourier transforms of real grids. Plans are made once and serve every grid of their size.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace astrolith {

// The signed frequency of bin 0 .. n-1, in -floor(n/2) .. ceil(n/2)-1.
inline int signed_frequency(int bin, int n) { return bin < (n + 1) / 2 ? bin : bin - n; }
// The bin of any integer frequency, aliased.
inline int frequency_bin(int frequency, int n) { return ((frequency % n) + n) % n; }

// The plans for a grid of width x height values, row-major. Plans are chosen by rule and not by timing
// (FFTW_ESTIMATE), so results never depend on the load of the machine. Many threads may use one object at
// once.
class FourierTransform {
 public:
  FourierTransform(int width, int height);  // both >= 1; throws WorkError where FFTW has no plan
  ~FourierTransform();
  FourierTransform(const FourierTransform&) = delete;
  FourierTransform& operator=(const FourierTransform&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t grid_size() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  // The number of columns of a transform that are kept, width/2 + 1. Conjugate symmetry gives the others.
  int half_width() const { return width_ / 2 + 1; }
  std::size_t half_size() const {
    return static_cast<std::size_t>(half_width()) * static_cast<std::size_t>(height_);
  }

  // out(k) = sum_x in(x) exp(-2 pi i k.x), without a factor. `in` has grid_size() values, `out` half_size().
  // Both start at a 16-byte boundary, as every std::vector of double does; otherwise WorkError is thrown.
  void forward(std::span<const double> in, std::span<std::complex<double>> out) const;
  // out(x) = 1/(width*height) sum_k in(k) exp(2 pi i k.x), with the spans of `forward`. `in` is overwritten.
  void inverse(std::span<std::complex<double>> in, std::span<double> out) const;

 private:
  int width_;
  int height_;
  void* forward_plan_;
  void* inverse_plan_;
};

}  // namespace astrolith
