#include "estimation/gabor/spectrum/periodic_component.h"

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

GreyImage random_image(int width, int height) {
  CounterRandom random(7);
  GreyImage image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.values.push_back(random.uniform());
  return image;
}

// The Laplacian over neighbours. `wrap` decides whether neighbours across the border count.
double laplacian(const GreyImage& image, int x, int y, bool wrap) {
  const int w = image.width;
  const int h = image.height;
  double sum = 0.0;
  for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const int nx = x + dx;
    const int ny = y + dy;
    const bool inside = nx >= 0 && nx < w && ny >= 0 && ny < h;
    if (inside || wrap) sum += image.at((nx + w) % w, (ny + h) % h) - image.at(x, y);
  }
  return sum;
}

TEST(PeriodicComponent, PartsAddUpToTheImage) {
  const GreyImage image = random_image(33, 40);
  const PeriodicDecomposition parts = decompose_periodic(image);
  double smooth_sum = 0.0;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    EXPECT_NEAR(parts.periodic.values[i] + parts.smooth.values[i], image.values[i], 1e-14);
    smooth_sum += parts.smooth.values[i];
  }
  EXPECT_NEAR(smooth_sum, 0.0, 1e-10);
}

// By Moisan's definition the periodic Laplacian of the periodic component is the interior Laplacian of the
// image.
TEST(PeriodicComponent, ItsPeriodicLaplacianIsTheInteriorLaplacianOfTheImage) {
  for (const auto& [w, h] : {std::pair{33, 40}, {32, 17}, {2, 5}}) {
    const GreyImage image = random_image(w, h);
    const GreyImage periodic = decompose_periodic(image).periodic;
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        EXPECT_NEAR(laplacian(periodic, x, y, true), laplacian(image, x, y, false), 1e-12);
      }
    }
  }
}

TEST(PeriodicComponent, AnImageWhoseBordersMatchIsUnchanged) {
  GreyImage image = random_image(32, 32);
  for (int y = 0; y < 32; ++y) image.values[static_cast<std::size_t>(y) * 32 + 31] = image.at(0, y);
  for (int x = 0; x < 32; ++x) image.values[31 * 32 + static_cast<std::size_t>(x)] = image.at(x, 0);
  const GreyImage periodic = decompose_periodic(image).periodic;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    EXPECT_NEAR(periodic.values[i], image.values[i], 1e-13);
  }
}

TEST(PeriodicComponent, ARampIsAlmostAllSmooth) {
  GreyImage image{64, 64, {}};
  for (int i = 0; i < 64 * 64; ++i) image.values.push_back(i % 64 / 64.0);
  const GreyImage periodic = decompose_periodic(image).periodic;
  double square = 0.0;
  double mean = 0.0;
  for (const double v : periodic.values) mean += v / 4096.0;
  for (const double v : periodic.values) square += (v - mean) * (v - mean) / 4096.0;
  EXPECT_LT(square, 1e-3 / 12.0);  // the ramp itself has variance 1/12
}

}  // namespace
}  // namespace astrolith
