#include "synthesis/exemplar/exemplar_noise.h"

#include "geometry/mesh_topology.h"
#include "numerics/parallel_for.h"
#include "synthesis/exemplar/plane_exemplar.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_model_internal.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/exemplars.h"

namespace astrolith {
namespace {

using testing::exemplar_layer;
using testing::random_direction;
using testing::sphere_recipe;

// A ball under an exemplar layer, and the noise of that layer.
struct Ball {
  ImplicitField field;
  const ExemplarNoise& noise;

  Ball(const ExemplarLayer& layer, double radius)
      : field(make_recipe(layer, radius)), noise(*field.tables().layers[0].noise.get_if<ExemplarNoise>()) {}
  static Recipe make_recipe(const ExemplarLayer& layer, double radius) {
    Recipe recipe = sphere_recipe(radius);
    recipe.layers = {layer};
    return recipe;
  }
  float at(const Vec3f& p) const { return height_at(noise, field.tables().arrays, p); }
};

// The corners of a point's tetrahedron, weighted, give the point back, and every corner is an anchor's place.
TEST(ExemplarAnchors, WeightsAreBarycentric) {
  const ExemplarCells cells = exemplar_cells(Box{{-3, -4, -5}, {5, 4, 3}}, {0.7, 0.7, 0.7});
  ASSERT_LE(cells.anchors, kMostExemplarAnchors);
  CounterRandom random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3f p = to_float(testing::random_point(random, {{-3, -4, -5}, {5, 4, 3}}));
    const ExemplarPlace place = exemplar_place(cells.lattice, p.x, p.y, p.z);
    double sum = 0.0, x = 0.0, y = 0.0, z = 0.0;
    for (int c = 0; c < 4; ++c) {
      const ExemplarCorner corner = exemplar_corner(c, place.order);
      const double w = static_cast<double>(place.weight[c]);
      ASSERT_GE(w, 0.0);
      sum += w;
      x += 0.5 * w * corner.x;
      y += 0.5 * w * corner.y;
      z += 0.5 * w * corner.z;
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
    EXPECT_NEAR(x, static_cast<double>(place.x), 1e-5);
    EXPECT_NEAR(y, static_cast<double>(place.y), 1e-5);
    EXPECT_NEAR(z, static_cast<double>(place.z), 1e-5);
    const std::int32_t cell = place.anchor / 2;
    const ExemplarLattice& l = cells.lattice;
    const double ax = l.low[0] + cell % l.size[0] + 0.5 * (place.anchor & 1);
    EXPECT_NEAR(static_cast<double>(p.x) / 0.7, ax + static_cast<double>(place.x), 1e-4);
  }
}

TEST(ExemplarNoise, StaysWithinItsBounds) {
  ExemplarLayer layer = exemplar_layer(0.01, 0.0);
  layer.height_range = -0.02;
  const Ball ball(layer, 1.0);
  const Interval bound = bound_heights(ball.noise, ball.field.tables().arrays, {});
  EXPECT_NEAR(bound.high - bound.low, 0.02 * 0.9, 0.004);
  CounterRandom random(11);
  double lowest = 0.0, highest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double h = static_cast<double>(ball.at(to_float(random_direction(random))));
    lowest = std::min(lowest, h), highest = std::max(highest, h);
  }
  EXPECT_GE(lowest, bound.low);
  EXPECT_LE(highest, bound.high);
  EXPECT_GT(highest - lowest, 0.7 * (bound.high - bound.low));
}

// The largest difference between neighbours is proportional to their distance from 1 to 1/64 pixel, also
// about the poles, where the frames of anchors turn.
TEST(ExemplarNoise, HasNoJumps) {
  const double pixel = 0.01;
  const Ball ball(exemplar_layer(pixel, 1.0), 1.0);
  const auto largest_jump = [&](double step, bool polar) {
    CounterRandom random(13);
    double largest = 0.0;
    for (int i = 0; i < 60000; ++i) {
      Vec3d p = random_direction(random);
      if (polar) p = normalized(Vec3d{0.05 * p.x, 0.05 * p.y, 1.0});
      const Vec3d q = normalized(p + step * pixel * normalized(cross(p, random_direction(random))));
      largest = std::max(largest, std::fabs(static_cast<double>(ball.at(to_float(p))) -
                                            static_cast<double>(ball.at(to_float(q)))));
    }
    return largest;
  };
  for (const bool polar : {false, true}) {
    const double whole = largest_jump(1.0, polar);
    for (const double step : {0.25, 0x1p-4, 0x1p-6}) {
      EXPECT_LT(largest_jump(step, polar), 2.5 * step * whole + 2e-3) << step << " " << polar;
    }
  }
}

// The deviation and the share of values below quantiles are those of a plane.
TEST(ExemplarNoise, HasThePlanesValuesOnABall) {
  const Ball ball(exemplar_layer(0.005, 1.0), 1.0);
  CounterRandom random(17);
  std::vector<float> on_ball, on_plane = synthesize_exemplar(exemplar_layer(1.0, 1.0), "r", 900, 900, {});
  double square = 0.0;
  for (int i = 0; i < 200000; ++i) {
    on_ball.push_back(ball.at(to_float(random_direction(random))));
    square += std::pow(static_cast<double>(on_ball.back()), 2) / 200000.0;
  }
  EXPECT_NEAR(square, 1.0, 0.03);
  std::sort(on_ball.begin(), on_ball.end());
  std::sort(on_plane.begin(), on_plane.end());
  for (const double share : {0.05, 0.25, 0.5, 0.75, 0.95}) {
    const auto at = [share](const std::vector<float>& v) {
      return v[static_cast<std::size_t>(share * static_cast<double>(v.size()))];
    };
    EXPECT_NEAR(at(on_ball), at(on_plane), 0.06) << share;
  }
}

// Metaballs reach far beyond the surface; anchors need not.
TEST(ExemplarNoise, IsKeptOnABodyFiftyImagesWide) {
  const Recipe recipe = Ball::make_recipe(exemplar_layer(5e-4, 1e-4), 1.0);
  const ImplicitField whole(recipe);
  EXPECT_TRUE(whole.left_out().empty());
  const Vec3d center{1.0, 0.0, 0.0};
  const ImplicitField patch(recipe, "r", PatchCube{center, 0.02});
  CounterRandom random(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3d p = normalized(center + 0.008 * Vec3d{0.0, random.normal(), random.normal()});
    ASSERT_NEAR(whole.value(p), patch.value(p), 2e-6);
  }
}

// A body more than 64 images wide has too many anchors. The layer is left out and reported; a patch has it.
TEST(ExemplarNoise, IsLeftOutWhereItsAnchorsAreTooMany) {
  const Recipe recipe = Ball::make_recipe(exemplar_layer(1e-4, 1e-4), 1.0);
  const ImplicitField whole(recipe);
  ASSERT_EQ(whole.left_out().size(), 1u);
  EXPECT_EQ(whole.left_out()[0].variance_share, 1.0);
  const Vec3d center{1.0, 0.0, 0.0};
  const ImplicitField patch(recipe, "r", PatchCube{center, 0.02});
  EXPECT_TRUE(patch.left_out().empty());
  ASSERT_TRUE(patch.has_patch_layers());
  const FieldBlock block = patch.gather({center - Vec3d{0.02, 0.02, 0.02}, center + Vec3d{0.02, 0.02, 0.02}});
  std::vector<float> x(400), y(400), z(400, 0.0f), bare(400), value(400);
  for (std::size_t i = 0; i < x.size(); ++i) y[i] = 2e-5f * static_cast<float>(i);
  const std::vector<float> at_patch = x;
  block.evaluate_local(center, x, y, z, value, kExactEverywhere);
  const ImplicitField ball(sphere_recipe(1.0), "r", PatchCube{center, 0.02});
  ball.gather(block.box()).evaluate_local(center, x, y, z, bare, kExactEverywhere);
  double square = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    square += std::pow(static_cast<double>(value[i] - bare[i]), 2) / 400.0;
  EXPECT_GT(std::sqrt(square), 0.4e-4);
  EXPECT_LT(std::sqrt(square), 2.5e-4);
}

TEST(ExemplarNoise, AddsNothingToOtherLayersWhereItIsLeftOut) {
  FractalLayer hill;
  hill.amplitude = 0.1;
  Recipe hills = sphere_recipe(1.0);
  hills.layers = {hill};
  Recipe both = hills;
  both.layers.emplace_back(exemplar_layer(1e-4, 1e-4));
  const Vec3d p{0.9, 0.3, 0.2};
  EXPECT_EQ(ImplicitField(both).value(p), ImplicitField(hills).value(p));
}

}  // namespace
}  // namespace astrolith
