#include "synthesis/field/implicit_field.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "numerics/errors.h"
#include "tests/support/points.h"
#include "tests/support/refusal.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

using testing::fractal_layer;
using testing::gabor_layer;
using testing::potato_recipe;
using testing::random_point;
using testing::sphere_recipe;

TEST(ImplicitField, OneMetaballIsASphereOfItsRadius) {
  const Vec3d center{1.0, -2.0, 0.5};
  const ImplicitField field(sphere_recipe(2.0, center));
  CounterRandom random(1);
  for (int i = 0; i < 100; ++i) {
    const Vec3d out = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    EXPECT_NEAR(field.value(center + 2.0 * out), 0.0, 2e-6);
    EXPECT_NEAR(field.value(center + 1.99 * out), 0.01, 1e-4);
    EXPECT_TRUE(field.inside(center + 1.9 * out));
    EXPECT_FALSE(field.inside(center + 2.1 * out));
    EXPECT_LT(norm(field.gradient(center + 2.0 * out) + out), 1e-5);  // inwards, unit length
  }
  EXPECT_LT(norm(field.bounds().min - (center - Vec3d{2, 2, 2})), 0.3);
  EXPECT_LT(norm(field.bounds().max - (center + Vec3d{2, 2, 2})), 0.3);
}

TEST(ImplicitField, PositiveHeightsEnlargeTheBody) {
  Recipe recipe = sphere_recipe(1.0);
  const ImplicitField bare(recipe);
  recipe.layers = {fractal_layer(0.05, 1.0, 2)};
  const ImplicitField field(recipe);
  EXPECT_NEAR(field.height_bound(), 0.05 * (1 + 0.5), 1e-9);
  CounterRandom random(2);
  int higher = 0, lower = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3d out = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    const double height = field.value(out) - bare.value(out);
    ASSERT_LE(std::fabs(height), field.height_bound());
    higher += height > 0.004;
    lower += height < -0.004;
    EXPECT_EQ(field.inside(out), height > -bare.value(out));
    EXPECT_FALSE(field.inside((1.0 + height + 0.5 * std::fabs(height) + 0.005) * out));
    EXPECT_TRUE(field.inside((1.0 + height - 0.5 * std::fabs(height) - 0.005) * out));
  }
  EXPECT_GT(higher, 50);
  EXPECT_GT(lower, 50);
}

TEST(ImplicitField, GradientWithLayersIsTheDerivative) {
  Recipe recipe = potato_recipe(30, 4);
  recipe.layers = {fractal_layer(0.01, 4.0, 2)};
  const ImplicitField field(recipe);
  const Vec3d p{0.31, 0.1, 0.05};
  const Vec3d g = field.gradient(p);
  const Vec3d step = 0.004 * normalized(Vec3d{1, 2, -1});
  EXPECT_NEAR(field.value(p + step) - field.value(p - step), dot(g, 2.0 * step), 2e-4);
}

std::string refusal_text(const Recipe& recipe) {
  return testing::refusal_text([&] { const ImplicitField field(recipe, "r.json"); });
}

// Where no metaball reaches, s is a finite number. Greater heights would make all space matter.
TEST(ImplicitField, HeightsThatWouldFillSpaceAreRefused) {
  Recipe recipe = sphere_recipe(100.0);
  recipe.layers = {fractal_layer(1.0, 0.01, 1), fractal_layer(1e9, 0.01, 1), fractal_layer(1.0, 0.01, 1)};
  EXPECT_EQ(refusal_text(recipe).rfind("r.json: layers[1].amplitude: heights of up to 1e+09", 0), 0u)
      << refusal_text(recipe);
  recipe.layers = {gabor_layer(1.0, 1e9)};
  EXPECT_EQ(refusal_text(recipe).rfind("r.json: layers[0].height_rms: ", 0), 0u) << refusal_text(recipe);
  FractalLayer blended = fractal_layer(1.0, 0.01, 1);
  blended.use.combination = {Combine::kBlend, 1e9, false, {}};
  recipe.layers = {blended};
  EXPECT_EQ(refusal_text(recipe).rfind("r.json: layers[0].combine.width: ", 0), 0u) << refusal_text(recipe);
}

// Just below the limit all of the field beyond the metaballs is outside, by value and by bounds.
TEST(ImplicitField, HeightsBelowTheLimitLeaveSpaceEmpty) {
  for (const Kernel kernel : kKernels) {
    for (const bool combined : {false, true}) {
      Recipe recipe = sphere_recipe(1.0);
      recipe.body->kernel = kernel;
      if (combined) {
        BodyOperation operation;
        operation.operand.push_back(*recipe.body);
        recipe.body->operations.push_back(operation);
      }
      recipe.layers = {fractal_layer(1e9, 1.0, 1)};
      const std::string refusal = refusal_text(recipe);
      ASSERT_NE(refusal, "no error") << kernel_word(kernel);
      const double limit = std::stod(refusal.substr(refusal.rfind(' ')));  // of three digits
      EXPECT_GT(limit, 100.0) << "radii";
      recipe.layers = {fractal_layer(0.99 * limit, 1.0, 1)};
      const ImplicitField field(recipe);
      const Box far{{8, 8, 8}, {9, 9, 9}};
      EXPECT_EQ(field.gather(far).content(), BlockContent::kOutside) << kernel_word(kernel);
      EXPECT_LT(field.value(far.min), 0.0);
    }
  }
}

TEST(ImplicitField, BoundsHoldTheSurfaceTightly) {
  for (const double amplitude : {0.0, 0.03}) {
    Recipe recipe = potato_recipe(100, 12);
    if (amplitude > 0) recipe.layers = {fractal_layer(amplitude, 3.0, 6)};
    const ImplicitField field(recipe);
    const Box bounds = field.bounds();
    const Vec3d margin{0.5, 0.5, 0.5};
    const Box wide{bounds.min - margin, bounds.max + margin};
    CounterRandom random(3);
    Box seen;
    for (int i = 0; i < 100000; ++i) {
      const Vec3d p = random_point(random, wide);
      if (field.inside(p)) seen.extend(p);
    }
    EXPECT_GE(seen.min.x, bounds.min.x);
    EXPECT_LE(seen.max.x, bounds.max.x);
    EXPECT_GE(seen.min.z, bounds.min.z);
    EXPECT_LE(seen.max.z, bounds.max.z);
    EXPECT_LT(bounds.diagonal(), seen.diagonal() * 1.06 + 7 * field.height_bound());
  }
}

TEST(ImplicitField, AWarpedBodyIsTheBodyAtWarpedCoordinates) {
  Recipe recipe = sphere_recipe(1.0);
  recipe.body->warp = Warp{0.4, 1.1, 2, 0.5, 2.0};
  const ImplicitField field(recipe);
  const Box bounds = field.bounds();
  CounterRandom random(4);
  int inside = 0, warped_out = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3d p = random_point(random, testing::cube_about_origin(2));
    if (!field.inside(p)) {
      warped_out += norm(p) < 1.0;
      continue;
    }
    ++inside;
    ASSERT_LT(norm(p), 1.0 + std::sqrt(3.0) * 0.6);
    ASSERT_TRUE(p.x >= bounds.min.x && p.y >= bounds.min.y && p.z >= bounds.min.z);
    ASSERT_TRUE(p.x <= bounds.max.x && p.y <= bounds.max.y && p.z <= bounds.max.z);
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(warped_out, 50);
  const Vec3d p{0.5, 0.3, 0.1}, step{0, 0, 0.003};
  EXPECT_NEAR(field.value(p + step) - field.value(p - step), dot(field.gradient(p), 2.0 * step), 1e-4);
}

TEST(ImplicitField, ABodyThatTheIsoValueErasesHasNoBounds) {
  Recipe recipe = sphere_recipe(1.0);
  recipe.body->iso_value = 100.0;
  const ImplicitField field(recipe);
  EXPECT_TRUE(field.bounds().empty());
  EXPECT_FALSE(field.inside({0, 0, 0}));
  EXPECT_TRUE(std::isfinite(norm(field.gradient({0.1, 0, 0}))));
}

TEST(ImplicitField, NeedsABody) { EXPECT_THROW(ImplicitField(Recipe{}), InputError); }

TEST(FieldBlock, OutsideTheBandOnlySignsAreKept) {
  Recipe recipe = potato_recipe(40, 6);
  recipe.layers = {fractal_layer(0.01, 5.0, 3), gabor_layer(0.02, 0.002)};
  const ImplicitField field(recipe);
  const Box box = field.bounds();
  const FieldBlock block = field.gather(box);
  CounterRandom random(8);
  std::vector<float> exact(3000), coarse(3000);
  const auto [x, y, z] = testing::FloatPoints(random, box, exact.size());
  constexpr float kBand = 0.01f;
  block.evaluate(x, y, z, exact);
  block.evaluate(x, y, z, coarse, kBand);
  int different = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (exact[i] == coarse[i]) continue;
    ++different;
    ASSERT_GT(std::fabs(exact[i]), kBand);
    ASSERT_GT(std::fabs(coarse[i]), kBand);
    ASSERT_EQ(exact[i] > 0.0f, coarse[i] > 0.0f);
  }
  EXPECT_GT(different, 1000);
}

// The number of blocks of 8^3 cells that are called mixed, over the number of blocks that hold both signs, in
// a grid of 128^3 cells.
double mixed_over_active(const Recipe& recipe) {
  const ImplicitField field(recipe);
  const Box bounds = field.bounds();
  const Vec3d e = bounds.extent();
  constexpr int kBlocks = 16, kCells = 8;
  const double h = std::max({e.x, e.y, e.z}) / (kBlocks * kCells);
  int mixed = 0, active = 0;
  for (int b = 0; b < kBlocks * kBlocks * kBlocks; ++b) {
    const Vec3d corner = bounds.min + 8 * h * Vec3d{double(b % 16), double(b / 16 % 16), double(b / 256)};
    const Box box{corner, corner + Vec3d{8 * h, 8 * h, 8 * h}};
    const FieldBlock block = field.gather(box);
    if (block.content() != BlockContent::kMixed) continue;
    ++mixed;
    std::vector<float> value(9 * 9 * 9);
    testing::FloatPoints p;
    for (int i = 0; i < 729; ++i) p.add(corner + h * Vec3d{double(i % 9), double(i / 9 % 9), double(i / 81)});
    block.evaluate(p.x, p.y, p.z, value);
    const auto positive = std::count_if(value.begin(), value.end(), [](float f) { return f > 0; });
    active += positive > 0 && positive < 729;
  }
  return static_cast<double>(mixed) / active;
}

TEST(FieldBlock, ContentIsUseful) {
  Recipe recipe = potato_recipe(200, 21);
  const double bare = mixed_over_active(recipe);
  recipe.layers = {fractal_layer(0.004, 8.0, 8)};
  const double rough = mixed_over_active(recipe);
  std::printf("blocks called mixed over blocks that are: %.3f bare, %.3f rough\n", bare, rough);
  EXPECT_LT(bare, 1.5);
  EXPECT_LT(rough, 1.5);
}

}  // namespace
}  // namespace astrolith
