#include "synthesis/finish/lay_on_base.h"

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/noise/fractal_noise.h"
#include "synthesis/relief/relief_noise.h"
#include "tests/support/refusal.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/reliefs.h"

namespace astrolith {
namespace {

Recipe in_unit(std::string unit) {
  Recipe recipe;
  recipe.length_unit = std::move(unit);
  return recipe;
}

Recipe ball(const std::string& unit, double radius) {
  Recipe recipe = in_unit(unit);
  recipe.body = MetaballBody{};
  recipe.body->spheres = {{{0, 0, 0}, radius}};
  return recipe;
}

Recipe bumps(const std::string& unit, double scale) {
  Recipe recipe = in_unit(unit);
  FractalLayer layer;
  layer.amplitude = 10.0 * scale;
  layer.frequency = 0.01 / scale;
  layer.octaves = 3;
  layer.bias = Vec3d{5, 6, 7} * scale;
  recipe.layers = {layer};
  return recipe;
}

TEST(LayOnBase, LengthsInAnotherUnitMeanTheSameSurface) {
  const ImplicitField in_km(lay_on_base(bumps("m", 1.0), "bumps", ball("km", 0.25), "ball"));
  const ImplicitField native(lay_on_base(bumps("km", 1e-3), "bumps", ball("km", 0.25), "ball"));
  for (const Vec3d& p : {Vec3d{0.25, 0, 0}, Vec3d{0.1, -0.2, 0.05}, Vec3d{0, 0.15, 0.2}}) {
    EXPECT_NEAR(in_km.value(p), native.value(p), 1e-6);
    EXPECT_NE(in_km.value(p), ImplicitField(ball("km", 0.25)).value(p));
  }
}

TEST(LayOnBase, KeepsTheBaseAndAddsLayersAfterItsOwn) {
  Recipe base = bumps("m", 1.0);
  base.body = ball("m", 100.0).body;
  base.seed = 77;
  const Recipe result = lay_on_base(bumps("m", 0.1), "bumps", base, "base");
  ASSERT_EQ(result.layers.size(), 2u);
  EXPECT_EQ(std::get<FractalLayer>(result.layers[0]).amplitude, 10.0);
  EXPECT_DOUBLE_EQ(std::get<FractalLayer>(result.layers[1]).amplitude, 1.0);
  EXPECT_EQ(result.seed, 77u);
}

TEST(LayOnBase, GaborLayersKeepTheirShape) {
  Recipe details = in_unit("m");
  GaborLayer layer;
  layer.pixel_size = 0.5;
  layer.height_rms = 2.0;
  details.layers = {layer};
  const auto converted =
      std::get<GaborLayer>(lay_on_base(details, "rock", ball("km", 1.0), "ball").layers.front());
  EXPECT_DOUBLE_EQ(converted.pixel_size, 0.5e-3);
  EXPECT_DOUBLE_EQ(converted.height_rms, 2e-3);
}

TEST(LayOnBase, LengthsOfALayersUseAreConverted) {
  Recipe details = bumps("m", 1.0);
  LayerUse& use = *find_use(details.layers.front());
  use.locality = Locality{"head", 3.0};
  use.mask = LayerMask{"hills", 1.0, 2.0};
  use.combination.width = 4.0;
  const Recipe result = lay_on_base(details, "bumps", ball("km", 1.0), "ball");
  const LayerUse& converted = *find_use(result.layers.front());
  EXPECT_DOUBLE_EQ(converted.locality->width, 3e-3);
  EXPECT_DOUBLE_EQ(converted.mask->from, 1e-3);
  EXPECT_DOUBLE_EQ(converted.mask->to, 2e-3);
  EXPECT_DOUBLE_EQ(converted.combination.width, 4e-3);
}

TEST(LayOnBase, PixelsAndMissingBodiesAreErrorsThatNameTheFile) {
  EXPECT_TRUE(testing::has(testing::refusal_text([&] {
                             lay_on_base(bumps("px", 1.0), "rock.json", ball("km", 1.0), "ball.json");
                           }),
                           "rock.json: length_unit"));
  EXPECT_THROW(lay_on_base(bumps("m", 1.0), "a", bumps("m", 1.0), "b"), InputError);
}

// The measured body goes with its heights, in the unit of the base.
TEST(LayOnBase, ReliefsAreDrawnFromTheBodyThatWasMeasured) {
  Recipe measured = ball("km", 1.0);
  ReliefLayer heights = testing::relief_layer(measured, 0.05, -0.02, 0.02,
                                              [](const Vec3d& p) { return 0.01 * std::sin(40.0 * p.x); });
  heights.edge = 0.04;
  measured.layers = {heights};
  const Recipe laid = lay_on_base(measured, "measured", ball("m", 700.0), "base");
  const auto& relief = std::get<ReliefLayer>(laid.layers.back());
  EXPECT_EQ(relief.arrangement, ReliefArrangement::kLaid);
  ASSERT_TRUE(relief.donor);
  EXPECT_EQ(relief.donor->spheres[0].radius, 1.0);  // the donor keeps its unit
  EXPECT_EQ(relief.donor_scale, 1000.0);
  EXPECT_EQ(relief.spacing, 0.05);
  EXPECT_EQ(relief.edge, 0.04);
  const ImplicitField bare(ball("m", 700.0)), field(laid);
  double least = 0.0, most = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double height = field.value({7.0 * i, std::sqrt(700.0 * 700.0 - 49.0 * i * i), 0.0}) -
                          bare.value({7.0 * i, std::sqrt(700.0 * 700.0 - 49.0 * i * i), 0.0});
    least = std::min(least, height), most = std::max(most, height);
  }
  EXPECT_LT(least, -4.0);
  EXPECT_GT(most, 4.0);
  Recipe speck = ball("m", 1.0);
  speck.body->spheres[0].center = {20.0, 20.0, 20.0};
  EXPECT_TRUE(ImplicitField(lay_on_base(measured, "measured", speck, "base")).inside({20.0, 20.0, 20.0}));
}

TEST(LayOnBase, DrawnHeightsBecomeOnesOwn) {
  Recipe measured = ball("km", 1.0);
  ReliefLayer heights = testing::relief_layer(measured, 0.05, -0.02, 0.02,
                                              [](const Vec3d& p) { return 0.01 * std::sin(40.0 * p.x); });
  heights.edge = 0.04;
  measured.layers = {heights};
  const Recipe laid = lay_on_base(measured, "measured", ball("m", 700.0), "base");
  const Recipe own = with_own_heights(laid, "laid");
  const auto& relief = std::get<ReliefLayer>(own.layers.back());
  EXPECT_EQ(relief.arrangement, ReliefArrangement::kMeasured);
  EXPECT_FALSE(relief.donor);
  EXPECT_EQ(relief.spacing, 50.0);
  EXPECT_EQ(relief.edge, 40.0);
  const ImplicitField drawn(laid), kept(own);
  for (int i = 0; i < 100; ++i) {
    const Vec3d p{7.0 * i, std::sqrt(700.0 * 700.0 - 49.0 * i * i), 0.0};
    EXPECT_EQ(kept.value(p), drawn.value(p));
  }
  EXPECT_EQ(testing::refusal_text([&] { with_own_heights(measured, "file"); }),
            "file: layers: no relief draws its heights; add --like, --laid or --fill-unseen");
}

TEST(LayOnBase, NarrowWavesOfAReliefAreRoughness) {
  const Recipe measured = ball("km", 1.0);
  const auto roughness = [&](double waves) {
    const ReliefLayer heights = testing::relief_layer(
        measured, 0.02, -0.02, 0.02, [&](const Vec3d& p) { return 0.01 * std::sin(waves * p.x); });
    ArrayStore arrays;
    const BodyTables body = make_body(*measured.body, 1, arrays);
    const ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
    return relief_roughness(heights, {measured, 0, "test"}, {body, arrays.view(), metaballs.lists()}, 0.05);
  };
  EXPECT_NEAR(roughness(60.0), 0.01 / std::sqrt(2.0), 1.5e-3);
  EXPECT_LT(roughness(2.0), 1e-4);
}

// A ball under a relief of edges of this share of its radius.
Recipe measured_ball(double radius, double edge) {
  Recipe measured = ball("m", radius);
  ReliefLayer heights =
      testing::relief_layer(measured, radius * edge, -0.02 * radius, 0.02 * radius,
                            [&](const Vec3d& p) { return 0.01 * std::sin(40.0 * p.x / radius); });
  heights.edge = radius * edge;
  measured.layers = {heights};
  return measured;
}

TEST(LayOnBase, KeepsSharesOfTheBodyOrEdgesOfTheModel) {
  const Recipe details = measured_ball(2.0, 0.05), base = measured_ball(10.0, 0.1);
  const auto edge_by = [&](const char* lengths) {
    const Recipe laid = lay_on_base(details, "details", base, "base", parse_base_lengths(lengths));
    EXPECT_EQ(laid.layers.size(), 1u);  // the base's own relief is gone
    const auto& relief = std::get<ReliefLayer>(laid.layers.back());
    EXPECT_FALSE(ImplicitField(laid).bounds().empty());  // its places are found again
    return relief.donor_scale * relief.edge;
  };
  EXPECT_DOUBLE_EQ(edge_by("units"), 0.1);
  EXPECT_NEAR(edge_by("body"), 0.5, 1e-3);
  EXPECT_DOUBLE_EQ(edge_by("edges"), 1.0);
  const auto refused = [&](const Recipe& layers, const char* lengths) {
    return testing::refusal_text(
        [&] { lay_on_base(layers, "details", ball("m", 1.0), "base", parse_base_lengths(lengths)); });
  };
  EXPECT_TRUE(testing::has(refused(details, "edges"), "base: layers: hold no relief"));
  EXPECT_TRUE(testing::has(refused(bumps("m", 1.0), "body"), "details: body: absent"));
  EXPECT_TRUE(testing::has(refused(details, "feet"), "must be units, body or edges"));
}

TEST(LayOnBase, AlbedoIsThatOfTheBaseOrElseOfTheLayers) {
  Recipe base = testing::sphere_recipe(1.0), details;
  base.length_unit = "km";
  details.length_unit = "m";
  details.albedo = GroundAlbedo{0.2, {1, 1, 1}, 1.0, AlbedoByElevation{0.0, -50.0, 0.5}};
  FractalLayer dust = testing::fractal_layer(1.0, 0.1, 1);
  dust.use.albedo = LayerAlbedo{.contrast = 0.5};
  details.layers = {dust};
  const auto laid = [&] { return lay_on_base(details, "d", base, "b", BaseLengths::kUnits); };
  EXPECT_EQ(laid().albedo->normal, 0.2);
  EXPECT_NEAR(laid().albedo->elevation->to, -0.05, 1e-12);
  base.albedo = GroundAlbedo{0.04};
  EXPECT_EQ(laid().albedo->normal, 0.04);
}

}  // namespace
}  // namespace astrolith
