// Fine layers on bodies so large that float coordinates of their frames cannot hold them.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "synthesis/field/field_mesh.h"
#include "synthesis/gabor/gabor_bands.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

constexpr double kLargeRadius = 8500.0;  // metres
constexpr double kPixel = 0.004;

// A layer of each kind with details of millimetres, about 5 mm high.
struct NamedLayer {
  const char* name;
  Layer layer;
};
std::vector<NamedLayer> fine_layers() {
  SpotLayer spots;
  spots.amplitude = 0.01;
  spots.size = 0.006;
  spots.cell_size = 0.025;
  spots.density = 2.0;
  spots.layers = 2;
  SparseLayer sparse;
  sparse.amplitude = 0.02;
  sparse.cell_size = 0.03;
  sparse.levels = 3;
  sparse.probability = 0.3;
  PhasorLayer phasor;
  phasor.amplitude = 0.005;
  phasor.frequency = 60.0;
  phasor.cell_size = 0.05;
  RandomPhaseLayer waves;
  waves.height_rms = 0.005;
  waves.cell_size = 0.1;
  waves.frequency_min = 20.0;
  waves.frequency_max = 80.0;
  FractalLayer octaves = testing::fractal_layer(0.01, 40.0, 3);
  FractalLayer modulated = testing::fractal_layer(0.01, 40.0, 3);
  modulated.gradient_modulation = 0.3;
  modulated.bias = {3.7, -1e3, 0.1};
  FractalLayer cells = testing::fractal_layer(0.02, 60.0, 2);
  cells.noise = Noise::kWorleyF1;
  cells.scale = {1.0, 1.25, 0.75};
  FractalLayer warped = testing::fractal_layer(0.01, 40.0, 3);
  warped.noise = Noise::kPerlin;
  warped.warp = Warp{0.01, 10.0, 2, 0.5, 1.95};
  return {{"gabor", testing::gabor_layer(kPixel, 0.005)},
          {"spots", spots},
          {"sparse", sparse},
          {"phasor", phasor},
          {"waves", waves},
          {"octaves", octaves},
          {"modulated", modulated},
          {"cells", cells},
          {"warped", warped}};
}

Recipe ball(double radius, const Layer& layer) {
  Recipe recipe = testing::sphere_recipe(radius);
  recipe.length_unit = "m";
  recipe.layers = {layer};
  return recipe;
}

// Points of the bare ball about a centre on it, in a grid of sides `step`, relative to the centre.
std::vector<Vec3d> surface_grid(const Vec3d& center, int side, double step) {
  const double radius = norm(center);
  const Vec3d n = normalized(center);
  const Vec3d u = normalized(cross(std::abs(n.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}, n)),
              v = cross(n, u);
  std::vector<Vec3d> points;
  for (int i = 0; i < side * side; ++i) {
    const double a = (i % side - side / 2) * step, b = (i / side - side / 2) * step;
    // sqrt(r^2 - d^2) - r without cancellation.
    const double d2 = a * a + b * b, drop = -d2 / (std::sqrt(radius * radius - d2) + radius);
    points.push_back(a * u + b * v + drop * n);
  }
  return points;
}

// F at points relative to the centre of the patch.
std::vector<float> values_at(const ImplicitField& field, const Vec3d& center,
                             const std::vector<Vec3d>& points) {
  std::vector<float> value(points.size());
  testing::FloatPoints all;
  Box box;
  for (const Vec3d& p : points) all.add(p), box.extend(p);
  const FieldBlock block = field.gather(PatchPlace(center).in_body(box));
  block.evaluate_local(center, all.x, all.y, all.z, value, kExactEverywhere);
  return value;
}

// A point of the bare body near the ray from the origin. Radii are floats in a field, so that the surface of
// a large ball does not lie exactly where the recipe says.
Vec3d surface_point(Recipe recipe, const Vec3d& direction) {
  recipe.layers.clear();
  const ImplicitField bare(recipe);
  Vec3d p = recipe.body->spheres[0].radius * direction;
  for (int i = 0; i < 20; ++i) p += double{values_at(bare, p, {Vec3d{}})[0]} * direction;
  return p;
}

double spread(const std::vector<float>& heights) {
  double sum = 0.0, squares = 0.0;
  for (const float h : heights) {
    sum += double{h};
    squares += double{h} * double{h};
  }
  const double n = static_cast<double>(heights.size()), mean = sum / n;
  return std::sqrt(squares / n - mean * mean);
}

// Directions at several latitudes, a pole among them.
std::vector<Vec3d> directions() {
  return {normalized(Vec3d{1, 0.2, 0.05}), normalized(Vec3d{-0.4, 0.7, 0.6}),
          normalized(Vec3d{0.1, -0.3, -0.95}), Vec3d{0, 0, 1}};
}

double mean_spread(double radius, const Layer& layer) {
  double sum = 0.0;
  for (const Vec3d& direction : directions()) {
    const Recipe recipe = ball(radius, layer);
    const Vec3d center = surface_point(recipe, direction);
    const ImplicitField field(recipe, "ball", PatchCube{center, 1.0});
    sum += spread(values_at(field, center, surface_grid(center, 64, 0.0151)));
  }
  return sum / static_cast<double>(directions().size());
}

// At 10^9 m cells have numbers beyond 32 bits.
TEST(PatchLayers, HeightsOfALargeBallSpreadAsThoseOfASmallOne) {
  for (const auto& [name, layer] : fine_layers()) {
    const double small = mean_spread(20.0, layer);
    EXPECT_GT(small, 1e-3) << name;
    EXPECT_NEAR(mean_spread(kLargeRadius, layer) / small, 1.0, 0.1) << name;
    EXPECT_NEAR(mean_spread(1e9, layer) / small, 1.0, 0.1) << name;
  }
}

TEST(PatchLayers, ValuesDoNotDependOnTheCentre) {
  for (const bool body_warp : {false, true}) {
    for (const auto& [name, layer] : fine_layers()) {
      Recipe recipe = ball(kLargeRadius, layer);
      if (body_warp) recipe.body->warp = Warp{3.0, 1e-3, 2, 0.5, 1.95};
      const Vec3d center = surface_point(recipe, directions()[1]), shift{0.375, -0.25, 0.125};
      const ImplicitField here(recipe, "ball", PatchCube{center, 1.0});
      const ImplicitField there(recipe, "ball", PatchCube{center + shift, 1.0});
      std::vector<Vec3d> points = surface_grid(center, 16, 0.0151), shifted;
      for (Vec3d& p : points) {
        p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        shifted.push_back(p - shift);
      }
      const std::vector<float> a = values_at(here, center, points),
                               b = values_at(there, center + shift, shifted);
      double largest = 0.0;
      for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, double{std::abs(a[i] - b[i])});
      EXPECT_LT(largest, body_warp ? 1e-4 : 2e-5) << name << (body_warp ? " on a warped body" : "");
    }
  }
}

// The bounds of a block hold at its points.
TEST(PatchLayers, BlocksAreInsideOrOutsideAsTheirPointsAre) {
  for (const auto& [name, layer] : fine_layers()) {
    const Recipe recipe = ball(kLargeRadius, layer);
    const Vec3d center = surface_point(recipe, directions()[0]);
    const ImplicitField field(recipe, "ball", PatchCube{center, 1.0});
    CounterRandom random(3);
    const Vec3d n = normalized(center), along = normalized(cross(Vec3d{0, 0, 1}, n));
    int decided = 0;
    for (int k = 0; k < 300; ++k) {
      const Vec3d low = random.uniform(-1.0, 1.0) * n + random.uniform(-0.4, 0.4) * along;
      const Box box{low, low + Vec3d{0.004, 0.004, 0.004}};
      const BlockContent content = PatchField(field, center).gather(box).content();
      if (content == BlockContent::kMixed) continue;
      ++decided;
      std::vector<Vec3d> points;
      for (int i = 0; i < 40; ++i) {
        points.push_back(box.min +
                         Vec3d{0.004 * random.uniform(), 0.004 * random.uniform(), 0.004 * random.uniform()});
      }
      for (const float value : values_at(field, center, points)) {
        ASSERT_EQ(value > 0.0f, content == BlockContent::kInside) << name;
      }
    }
    EXPECT_GT(decided, 20) << name;
  }
}

// The height of a Gabor layer at a point of a ball, in double precision, from the definition: the impulses of
// all cells whose kernels may reach the point.
class GaborReference {
 public:
  GaborReference(const GaborLayer& layer, std::uint64_t seed) : layer_(layer), seed_(seed) {}

  double height(const Vec3d& p) const {
    double sum = 0.0;
    for (const GaborBand& band : gabor_bands(layer_)) sum += noise_height(band, p);
    return sum;
  }

 private:
  double noise_height(const GaborBand& band, const Vec3d& p) const {
    const double a = band.a / layer_.pixel_size;
    const double cell = static_cast<float>(kGaborSpaceCell / a);
    const int count =
        std::max(1, static_cast<int>(std::lround(layer_.impulses_per_kernel * std::pow(kGaborSpaceCell, 3) /
                                                 (kGaborKernelArea * kGaborSlabThickness))));
    const double density = count / std::pow(kGaborSpaceCell, 3);
    const double energy = kGaborDiscEnergy * kGaborSlabEnergy;
    const double amplitude = layer_.height_rms * std::sqrt(2.0 * band.variance_share / (density * energy));
    const std::uint32_t seed = gabor_band_seed(seed_, 0, band.bandwidth);
    const auto around = static_cast<std::int64_t>(std::ceil(1.6 / kGaborSpaceCell)) + 1;
    const std::array<std::int64_t, 3> at{static_cast<std::int64_t>(std::floor(p.x / cell)),
                                         static_cast<std::int64_t>(std::floor(p.y / cell)),
                                         static_cast<std::int64_t>(std::floor(p.z / cell))};
    double sum = 0.0;
    for (std::int64_t z = at[2] - around; z <= at[2] + around; ++z) {
      for (std::int64_t y = at[1] - around; y <= at[1] + around; ++y) {
        for (std::int64_t x = at[0] - around; x <= at[0] + around; ++x) {
          sum += cell_noise(band, a, cell, count, {x, y, z}, seed, p);
        }
      }
    }
    return amplitude * sum;
  }

  double cell_noise(const GaborBand& band, double a, double cell, int count,
                    const std::array<std::int64_t, 3>& c, std::uint32_t seed, const Vec3d& p) const {
    const auto corner = [&](int axis) { return static_cast<double>(c[static_cast<std::size_t>(axis)]); };
    const Vec3d center{(corner(0) + 0.5) * cell, (corner(1) + 0.5) * cell, (corner(2) + 0.5) * cell};
    const Vec3d n = normalized(center);
    const Vec3d east =
        normalized(n.x * n.x + n.y * n.y < 3e-4 ? Vec3d{1.0 - n.x * n.x, -n.x * n.y, -n.x * n.z}
                                                : Vec3d{-n.y, n.x, 0.0});
    const Vec3d south = cross(east, n);
    const std::uint32_t hash =
        hash_cell(seed, static_cast<int>(c[0]), static_cast<int>(c[1]), static_cast<int>(c[2]));
    double sum = 0.0;
    for (int j = 0; j < count; ++j) {
      const std::uint32_t h = hash_append(hash, static_cast<std::uint32_t>(j));
      const auto along = [&](int axis, int shift) {
        return (corner(axis) + (((h >> shift) & 1023u) + 0.5) / 1024.0) * cell;
      };
      const Vec3d d = p - Vec3d{along(0, 2), along(1, 12), along(2, 22)};
      const std::uint32_t bits = hash_append(h, 0);
      const GaborBand::Lobe& lobe = band.draw(static_cast<float>(bits >> 16) * 0x1p-16f);
      sum += kernel(a * dot(d, east), a * dot(d, south), a * dot(d, n), lobe,
                    static_cast<double>(bits & 0xffffu) / 65536.0);
    }
    return sum;
  }

  static double kernel(double u, double v, double n, const GaborBand::Lobe& lobe, double phase) {
    const double t = std::max(1.0 - (u * u + v * v) / std::pow(double{kGaborDiscReach}, 2), 0.0);
    const double slab = std::max(1.0 - std::pow(n, 8), 0.0);
    return t * t * (1.81 - 4.23 * t + 3.42 * t * t) * slab * slab *
           std::cos(2.0 * std::numbers::pi *
                    (double{lobe.frequency_x} * u + double{lobe.frequency_y} * v + phase));
  }

  GaborLayer layer_;
  std::uint64_t seed_;
};

TEST(PatchLayers, GaborHeightsAreThoseOfADoublePrecisionReference) {
  const GaborLayer layer = testing::gabor_layer(kPixel, 0.005);
  const Recipe recipe = ball(kLargeRadius, layer);
  const GaborReference reference(layer, recipe.seed);
  for (const Vec3d& direction : directions()) {
    const Vec3d center = surface_point(recipe, direction);
    const ImplicitField field(recipe, "ball", PatchCube{center, 1.0});
    const std::vector<Vec3d> points = surface_grid(center, 12, 0.083);
    const std::vector<float> heights = values_at(field, center, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_NEAR(double{heights[i]}, reference.height(center + points[i]), 1e-5) << i;
    }
  }
}

// On a ball of 600 m float coordinates of the body's frame still hold the layers, to a spacing of 3e-5 m. The
// frame of a patch has the same pattern.
TEST(PatchLayers, TheFrameOfAPatchHasThePatternOfTheBody) {
  for (const auto& [name, layer] : fine_layers()) {
    Recipe recipe = ball(300.0, layer);
    recipe.layers.push_back(testing::fractal_layer(1e-4, 0.1, 1));  // the layer is not the last one
    const Vec3d center = surface_point(recipe, directions()[1]);
    const ImplicitField patch(recipe, "ball", PatchCube{center, 1.0}), whole(recipe);
    const std::vector<Vec3d> points = surface_grid(center, 24, 0.0151);
    const std::vector<float> a = values_at(patch, center, points), b = values_at(whole, center, points);
    std::vector<double> differences;
    for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(std::abs(double{a[i]} - double{b[i]}));
    std::sort(differences.begin(), differences.end());
    EXPECT_LT(differences[differences.size() * 95 / 100], 3e-4) << name;  // heights of 5e-3
  }
}

TEST(PatchLayers, WholeBodyListsWhatItLeavesOut) {
  for (const auto& [name, layer] : fine_layers()) {
    const ImplicitField large(ball(1e6, layer));
    ASSERT_EQ(large.left_out().size(), 1u) << name;
    EXPECT_EQ(large.left_out()[0].layer, 0);
    EXPECT_GT(large.left_out()[0].variance_share, 0.0) << name;
    EXPECT_LE(large.left_out()[0].variance_share, 1.0) << name;
    EXPECT_TRUE(ImplicitField(ball(20.0, layer)).left_out().empty()) << name;
    const ImplicitField patch(ball(1e6, layer), "ball", PatchCube{{1e6, 0, 0}, 1.0});
    EXPECT_TRUE(patch.left_out().empty()) << name;
  }
  // Eight octaves, each twice as fine and half as high as the one before. The last are beyond 2^20 cells.
  FractalLayer octaves = testing::fractal_layer(1.0, 200.0, 8);
  octaves.lacunarity = 2.0;
  Recipe recipe = ball(1.0, octaves);
  recipe.body->spheres[0].radius = 100.0;
  const ImplicitField field(recipe);
  ASSERT_EQ(field.left_out().size(), 1u);
  const double part = field.left_out()[0].variance_share;
  bool found = false;
  for (int kept = 1; kept < 8; ++kept) {
    const double share = (std::pow(0.25, kept) - std::pow(0.25, 8)) / (1.0 - std::pow(0.25, 8));
    found = found || std::abs(part - share) < 1e-12;
  }
  EXPECT_TRUE(found) << part;
}

TEST(PatchLayers, AFieldForAPatchRefusesAnotherOrigin) {
  const Vec3d center{kLargeRadius, 0, 0};
  const ImplicitField field(ball(kLargeRadius, fine_layers()[0].layer), "ball", PatchCube{center, 1.0});
  EXPECT_THROW(values_at(field, center + Vec3d{0.1, 0, 0}, {Vec3d{}}), std::invalid_argument);
}

}  // namespace
}  // namespace astrolith
