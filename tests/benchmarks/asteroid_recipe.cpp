// Writes the recipe of the asteroid for which the speed of synthesis is stated: 500 metaballs, length 1,
// hills, plates, craters and, unless `bare` is given, the three main bands of gravel.
//
//   asteroid_recipe RECIPE.json [bare]      bare: metaballs and hills alone
#include <cstdio>
#include <exception>
#include <string_view>

#include "recipe/recipe_json.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

FractalLayer hills() { return testing::fractal_layer(0.02, 3.0, 5); }

FractalLayer plates() {
  FractalLayer layer = testing::fractal_layer(0.006, 9.0, 1);
  layer.noise = Noise::kWorleyF1;
  return layer;
}

SpotLayer craters() {
  SpotLayer layer;
  layer.amplitude = 0.01;
  layer.size = 0.03;
  layer.cell_size = 0.12;
  layer.kappa = -0.4;
  layer.layers = 3;
  return layer;
}

// A pixel is about as wide as a cell of the mesh of a million triangles. The lobes are the strongest ones
// that a fit of gravel found in each band.
GaborLayer gravel() {
  GaborLayer layer;
  layer.pixel_size = 0.003;
  layer.height_rms = 0.001;
  layer.lobes = {{2, -0.0487, 0.0490, 0.0040}, {2, 0.0489, 0.0489, 0.0016},  {2, 0.2932, 0.0488, 0.0002},
                 {3, 0.0, 0.0, 0.0048},        {3, -0.0253, 0.0255, 0.0031}, {4, -0.0137, 0.0278, 0.0032},
                 {4, 0.0276, 0.0001, 0.0012}};
  return layer;
}

Recipe asteroid(bool bare) {
  Recipe recipe = testing::potato_recipe(500, 3);
  recipe.layers = {hills()};
  if (!bare) recipe.layers = {hills(), plates(), craters(), gravel()};
  return recipe;
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  const bool bare = argc == 3 && std::string_view(argv[2]) == "bare";
  if (argc != 2 && !bare) return std::fprintf(stderr, "usage: asteroid_recipe RECIPE.json [bare]\n"), 2;
  try {
    astrolith::write_recipe(astrolith::asteroid(bare), argv[1]);
  } catch (const std::exception& e) {
    return std::fprintf(stderr, "asteroid_recipe: %s\n", e.what()), 1;
  }
}
