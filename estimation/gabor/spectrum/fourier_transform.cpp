#include "estimation/gabor/spectrum/fourier_transform.h"

#include <fftw3.h>

#include <mutex>

#include "numerics/errors.h"

namespace astrolith {
namespace {

// FFTW's planner keeps global state. Plans may run on any thread.
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

fftw_complex* as_fftw(std::complex<double>* p) { return reinterpret_cast<fftw_complex*>(p); }

// Plans are made for aligned memory, which lets FFTW use vector instructions.
void require_aligned(const void* p) {
  if (fftw_alignment_of(static_cast<double*>(const_cast<void*>(p))) != 0) {
    throw WorkError("Fourier transform: a grid does not start at a 16-byte boundary");
  }
}

}  // namespace

FourierTransform::FourierTransform(int width, int height) : width_(width), height_(height) {
  std::vector<double> grid(grid_size());
  std::vector<std::complex<double>> half(half_size());
  const std::scoped_lock lock(planner_mutex());
  forward_plan_ = fftw_plan_dft_r2c_2d(height, width, grid.data(), as_fftw(half.data()), FFTW_ESTIMATE);
  inverse_plan_ = fftw_plan_dft_c2r_2d(height, width, as_fftw(half.data()), grid.data(), FFTW_ESTIMATE);
  if (forward_plan_ == nullptr || inverse_plan_ == nullptr) {
    throw WorkError("Fourier transform: no plan for a grid of " + std::to_string(width) + " x " +
                    std::to_string(height));
  }
}

FourierTransform::~FourierTransform() {
  const std::scoped_lock lock(planner_mutex());
  fftw_destroy_plan(static_cast<fftw_plan>(forward_plan_));
  fftw_destroy_plan(static_cast<fftw_plan>(inverse_plan_));
}

void FourierTransform::forward(std::span<const double> in, std::span<std::complex<double>> out) const {
  require_aligned(in.data());
  require_aligned(out.data());
  // A real transform out of place does not change its input.
  fftw_execute_dft_r2c(static_cast<fftw_plan>(forward_plan_), const_cast<double*>(in.data()),
                       as_fftw(out.data()));
}

void FourierTransform::inverse(std::span<std::complex<double>> in, std::span<double> out) const {
  require_aligned(in.data());
  require_aligned(out.data());
  fftw_execute_dft_c2r(static_cast<fftw_plan>(inverse_plan_), as_fftw(in.data()), out.data());
  const double scale = 1.0 / static_cast<double>(grid_size());
  for (double& value : out) value *= scale;
}

}  // namespace astrolith
