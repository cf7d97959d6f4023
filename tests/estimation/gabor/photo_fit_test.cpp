#include "estimation/gabor/photo_fit.h"

#include <unistd.h>

#include <cmath>
#include <numbers>

#include "estimation/gabor/image/image_reader.h"
#include "numerics/errors.h"
#include "synthesis/gabor/color_texture.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// Fits the photo that a recipe with two coloured layers makes.
class PhotoFitTest : public ::testing::Test {
 protected:
  PhotoFitTest() {
    GaborLayer coarse, fine;
    coarse.exemplar_rms = 0.1;
    coarse.color = LayerColor{{0.8, 0.6, 0.0}, {0.5, 0.45, 0.4}};
    coarse.lobes = {{4, 0.0625, 0.03, 1.0}};
    fine.exemplar_rms = 0.03;
    fine.color = LayerColor{{0.0, 0.0, 1.0}, {}};
    fine.lobes = {{3, -0.25, 0.125, 1.0}};
    write_tiff_float(synthesize_color_texture({coarse, fine}, 128, 96, {5}), 128, 96, file_, 3);
  }
  ~PhotoFitTest() override { fs::remove(file_); }

  PhotoFit fit(PhotoFitOptions options) const {
    options.fit.max_lobes = 20;
    std::vector<GreyImage> planes = read_image(file_, options.colors).planes;
    flatten(planes, "photo", options);
    return fit_planes(planes, "photo", options);
  }

  fs::path file_ = fs::temp_directory_path() / ("astrolith_photo_" + std::to_string(::getpid()) + ".tif");
};

TEST_F(PhotoFitTest, ColoursComeApartIntoTheLayersThatMadeThem) {
  PhotoFitOptions options;
  options.colors = true;
  const PhotoFit photo = fit(options);
  ASSERT_EQ(photo.channels.size(), 2u);
  const FittedChannel& first = photo.channels[0];
  EXPECT_NEAR(first.color->axis.x, 0.8, 0.01);
  EXPECT_NEAR(first.color->axis.y, 0.6, 0.01);
  EXPECT_NEAR(first.color->mean.z, 0.4, 0.01);
  EXPECT_EQ(photo.channels[1].color->mean, Vec3d{});
  EXPECT_NEAR(first.fit.exemplar_rms, 0.1, 0.02);
  EXPECT_NEAR(first.fit.lobes[0].frequency_x, 0.0625, 0.02);
  EXPECT_NEAR(std::abs(photo.channels[1].fit.lobes[0].frequency_x), 0.25, 0.05);
  EXPECT_NEAR(photo.variance_in_spectrum(), 1.0, 1e-6);
  EXPECT_FALSE(photo.weak());
  EXPECT_LT(photo.spectrum_residual(), photo.weak_above());
  EXPECT_EQ(photo.lobes(), first.fit.lobes.size() + photo.channels[1].fit.lobes.size());
  EXPECT_GT(make_gabor_layer(first, true).height_rms, 0.0);
  EXPECT_EQ(make_gabor_layer(photo.channels[1], false).height_rms, 0.0);
}

// A photo above the largest side is cut into segments, and waves of twice their side are lost. So is a slope
// across the photo.
TEST_F(PhotoFitTest, VarianceOfWiderFeaturesIsStated) {
  const auto held = [&](double wave, double slope, int largest_side) {
    std::vector<float> values;
    for (int i = 0; i < 128 * 128; ++i) {
      const double x = i % 128, noise = 0.01 * (i * 7919 % 13);
      values.push_back(
          static_cast<float>(0.5 + wave * std::sin(x * std::numbers::pi / 32.0) + slope * x + noise));
    }
    write_tiff_float(values, 128, 128, file_, 1);
    PhotoFitOptions options;
    options.fit.largest_side = largest_side;
    return fit(options).variance_in_spectrum();
  };
  EXPECT_NEAR(held(0.1, 0.0, 1024), 1.0, 0.05);
  EXPECT_LT(held(0.1, 0.0, 32), 0.6);
  EXPECT_LT(held(0.0, 0.002, 1024), 0.4);
}

TEST_F(PhotoFitTest, LuminanceIsOneLayerWithoutColour) {
  const PhotoFit photo = fit({});
  ASSERT_EQ(photo.channels.size(), 1u);
  EXPECT_FALSE(photo.channels[0].color.has_value());
  EXPECT_NEAR(photo.channels[0].fit.exemplar_mean, 0.2126 * 0.5 + 0.7152 * 0.45 + 0.0722 * 0.4, 0.02);
}

TEST_F(PhotoFitTest, TheTrendIsTakenOutFirst) {
  PhotoFitOptions options;
  options.detrend_degree = 2;
  const PhotoFit photo = fit(options), as_is = fit({});
  EXPECT_LT(photo.channels[0].fit.exemplar_rms, as_is.channels[0].fit.exemplar_rms);
  EXPECT_NEAR(photo.channels[0].fit.exemplar_mean, as_is.channels[0].fit.exemplar_mean, 1e-9);
}

TEST_F(PhotoFitTest, SmallAndConstantImagesAreRefusedWhateverTheOptions) {
  for (const int n : {1, 31, 40}) {
    write_tiff_float(std::vector<float>(static_cast<std::size_t>(3 * n * n), 0.25f), n, n, file_, 3);
    for (const bool colors : {false, true}) {
      for (const int degree : {0, 3}) {
        PhotoFitOptions options;
        options.colors = colors;
        options.detrend_degree = degree;
        EXPECT_THROW(fit(options), InputError) << n << colors << degree;
      }
    }
  }
}

}  // namespace
}  // namespace astrolith
