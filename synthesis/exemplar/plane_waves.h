// A Fourier series on a square grid, with the same bits on every machine.
#pragma once

#include <complex>
#include <vector>

namespace astrolith {

// Replaces the amplitudes of waves by their sum: value(x, y) = sum over k, l of
// amplitude(k, l) exp(2 pi i (k x + l y) / side). Arrays are side x side, row-major along x and k. Expects a
// power of two.
void sum_plane_waves(int side, std::vector<std::complex<double>>& values);

}  // namespace astrolith
