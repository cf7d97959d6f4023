#include "estimation/gabor/exemplar/phase_exemplar.h"

#include <cmath>

#include "estimation/gabor/exemplar/exemplar_preparation.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/errors.h"
#include "numerics/sample_statistics.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

// A spectrum has one real image for any phases, and the image has the spectrum.
TEST(PhaseExemplar, AnImageHasItsSpectrumExactly) {
  for (const int width : {48, 49}) {
    PowerSpectrum spectrum =
        power_spectrum(GreyImage{width, 32, std::vector<double>(static_cast<std::size_t>(32 * width))});
    CounterRandom random(3);
    GreyImage noise{width, 32, {}};
    for (int i = 0; i < 32 * width; ++i) noise.values.push_back(random.normal());
    spectrum = power_spectrum(noise);
    const PowerSpectrum image_spectrum = power_spectrum(random_phase_image(spectrum, 7));
    for (std::size_t i = 0; i < spectrum.power.size(); ++i)
      ASSERT_NEAR(image_spectrum.power[i], spectrum.power[i], 1e-9) << i;
    EXPECT_NE(random_phase_image(spectrum, 7).values, random_phase_image(spectrum, 8).values);
  }
}

// The layer's image is larger than a cut and has its spectrum and its variance. A photo that repeats keeps
// its size.
TEST(PhaseExemplar, TakesTheSpectrumOfThePhoto) {
  const testing::CutTexture cut = testing::cut_realisation(testing::ring_power, 2);
  const ExemplarLayer layer = phase_exemplar({cut.image}, "photo", 1);
  EXPECT_EQ(layer.pixels->width, 512);
  EXPECT_EQ(layer.pixels->height, 512);
  EXPECT_NEAR(layer.height_rms / std::sqrt(sample_variance(cut.image.values)), 1.0, 0.02);
  const GreyImage texture = exemplar_texture_like(layer, cut.image, 5);
  EXPECT_NEAR(sample_variance(texture.values) / sample_variance(cut.image.values), 1.0, 0.25);
  EXPECT_LT(texture_score(texture, cut.image).sum(), 0.2);
  const ExemplarLayer periodic =
      phase_exemplar({testing::draw_realisation(testing::ring_spectrum(), 2)}, "periodic", 1);
  EXPECT_EQ(periodic.pixels->width, 128);
  EXPECT_EQ(periodic.pixels->height, 128);
}

TEST(PhaseExemplar, PaintsTheColoursOfItsPrincipalAxes) {
  std::vector<GreyImage> planes;
  const GreyImage first = testing::draw_realisation(testing::ring_spectrum(), 4),
                  second = testing::draw_realisation(testing::steep_spectrum(), 5);
  for (const double share : {0.08, 0.05, 0.02}) {
    GreyImage plane = first;
    for (std::size_t i = 0; i < plane.values.size(); ++i) {
      plane.values[i] = 0.4 + share * first.values[i] + (share < 0.03 ? 0.03 : -0.01) * second.values[i];
    }
    planes.push_back(plane);
  }
  const ExemplarLayer layer = phase_exemplar(planes, "photo", 1);
  ASSERT_TRUE(layer.color);
  // The covariance of red and blue is that of the photo.
  std::vector<double> red, blue;
  for (std::size_t i = 0; i < layer.pixels->rgb.size(); i += 3) {
    red.push_back(layer.pixels->rgb[i] / 65535.0);
    blue.push_back(layer.pixels->rgb[i + 2] / 65535.0);
  }
  EXPECT_NEAR(std::sqrt(sample_variance(red)), std::sqrt(sample_variance(planes[0].values)), 0.004);
  EXPECT_NEAR(std::sqrt(sample_variance(blue)), std::sqrt(sample_variance(planes[2].values)), 0.002);
}

TEST(PhaseExemplar, MovesItsProgressAndStops) {
  const GreyImage photo = testing::cut_realisation(testing::ring_power, 2).image;
  double last = -1.0;
  int calls = 0;
  phase_exemplar({photo, photo, photo}, "photo", 1, [&](double fraction, std::string_view) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return ++calls > 0;
  });
  EXPECT_GT(calls, 100);
  EXPECT_LE(last, 1.0);
  for (const int most : {0, 1, 100, calls - 1}) {
    int count = 0;
    const auto stop = [&](double, std::string_view) { return count++ < most; };
    EXPECT_THROW(phase_exemplar({photo, photo, photo}, "photo", 1, stop), WorkError) << most;
  }
}

TEST(PhaseExemplar, RefusesWhatIsNoPhoto) {
  EXPECT_THROW(phase_exemplar({GreyImage{64, 64, std::vector<double>(4096, 0.5)}}, "flat", 1), InputError);
  EXPECT_THROW(phase_exemplar({GreyImage{16, 64, std::vector<double>(1024, 0.5)}}, "small", 1), InputError);
}

}  // namespace
}  // namespace astrolith
