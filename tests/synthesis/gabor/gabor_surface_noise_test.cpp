#include "synthesis/gabor/gabor_surface_noise.h"

#include <array>
#include <cmath>

#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/lone_gabor_noise.h"

namespace astrolith {
namespace {

using testing::potato_recipe;
using testing::sphere_recipe;

GaborLayer surface_layer(std::vector<GaborLobe> lobes, double pixel_size, double rms) {
  GaborLayer layer;
  layer.pixel_size = pixel_size;
  layer.height_rms = rms;
  layer.lobes = std::move(lobes);
  return layer;
}

// A square grid of points, `step` apart, on a sphere so large that the grid is flat. Columns run to the east,
// rows to the south.
struct FlatPatch {
  FlatPatch(int size, double step, double longitude, double latitude) : n(size) {
    const Vec3d up{std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                   std::sin(latitude)};
    const Vec3d east{-std::sin(longitude), std::cos(longitude), 0.0};
    const Vec3d south = cross(east, up);
    for (int i = 0; i < n * n; ++i) {
      const Vec3d p = normalized(up + step * (i % n) * east + step * (i / n) * south);
      px.push_back(static_cast<float>(p.x));
      py.push_back(static_cast<float>(p.y));
      pz.push_back(static_cast<float>(p.z));
    }
  }
  std::vector<float> heights(const GaborLayer& layer, std::uint64_t seed) const {
    Box domain;
    domain.extend({-2, -2, -2});
    domain.extend({2, 2, 2});
    const testing::LoneGaborNoise noise(layer, seed, 0, *sphere_recipe(1.0).body, domain);
    std::vector<float> h(px.size());
    noise.evaluate(n * n, px.data(), py.data(), pz.data(), h.data());
    return h;
  }

  int n;
  std::vector<float> px, py, pz;
};

TEST(GaborSurfaceNoise, FlatPatchHasTheVarianceAndTheSpectrumOfTheLobes) {
  // A pixel is 1/2000 of the radius. The many patches lie far apart; each has one or two kernels.
  const std::vector<GaborLobe> lobes = {{3, 0.12, 0.04, 3.0}, {2, -0.05, 0.2, 1.0}};
  const GaborLayer layer = surface_layer(lobes, 5e-4, 0.002);
  constexpr int n = 16, kPatches = 900, kLag = 3;
  std::array<double, (2 * kLag + 1) * (kLag + 1)> measured{};
  double fourth = 0.0;
  for (int k = 0; k < kPatches; ++k) {
    const FlatPatch patch(n, 5e-4, 0.2 * (k % 30), -1.2 + 0.08 * (k / 30));
    const std::vector<float> h = patch.heights(layer, 7);
    for (const float v : h) fourth += std::pow(static_cast<double>(v) / 0.002, 4) / (kPatches * n * n);
    std::size_t lag = 0;
    for (int dy = 0; dy <= kLag; ++dy) {
      for (int dx = -kLag; dx <= kLag; ++dx, ++lag) {
        double sum = 0.0;
        for (int y = 0; y < n - kLag; ++y) {
          for (int x = kLag; x < n - kLag; ++x) {
            sum += static_cast<double>(h[static_cast<std::size_t>(y * n + x)]) *
                   static_cast<double>(h[static_cast<std::size_t>((y + dy) * n + x + dx)]);
          }
        }
        measured[lag] += sum / ((n - kLag) * (n - 2 * kLag) * 0.002 * 0.002 * kPatches);
      }
    }
  }
  std::size_t lag = 0;
  for (int dy = 0; dy <= kLag; ++dy) {
    for (int dx = -kLag; dx <= kLag; ++dx, ++lag) {
      double expected = 0.0;
      for (const GaborLobe& lobe : lobes) {
        const double a = std::ldexp(std::sqrt(M_PI / (2 * std::log(2.0))), -lobe.bandwidth);
        expected += lobe.variance / 4.0 * std::exp(-M_PI * a * a * (dx * dx + dy * dy) / 2) *
                    std::cos(2 * M_PI * (lobe.frequency_x * dx + lobe.frequency_y * dy));
      }
      EXPECT_NEAR(measured[lag], expected, 0.03) << dx << " " << dy;
    }
  }
  EXPECT_NEAR(fourth / 3.0, 1.0, 0.05);
}

TEST(GaborSurfaceNoise, SmallAndLargeKernelsGiveTheBitsOfSinglePoints) {
  // Half of the points lie close together, so that many share an impulse. Kernels measure 1/400 to 1/10 of
  // the body.
  Recipe recipe = potato_recipe(60, 5);
  recipe.layers = {
      surface_layer({{1, 0.1, 0.2, 1.0}, {3, 0.1, 0.1, 1.0}, {6, -0.01, 0.02, 2.0}}, 0.002, 0.004)};
  const ImplicitField field(recipe);
  CounterRandom random(3);
  const Vec3d center = field.bounds().center();
  std::vector<float> x, y, z, value(600);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double size = i % 2 ? 0.01 : 0.2;
    x.push_back(static_cast<float>(field.bounds().max.x - 0.05 + random.uniform(-size, size)));
    y.push_back(static_cast<float>(center.y + random.uniform(-size, size)));
    z.push_back(static_cast<float>(center.z + random.uniform(-size, size)));
  }
  field.gather(field.bounds()).evaluate(x, y, z, value);
  for (std::size_t i = 0; i < value.size(); i += 3) {
    ASSERT_EQ(static_cast<double>(value[i]), field.value({x[i], y[i], z[i]}));
  }
}

// The points lie in two places so far apart that the cells between them are not drawn. Their group is split.
TEST(GaborSurfaceNoise, AGroupInTwoPlacesGivesTheBitsOfSinglePoints) {
  const testing::LoneGaborNoise noise(surface_layer({{1, 0.1, 0.2, 1.0}}, 0.002, 1.0), 7, 0,
                                      *sphere_recipe(1.0).body, {{-2, -2, -2}, {2, 2, 2}});
  CounterRandom random(3);
  std::vector<float> x, y, z, height(11);
  for (std::size_t i = 0; i < height.size(); ++i) {
    const double side = i < 6 ? 0.5773 : -0.5773;
    for (auto* c : {&x, &y, &z}) c->push_back(static_cast<float>(side + random.uniform(-0.001, 0.001)));
  }
  noise.evaluate(11, x.data(), y.data(), z.data(), height.data());
  for (std::size_t i = 0; i < height.size(); ++i) {
    float alone = 0.0f;
    noise.evaluate(1, &x[i], &y[i], &z[i], &alone);
    EXPECT_EQ(height[i], alone) << i;
  }
  EXPECT_NE(height[0], 0.0f);
}

// The error falls as the square of the size, whether corners share their impulses or each corner draws its
// own.
TEST(GaborSurfaceNoise, TetrahedraAreTrueToFirstOrder) {
  const testing::LoneGaborNoise noise(surface_layer({{2, 0.1, 0.2, 1.0}, {4, -0.02, 0.05, 2.0}}, 0.01, 1.0),
                                      7, 0, *sphere_recipe(1.0).body, {{-2, -2, -2}, {2, 2, 2}});
  CounterRandom random(3);
  const auto largest_error = [&](double h, double spread) {
    std::vector<float> x, y, z, exact(240), linear(240);
    for (int i = 0; i < 60; ++i) {
      const Vec3d p = normalized(Vec3d{1.0, spread * random.normal(), spread * random.normal()});
      for (const Vec3d& k : {Vec3d{1, 1, 1}, Vec3d{1, -1, -1}, Vec3d{-1, 1, -1}, Vec3d{-1, -1, 1}}) {
        x.push_back(static_cast<float>(p.x + h * k.x));
        y.push_back(static_cast<float>(p.y + h * k.y));
        z.push_back(static_cast<float>(p.z + h * k.z));
      }
    }
    noise.evaluate(240, x.data(), y.data(), z.data(), exact.data());
    noise.evaluate_tetrahedra(240, x.data(), y.data(), z.data(), linear.data());
    float largest = 0.0f;
    for (std::size_t i = 0; i < 240; ++i) largest = std::max(largest, std::fabs(exact[i] - linear[i]));
    return largest;
  };
  for (const double spread : {0.01, 1.0}) {
    EXPECT_LT(largest_error(1e-3, spread), 0.2f);
    EXPECT_LT(largest_error(1e-4, spread), 4e-3f);
  }
}

TEST(GaborSurfaceNoise, HeightsAreConstantAlongTheNormal) {
  Recipe recipe = sphere_recipe(1.0);
  recipe.layers = {surface_layer({{3, 0.1, 0.05, 1.0}}, 0.02, 0.01)};
  const ImplicitField field(recipe), bare(sphere_recipe(1.0));
  CounterRandom random(4);
  double sum_squares = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Vec3d out = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    const double height = field.value(out);
    sum_squares += height * height / 200;
    // The first-order projection from 0.02 away errs by about 0.02^2.
    EXPECT_NEAR(field.value(1.02 * out) - bare.value(1.02 * out), height, 2e-3);
    EXPECT_NEAR(field.value(0.98 * out) - bare.value(0.98 * out), height, 2e-3);
    EXPECT_LE(std::fabs(height), field.height_bound() + 1e-6);
  }
  EXPECT_NEAR(std::sqrt(sum_squares), 0.01, 0.0015);
}

TEST(GaborSurfaceNoise, IsSmoothEverywhereEvenAtThePoles) {
  Recipe recipe = sphere_recipe(1.0);
  recipe.layers = {surface_layer({{3, 0.1, 0.05, 1.0}}, 0.02, 0.01)};
  const ImplicitField field(recipe);
  // An arc across the pole, in steps of 1e-3, which is a fortieth of the wavelength.
  double before = field.value({std::sin(-0.2), 0.001, std::cos(-0.2)});
  for (double angle = -0.2; angle < 0.2; angle += 1e-3) {
    const double here = field.value({std::sin(angle), 0.001, std::cos(angle)});
    EXPECT_LT(std::fabs(here - before), 0.0035) << angle;  // five times the rms slope
    before = here;
  }
}

TEST(GaborSurfaceNoise, OtherLayersMoveItNotChangeIt) {
  // Two layers of one recipe are independent: their correlation vanishes.
  Box domain;
  domain.extend({-2, -2, -2});
  domain.extend({2, 2, 2});
  const GaborLayer layer = surface_layer({{3, 0.1, 0.05, 1.0}}, 0.02, 1.0);
  const MetaballBody body = *sphere_recipe(1.0).body;
  const testing::LoneGaborNoise first(layer, 1, 0, body, domain), second(layer, 1, 1, body, domain);
  CounterRandom random(6);
  double product = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d p = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
    float a, b;
    first.evaluate(1, &x, &y, &z, &a);
    second.evaluate(1, &x, &y, &z, &b);
    product += static_cast<double>(a * b) / 1000;
  }
  EXPECT_NEAR(product, 0.0, 0.1);
}

TEST(GaborSurfaceNoise, AbsurdScalesNeitherCrashNorGrow) {
  for (const double pixel_size : {1e-12, 1e-5, 1e6}) {
    Recipe recipe = potato_recipe(10, 5);
    recipe.layers = {surface_layer({{1, 0.1, 0.2, 1.0}, {12, 0.0, 0.0, 2.0}}, pixel_size, 0.004)};
    const ImplicitField field(recipe);
    EXPECT_TRUE(std::isfinite(field.value({0.3, 0.1, 0.1})));
    EXPECT_TRUE(std::isfinite(field.value({1e30, -1e30, 0.1})));
  }
}

}  // namespace
}  // namespace astrolith
