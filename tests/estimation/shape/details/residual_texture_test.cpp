#include "estimation/shape/details/residual_texture.h"

#include <cmath>

#include "numerics/errors.h"
#include "tests/estimation/shape/details/known_details.h"

namespace astrolith {
namespace {

using testing::three_spheres;
using testing::with_details;

// The mean frequency of all lobes, weighted by their variance, in cycles per pixel.
double mean_frequency(const GaborLayer& layer) {
  double sum = 0.0, variance = 0.0;
  for (const GaborLobe& lobe : layer.lobes) {
    sum += lobe.variance * std::hypot(lobe.frequency_x, lobe.frequency_y);
    variance += lobe.variance;
  }
  return sum / variance;
}

TEST(ResidualTexture, HasTheHeightAndTheScaleOfTheDetails) {
  GaborLayer ripples;
  ripples.pixel_size = 0.02;
  ripples.height_rms = 0.006;
  ripples.lobes = {{4, 0.06, 0.03, 1.0}};
  Recipe recipe;
  recipe.body = three_spheres();
  recipe.layers.push_back(ripples);
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), 110, collector);
  const TargetBody target = prepare_target(std::move(collector.mesh), "ripples");
  const ResidualTexture texture = fit_residual_texture(target, in_target_frame(target, three_spheres()), {});
  EXPECT_GE(texture.patches, 10);
  EXPECT_NEAR(texture.layer.height_rms * target.diagonal / 0.006, 1.0, 0.15);
  const double found = mean_frequency(texture.layer) / (texture.layer.pixel_size * target.diagonal);
  EXPECT_NEAR(found / (std::hypot(0.06, 0.03) / 0.02), 1.0, 0.15);
}

TEST(ResidualTexture, NothingLeftIsAnInputError) {
  const TargetBody target = with_details({}, 24);
  MetaballBody base = in_target_frame(target, three_spheres());
  ResidualTextureOptions options;
  options.side = 100;  // wider than the body
  options.patches = 20;
  EXPECT_THROW(fit_residual_texture(target, base, options), InputError);
}

}  // namespace
}  // namespace astrolith
