#include "synthesis/exemplar/phase_tile.h"

#include <complex>
#include <numbers>
#include <numeric>

#include "numerics/parallel_for.h"
#include "synthesis/exemplar/plane_waves.h"
#include "synthesis/exemplar/tiled_gabor_noise.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_model_internal.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

using testing::sphere_recipe;

// A photo's lobes: wide ones, narrow ones at low frequencies, and one that is too narrow for any tile.
GaborLayer photo_layer(double pixel_size, bool with_narrow = true) {
  GaborLayer layer;
  layer.pixel_size = pixel_size;
  layer.height_rms = 1.0;
  layer.evaluation = GaborEvaluation::kTiles;
  layer.lobes = {{2, 0.1, 0.05, 1.0}, {3, 0.0, 0.08, 2.0}, {4, -0.05, 0.02, 1.0}, {7, 0.0, 0.0, 1.0}};
  if (with_narrow) layer.lobes.push_back({12, 0.3, 0.4, 0.5});
  return layer;
}

double kernel_width_of(int bandwidth) {
  return std::ldexp(std::sqrt(std::numbers::pi / (2.0 * std::log(2.0))), -bandwidth);
}

// A ball under one tiled layer, and the noise of that layer.
struct TiledBall {
  Recipe recipe;
  ImplicitField field;
  const TiledGaborNoise& noise;

  TiledBall(const GaborLayer& layer, double radius)
      : recipe(recipe_of(layer, radius)),
        field(recipe),
        noise(*field.tables().layers[0].noise.get_if<TiledGaborNoise>()) {}
  static Recipe recipe_of(const GaborLayer& layer, double radius) {
    Recipe recipe = sphere_recipe(radius);
    recipe.layers = {layer};
    return recipe;
  }
  // The tiles alone.
  float at(const Vec3d& p) const { return with_phase_tiles(noise, field.tables().arrays, to_float(p), 0.0f); }
};

Vec3d drawn_direction(CounterRandom& random) {
  return normalized(Vec3d{random.normal(), random.normal(), random.normal()});
}

TEST(PhaseTiles, HoldWideLobesOnly) {
  const PhaseTilePlan plan = plan_phase_tiles(photo_layer(1.0).lobes);
  ASSERT_EQ(plan.narrow.size(), 1u);
  EXPECT_EQ(plan.narrow[0].bandwidth, 12);
  std::size_t lobes = 0;
  for (const PhaseTile& tile : plan.tiles) {
    lobes += tile.lobes.size();
    EXPECT_GE(tile.side, kLeastPhaseTile);
    EXPECT_LE(tile.side, kMostPhaseTile);
    for (const GaborLobe& lobe : tile.lobes) {
      const double a = kernel_width_of(lobe.bandwidth), deviation = a / (2 * std::sqrt(std::numbers::pi));
      EXPECT_GE(a * tile.spacing(), kLeastTileWidth * (1 - 1e-12));
      const double frequency = std::max(std::fabs(lobe.frequency_x), std::fabs(lobe.frequency_y));
      EXPECT_LE((frequency + 2 * deviation) * tile.pixel, 0.3 * (1 + 1e-12));
    }
  }
  EXPECT_EQ(lobes, 4u);
}

// Lobes of all bandwidths and frequencies: no more tiles than allowed, and no lobe is lost.
TEST(PhaseTiles, AreAtMostThree) {
  std::vector<GaborLobe> lobes;
  for (int bandwidth = 1; bandwidth <= 12; ++bandwidth) {
    for (const double f : {0.0, 0.001, 0.01, 0.1, 0.5}) lobes.push_back({bandwidth, f, -f, 1.0});
  }
  const PhaseTilePlan plan = plan_phase_tiles(lobes);
  EXPECT_EQ(plan.tiles.size(), static_cast<std::size_t>(kMostPhaseTiles));
  std::size_t count = plan.narrow.size();
  for (const PhaseTile& tile : plan.tiles) count += tile.lobes.size();
  EXPECT_EQ(count, lobes.size());
}

TEST(PlaneWaves, AreTheFourierSeries) {
  constexpr int kSide = 8;
  CounterRandom random(3);
  std::vector<std::complex<double>> waves;
  for (int i = 0; i < kSide * kSide; ++i) waves.emplace_back(random.normal(), random.normal());
  std::vector<std::complex<double>> sums = waves;
  sum_plane_waves(kSide, sums);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      std::complex<double> sum = 0.0;
      for (int l = 0; l < kSide; ++l) {
        for (int k = 0; k < kSide; ++k) {
          sum += waves[static_cast<std::size_t>(l * kSide + k)] *
                 std::polar(1.0, 2 * std::numbers::pi * (k * x + l * y) / kSide);
        }
      }
      EXPECT_NEAR(std::abs(sum - sums[static_cast<std::size_t>(y * kSide + x)]), 0.0, 1e-12);
    }
  }
}

TEST(PhaseTiles, HaveThePowerOfTheirLobes) {
  for (const PhaseTile& tile : plan_phase_tiles(photo_layer(1.0).lobes).tiles) {
    const std::vector<double> power = tile_power(tile);
    EXPECT_NEAR(std::accumulate(power.begin(), power.end(), 0.0), 1.0, 1e-12);
    EXPECT_EQ(power[0], 0.0);
    const auto side = static_cast<std::size_t>(tile.side);
    for (std::size_t y = 1; y < side; y += 7) {
      for (std::size_t x = 1; x < side; x += 5) {
        EXPECT_NEAR(power[y * side + x], power[(side - y) * side + side - x], 1e-15);
      }
    }
    const std::vector<double> texture = random_phase_tile(tile, 5);
    double square = 0.0;
    for (const double value : texture) square += value * value / static_cast<double>(texture.size());
    EXPECT_NEAR(square, 1.0, 0.25);  // spline coefficients are a little larger than the values
    EXPECT_GE(square, 1.0);
  }
}

// Pairs of points at the same distance in all directions: how much of their weights they share.
TEST(PhaseTiles, KnowTheBlurOfTheAnchors) {
  const ExemplarLattice lattice = exemplar_cells(Box{{0, 0, 0}, {8, 8, 8}}, {1, 1, 1}).lattice;
  const double spacing = 1.0 / 1.25992104989487316477;  // of the anchors, in edges of a cell
  struct Corners {
    float weight[4];
    Vec3d anchor[4];
  };
  const auto corners_at = [&](const Vec3d& p) {
    ExemplarPlace place =
        exemplar_place(lattice, static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
    sharpen_weights(kPhaseTileExponent, place.weight);
    Corners corners{};
    for (int c = 0; c < 4; ++c) {
      const ExemplarCorner step = exemplar_corner(c, place.order);
      corners.weight[c] = place.weight[c];
      corners.anchor[c] =
          p -
          Vec3d{static_cast<double>(place.x), static_cast<double>(place.y), static_cast<double>(place.z)} +
          0.5 * Vec3d{double(step.x), double(step.y), double(step.z)};
    }
    return corners;
  };
  CounterRandom random(7);
  double shared = 0.0;
  constexpr int kPairs = 200000;
  for (int i = 0; i < kPairs; ++i) {
    const Vec3d p{random.uniform(2, 6), random.uniform(2, 6), random.uniform(2, 6)};
    const Corners a = corners_at(p), b = corners_at(p + 0.2 * spacing * drawn_direction(random));
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 4; ++k) {
        if (norm(a.anchor[j] - b.anchor[k]) < 1e-3) {
          shared += static_cast<double>(a.weight[j]) * static_cast<double>(b.weight[k]) / kPairs;
        }
      }
    }
  }
  const double blur = std::sqrt(-std::log(shared) / (2.0 * std::pow(0.2 * std::numbers::pi, 2)));
  EXPECT_NEAR(blur, kPhaseTileBlur, 0.01);
}

// Variance and covariance over a ball are those of the lobes.
TEST(TiledGaborNoise, HasTheCovarianceOfItsLobesOnABall) {
  GaborLayer layer = photo_layer(1.0, false);
  layer.lobes.back().bandwidth = 5;  // whose anchors stand close for a ball of this size
  double total = 0.0;
  for (const GaborLobe& lobe : layer.lobes) total += lobe.variance;
  const double radius = 1500.0;
  const TiledBall ball(layer, radius);
  ASSERT_EQ(ball.noise.detail.left_out, 0.0);
  ASSERT_EQ(ball.noise.narrow.bands.count, 0u);
  CounterRandom random(9);
  constexpr int kPairs =
      60000;  // a standard error of at most sqrt(2 / 60000) = .006, a fifth of what is allowed
  for (const double lag : {0.0, 2.0, 5.0, 10.0}) {
    double covariance = 0.0, expected = 0.0;
    for (int i = 0; i < kPairs; ++i) {
      Vec3d n = drawn_direction(random);
      n.z *= 0.5;  // away from the poles, where east turns
      n = normalized(n);
      const Vec3d east = normalized(cross(Vec3d{0, 0, 1}, n));
      const Vec3d p = radius * n, q = radius * normalized(p + lag * east);
      covariance += static_cast<double>(ball.at(p)) * static_cast<double>(ball.at(q)) / kPairs;
    }
    for (const GaborLobe& lobe : layer.lobes) {
      const double a = kernel_width_of(lobe.bandwidth);
      expected += lobe.variance / total * std::exp(-0.5 * std::numbers::pi * a * a * lag * lag) *
                  std::cos(2 * std::numbers::pi * lobe.frequency_x * lag);
    }
    EXPECT_NEAR(covariance, expected, 0.03) << lag;
  }
}

// Heights lie within six standard deviations, and neighbours differ in proportion to their distance.
TEST(TiledGaborNoise, IsBoundedAndHasNoJumps) {
  const double pixel = 0.01;
  const TiledBall ball(photo_layer(pixel, false), 10.0);
  EXPECT_DOUBLE_EQ(ball.noise.height_bound, 6.0);
  const auto largest_jump = [&](double step) {
    CounterRandom random(13);
    double largest = 0.0;
    for (int i = 0; i < 60000; ++i) {
      const Vec3d p = drawn_direction(random),
                  q = normalized(p + 0.1 * step * pixel * normalized(cross(p, drawn_direction(random))));
      const double here = static_cast<double>(ball.at(10.0 * p));
      EXPECT_LE(std::fabs(here), 6.0);
      largest = std::max(largest, std::fabs(here - static_cast<double>(ball.at(10.0 * q))));
    }
    return largest;
  };
  const double whole = largest_jump(1.0);
  for (const double step : {0.25, 0x1p-4, 0x1p-6}) {
    EXPECT_LT(largest_jump(step), 2.5 * step * whole + 5e-3) << step;
  }
}

}  // namespace
}  // namespace astrolith
