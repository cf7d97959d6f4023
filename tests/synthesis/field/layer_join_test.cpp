#include "synthesis/field/layer_join.h"

#include <cmath>

#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

// The elevations at points near the surface of a potato: the field less the field of the bare body.
std::vector<double> elevations(const Recipe& recipe) {
  Recipe bare = recipe;
  bare.layers.clear();
  const ImplicitField field(recipe), body(bare);
  CounterRandom random(7);
  std::vector<double> result;
  for (int i = 0; i < 300; ++i) {
    const Vec3d p = testing::random_point(random, {{-0.5, -0.35, -0.3}, {0.5, 0.35, 0.3}});
    result.push_back(field.value(p) - body.value(p));
  }
  return result;
}

FractalLayer named(const char* name, double amplitude, double frequency,
                   std::optional<std::uint64_t> seed = std::nullopt) {
  FractalLayer layer = testing::fractal_layer(amplitude, frequency, 3);
  layer.name = name;
  layer.seed = seed;
  return layer;
}

Recipe with_layers(std::vector<Layer> layers) {
  Recipe recipe = testing::potato_recipe(12, 3);
  recipe.body->groups = {{"first", {0, 1, 2}}};
  recipe.layers = std::move(layers);
  return recipe;
}

Combination kind(Combine combine, double width = Combination{}.width) {
  Combination how;
  how.kind = combine;
  how.width = width;
  return how;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::fabs(a[i] - b[i]));
  return largest;
}

constexpr double kRounding = 1e-6;  // rounding of F on a body about 1 long

TEST(LayerJoin, ReplacedIsTheLayerAlone) {
  FractalLayer hills = named("hills", 0.05, 3.0, 4), plains = named("plains", 0.01, 9.0, 5);
  plains.use.combination = kind(Combine::kReplace);
  EXPECT_LT(largest_difference(elevations(with_layers({hills, plains})), elevations(with_layers({plains}))),
            kRounding);
}

TEST(LayerJoin, ReplacedByLocalityIsEitherLayer) {
  FractalLayer hills = named("hills", 0.05, 3.0, 4), plains = named("plains", 0.01, 9.0, 5);
  const std::vector<double> before = elevations(with_layers({hills})),
                            alone = elevations(with_layers({plains}));
  plains.use.combination = kind(Combine::kReplace);
  plains.use.locality = Locality{"first", 1e-5};
  const std::vector<double> joined = elevations(with_layers({hills, plains}));
  int replaced = 0, kept = 0;
  for (std::size_t i = 0; i < joined.size(); ++i) {
    EXPECT_GE(joined[i], std::min(before[i], alone[i]) - kRounding);
    EXPECT_LE(joined[i], std::max(before[i], alone[i]) + kRounding);
    replaced += std::fabs(joined[i] - alone[i]) < 1e-4;
    kept += std::fabs(joined[i] - before[i]) < 1e-4;
  }
  EXPECT_GT(replaced, 20);
  EXPECT_GT(kept, 20);
  EXPECT_GT(replaced + kept, 280);
}

TEST(LayerJoin, ABlendIsSymmetricAndNeverBelowEither) {
  const FractalLayer a = named("a", 0.05, 3.0, 1), b = named("b", 0.04, 5.0, 2);
  const std::vector<double> elevations_a = elevations(with_layers({a})),
                            elevations_b = elevations(with_layers({b}));
  const auto blended = [](FractalLayer first, FractalLayer second, double width) {
    second.use.combination = kind(Combine::kBlend, width);
    first.use.combination = kind(Combine::kReplace);
    return elevations(with_layers({first, second}));
  };
  const double width = 0.02;
  const std::vector<double> ab = blended(a, b, width), sharp = blended(a, b, 0.0);
  EXPECT_LT(largest_difference(ab, blended(b, a, width)), kRounding);
  for (std::size_t i = 0; i < ab.size(); ++i) {
    const double higher = std::max(elevations_a[i], elevations_b[i]);
    EXPECT_NEAR(sharp[i], higher, kRounding);
    EXPECT_GE(ab[i], higher - kRounding);
    EXPECT_LE(ab[i], higher + 0.5 * width + kRounding);
    // But for its rounding, the union is zero where R_1 of both heights is zero: (f + g + |f - g|) / 2 + ...
    const double d = elevations_a[i] - elevations_b[i];
    EXPECT_NEAR(ab[i], 0.5 * (elevations_a[i] + elevations_b[i] + std::sqrt(d * d + width * width)),
                kRounding);
  }
}

TEST(LayerJoin, AnIntersectionIsTheUnionUpsideDown) {
  for (const double width : {0.0, 0.1, 2.0}) {
    CounterRandom random(3);
    for (int i = 0; i < 50; ++i) {
      const float a = static_cast<float>(random.normal()), b = static_cast<float>(random.normal());
      Combination how = kind(Combine::kBlend, width);
      float above = a, height = b, below = -a, negative = -b;
      join_elevations(how, 1, nullptr, &height, &above);
      how.intersection = true;
      join_elevations(how, 1, nullptr, &negative, &below);
      EXPECT_EQ(above, -below);
    }
  }
}

TEST(LayerJoin, AWarpOfNothingIsNothing) {
  FractalLayer hills = named("hills", 0.05, 3.0, 4), warp = named("warp", 0.0, 2.0);
  warp.use.combination = kind(Combine::kWarp);
  warp.use.combination.direction = {1, 2, 3};
  EXPECT_EQ(elevations(with_layers({warp, hills})), elevations(with_layers({hills})));
  warp.amplitude = 0.1;
  warp.use.combination.direction = {};
  EXPECT_EQ(elevations(with_layers({warp, hills})), elevations(with_layers({hills})));
}

// A displacement by a constant height is a shift of the later noise.
TEST(LayerJoin, AWarpMovesLaterLayers) {
  FractalLayer hills = named("hills", 0.05, 3.0, 4);
  SparseLayer constant;  // noise varies within a cell, so the cells are huge
  constant.cell_size = 1e6;
  constant.levels = 1;
  constant.probability = 1.0;
  constant.threshold = 0.0;
  constant.amplitude = -0.2;
  const double height = elevations(with_layers({constant})).front();
  ASSERT_GT(std::fabs(height), 1e-3);
  constant.use.combination = kind(Combine::kWarp);
  constant.use.combination.direction = {0.5, 0.0, -1.0};
  const std::vector<double> warped = elevations(with_layers({constant, hills}));
  hills.bias = height * constant.use.combination.direction;
  EXPECT_LT(largest_difference(warped, elevations(with_layers({hills}))), 1e-5);
}

TEST(LayerJoin, AMaskCountsWhereItsLayerIsHigh) {
  FractalLayer mask = named("where", 1.0, 3.0, 4), hills = named("hills", 0.05, 6.0, 5);
  const std::vector<double> heights = elevations(with_layers({mask})),
                            everywhere = elevations(with_layers({hills}));
  mask.use.combination = kind(Combine::kMask);
  EXPECT_LT(largest_difference(elevations(with_layers({mask})), std::vector<double>(300, 0.0)), kRounding);
  hills.use.mask = LayerMask{"where", -0.1, 0.3};
  const std::vector<double> masked = elevations(with_layers({mask, hills}));
  for (std::size_t i = 0; i < masked.size(); ++i) {
    const double t = std::clamp((heights[i] + 0.1) / 0.4, 0.0, 1.0);
    EXPECT_NEAR(masked[i], t * t * (3.0 - 2.0 * t) * everywhere[i], 1e-5);
  }
}

TEST(LayerJoin, AGaborLayerCannotBeWarped) {
  FractalLayer warp = named("warp", 0.1, 2.0);
  warp.use.combination = kind(Combine::kWarp);
  EXPECT_NO_THROW(validate_recipe(with_layers({testing::gabor_layer(0.02, 0.01), warp}), "r"));
  EXPECT_THROW(validate_recipe(with_layers({warp, testing::gabor_layer(0.02, 0.01)}), "r"), InputError);
}

// A layer with a seed of its own does not change when it moves among the layers. A layer without one does.
TEST(LayerJoin, OwnSeedsOutliveMoves) {
  FractalLayer hills = named("hills", 0.05, 3.0), flat = named("flat", 0.0, 3.0);
  EXPECT_NE(elevations(with_layers({hills, flat})), elevations(with_layers({flat, hills})));
  hills.seed = 0;
  EXPECT_EQ(elevations(with_layers({hills, flat})), elevations(with_layers({flat, hills})));
  CraterLayer craters;
  craters.population = CraterPopulation{{20, std::nullopt, 0.05, 0.2, 2.0}, 1.0, 0.0, 0.0};
  craters.seed = 3;
  EXPECT_EQ(elevations(with_layers({craters, flat})), elevations(with_layers({flat, craters})));
}

// A recipe whose layers join in all ways, one upon another.
Recipe joined_in_all_ways() {
  FractalLayer hills = named("hills", 0.06, 3.0), warp = named("warp", 0.1, 2.0), mask = named("m", 1.0, 4.0),
               rocks = named("rocks", 0.03, 8.0), dust = named("dust", 0.005, 12.0);
  warp.use.combination = kind(Combine::kWarp);
  warp.use.combination.direction = {1, -1, 0.5};
  mask.use.combination = kind(Combine::kMask);
  rocks.use.combination = kind(Combine::kBlend, 0.01);
  dust.use.combination = kind(Combine::kReplace);
  dust.use.mask = LayerMask{"m", 0.0, 0.1};
  SpotLayer spots;
  spots.amplitude = 0.05;
  spots.size = 0.05;
  spots.cell_size = 0.2;
  return with_layers({hills, warp, mask, spots, rocks, dust});
}

// Layers also join in coordinates local to an origin, where noise has the digits of local coordinates.
TEST(LayerJoin, IsTheSameNearAnOrigin) {
  const ImplicitField field(joined_in_all_ways());
  CounterRandom random(6);
  for (int k = 0; k < 100; ++k) {
    const Vec3d origin = testing::random_point(random, {{-0.5, -0.4, -0.3}, {0.4, 0.3, 0.2}});
    const Vec3d p = origin + Vec3d{0.01, -0.02, 0.005};
    const float x = 0.01f, y = -0.02f, z = 0.005f;
    float value = 0.0f;
    field.gather({origin - Vec3d{0.03, 0.03, 0.03}, origin + Vec3d{0.03, 0.03, 0.03}})
        .evaluate_local(origin, {&x, 1}, {&y, 1}, {&z, 1}, {&value, 1}, kExactEverywhere);
    EXPECT_NEAR(static_cast<double>(value), field.value(p), 1e-5);
  }
}

}  // namespace
}  // namespace astrolith
