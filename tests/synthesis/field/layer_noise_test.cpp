#include "synthesis/field/layer_noise.h"

#include <type_traits>

namespace astrolith {
namespace {

// No trait has a default, so that a kind that forgets one does not compile.
static_assert(!std::is_default_constructible_v<NoiseTraits>);

TEST(LayerNoiseFacts, CratersHaveNoHeights) {
  const LayerNoise craters(CraterRelief{});
  EXPECT_FALSE(noise_traits(craters).has_heights);
  EXPECT_EQ(noise_height_bound(craters), 0.0);
  EXPECT_EQ(noise_detail(craters).left_out, 0.0);
  EXPECT_EQ(num_impulse_lists(craters), 0u);
}

TEST(LayerNoiseFacts, AWarpTakesTheLocalForm) {
  FractalNoise fractal;
  EXPECT_TRUE(has_local_form(LayerNoise(fractal)));
  fractal.warped = true;
  EXPECT_FALSE(has_local_form(LayerNoise(fractal)));
  EXPECT_FALSE(has_local_form(LayerNoise(SparseNoise{})));
}

}  // namespace
}  // namespace astrolith
