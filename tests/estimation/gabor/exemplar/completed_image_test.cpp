#include "estimation/gabor/exemplar/phase_exemplar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "estimation/gabor/image/missing_ground.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/sample_statistics.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

// Blocks of 8 x 8 pixels, of which every ninth is missing.
GreyImage with_gaps(GreyImage image) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if ((x / 8 + 3 * (y / 8)) % 9 != 0) continue;
      image.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                   static_cast<std::size_t>(x)] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  fill_missing(image);
  return image;
}

TEST(CompletedImage, KeepsWhatIsKnown) {
  const GreyImage whole = testing::draw_realisation(testing::four_lobe_spectrum(), 5);
  EXPECT_EQ(completed(whole, 1).values, whole.values);
  const GreyImage gaps = with_gaps(whole), image = completed(gaps, 1);
  EXPECT_NEAR(missing_share(image), 1.0 / 9.0, 0.02);
  for (std::size_t i = 0; i < whole.values.size(); ++i) {
    if (image.missing[i]) continue;
    ASSERT_EQ(image.values[i], whole.values[i]) << i;
  }
  EXPECT_EQ(completed(gaps, 1).values, image.values);
}

// Smooth values alone lack power in the octaves of wavelengths below the gaps' sides.
TEST(CompletedImage, HasTheSpectrumOfTheWhole) {
  const GreyImage whole = testing::draw_realisation(testing::four_lobe_spectrum(), 5);
  const GreyImage gaps = with_gaps(whole);
  const PowerSpectrum truth = exemplar_periodogram(whole);
  const auto ratio = [&](const GreyImage& image) {
    return std::sqrt(exemplar_periodogram(image).variance() / truth.variance());
  };
  EXPECT_LT(ratio(gaps), 0.99);
  EXPECT_NEAR(ratio(completed(gaps, 1)), 1.0, 0.02);
}

}  // namespace
}  // namespace astrolith
