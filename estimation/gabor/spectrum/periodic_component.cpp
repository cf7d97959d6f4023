#include "estimation/gabor/spectrum/periodic_component.h"

#include <cmath>
#include <numbers>

#include "estimation/gabor/spectrum/fourier_transform.h"

namespace astrolith {
namespace {

// v of Moisan's eq. 9: the difference of each border pixel to the opposite one.
std::vector<double> border_jumps(const GreyImage& image) {
  const int w = image.width;
  const int h = image.height;
  std::vector<double> v(image.values.size(), 0.0);
  const auto index = [w](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
  };
  for (int y = 0; y < h; ++y) {
    const double jump = image.at(w - 1, y) - image.at(0, y);
    v[index(0, y)] += jump;
    v[index(w - 1, y)] -= jump;
  }
  for (int x = 0; x < w; ++x) {
    const double jump = image.at(x, h - 1) - image.at(x, 0);
    v[index(x, 0)] += jump;
    v[index(x, h - 1)] -= jump;
  }
  return v;
}

// The factor of the second difference on frequency k, 2 cos(2 pi k / n) - 2. It is zero only at k = 0.
double second_difference_factor(int k, int n) {
  const double s = std::sin(std::numbers::pi * k / n);
  return -4.0 * s * s;
}

}  // namespace

PeriodicDecomposition decompose_periodic(const GreyImage& image) {
  const FourierTransform fourier(image.width, image.height);
  std::vector<std::complex<double>> transform(fourier.half_size());
  fourier.forward(border_jumps(image), transform);
  std::size_t i = 0;
  for (int ky = 0; ky < image.height; ++ky) {
    for (int kx = 0; kx < fourier.half_width(); ++kx, ++i) {
      const double factor =
          second_difference_factor(kx, image.width) + second_difference_factor(ky, image.height);
      transform[i] = factor == 0.0 ? 0.0 : transform[i] / factor;
    }
  }
  PeriodicDecomposition result{image, image};
  fourier.inverse(transform, result.smooth.values);
  for (std::size_t p = 0; p < image.values.size(); ++p) result.periodic.values[p] -= result.smooth.values[p];
  return result;
}

}  // namespace astrolith
