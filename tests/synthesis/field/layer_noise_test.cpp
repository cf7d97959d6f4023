#include "synthesis/field/layer_noise.h"

#include <type_traits>

namespace astrolith {
namespace {

// No trait has a default, so that a kind that forgets one does not compile.
static_assert(!std::is_default_constructible_v<NoiseTraits>);

TEST(LayerNoiseFacts, CratersHaveNoHeights) {
  const LayerNoise craters(CraterRelief{});
  EXPECT_FALSE(traits_of(craters).has_heights);
  EXPECT_EQ(height_bound_of(craters), 0.0);
  EXPECT_EQ(detail_of(craters).left_out, 0.0);
  EXPECT_EQ(num_impulse_lists(craters), 0u);
}

TEST(LayerNoiseFacts, HeightsHaveABoundAndADetail) {
  ExemplarNoise exemplar;
  exemplar.height_bound = 0.25;
  exemplar.detail = {0.125, 1.0};
  const LayerNoise noise(exemplar);
  EXPECT_TRUE(traits_of(noise).on_surface);
  EXPECT_EQ(height_bound_of(noise), 0.25);
  EXPECT_EQ(detail_of(noise).finest, 0.125);
  EXPECT_EQ(detail_of(noise).left_out, 1.0);
}

TEST(LayerNoiseFacts, AWarpTakesTheLocalForm) {
  FractalNoise fractal;
  EXPECT_TRUE(has_local_form(LayerNoise(fractal)));
  fractal.warped = true;
  EXPECT_FALSE(has_local_form(LayerNoise(fractal)));
  EXPECT_FALSE(has_local_form(LayerNoise(SparseNoise{})));
}

TEST(LayerNoiseFacts, ImpulsesHaveLists) {
  SpotNoise spots;
  spots.kinds.count = 3;
  EXPECT_EQ(num_impulse_lists(LayerNoise(spots)), 3u);
  GaborSurfaceNoise gabor;
  gabor.bands.count = 2;
  EXPECT_EQ(num_impulse_lists(LayerNoise(gabor)), 2u);
  EXPECT_EQ(draws_at_a_point(LayerNoise(PhasorNoise{}), {}), 0.0);
}

}  // namespace
}  // namespace astrolith
