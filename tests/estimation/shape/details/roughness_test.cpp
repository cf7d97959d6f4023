#include <algorithm>
#include <cmath>

#include "descriptor/histogram_distance.h"
#include "descriptor/surflet_histogram.h"
#include "estimation/shape/details/detail_fitness.h"
#include "estimation/shape/details/imaged_ground.h"
#include "estimation/shape/details/residual_texture.h"
#include "estimation/shape/details/roughness.h"
#include "estimation/shape/details/surface_probe.h"
#include "geometry/surface/sample_curvature.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/noise/fractal_noise.h"
#include "tests/estimation/shape/details/known_details.h"
#include "tests/support/meshes.h"
#include "tests/synthesis/lone_noise.h"

namespace astrolith {
namespace {

TEST(Roughness, OfAParabolaGrowsWithTheSquareOfTheLag) {
  // Every second difference of t = x^2 / 2 is r^2.
  std::vector<double> heights;
  std::vector<std::vector<HeightTriple>> triples(2);
  for (const double r : {0.1, 0.3}) {
    for (const double x : {0.0, 1.0, 2.0}) {
      const auto first = static_cast<std::uint32_t>(heights.size());
      for (const double at : {x - r, x, x + r}) heights.push_back(0.5 * at * at);
      triples[r < 0.2 ? 0 : 1].push_back({first, first + 1, first + 2});
    }
  }
  const std::vector<double> nu = roughness(heights, triples);
  EXPECT_NEAR(nu[0], 0.01, 1e-12);
  EXPECT_NEAR(nu[1], 0.09, 1e-12);
}

// Compares fractal sums as synthesis makes them with the closed form.
TEST(RoughnessModel, AgreesWithSynthesisedNoise) {
  const RoughnessModel model;
  const std::vector<double> lags{0.02, 0.05, 0.1};
  for (std::size_t which = 0; which < 3; ++which) {
    FractalLayer layer;
    layer.noise = kDetailNoises[which];
    layer.amplitude = 0.5;
    layer.frequency = 8.0;
    layer.octaves = 3;
    layer.gain = 0.6;
    const LoneNoise<FractalNoise> noise(layer, 7, 0, {{-9, -9, -9}, {9, 9, 9}});
    const std::vector<double> expected = model.of({which, 1.0, 8.0, 3, 0.6}, lags);
    for (std::size_t k = 0; k < lags.size(); ++k) {
      CounterRandom random(k, which);
      std::vector<float> x[3];
      const int n = 20000;
      for (int i = 0; i < n; ++i) {
        Vec3d u{random.normal(), random.normal(), random.normal()};
        u = normalized(u);
        const Vec3d p{random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-8, 8)};
        for (const double side : {-lags[k], 0.0, lags[k]}) {
          x[0].push_back(static_cast<float>(p.x + side * u.x));
          x[1].push_back(static_cast<float>(p.y + side * u.y));
          x[2].push_back(static_cast<float>(p.z + side * u.z));
        }
      }
      std::vector<float> h(x[0].size());
      noise.evaluate(static_cast<int>(h.size()), x[0].data(), x[1].data(), x[2].data(), h.data());
      double sum = 0.0;
      for (std::size_t i = 0; i < h.size(); i += 3)
        sum += std::pow(double{h[i]} - 2.0 * h[i + 1] + h[i + 2], 2);
      EXPECT_NEAR(std::sqrt(sum / n) / (0.5 * expected[k]), 1.0, 0.03) << which << " " << lags[k];
    }
  }
}

TEST(RoughnessModel, ANoiseIsFoundAgainFromItsRoughness) {
  const RoughnessModel model;
  const DetailRanges ranges{8.0, 80.0, 1e-6, 1e-1, 1.0};
  const std::vector<double> lags{0.0125, 0.0177, 0.025, 0.035, 0.05, 0.07};
  for (std::size_t which = 0; which < 3; ++which) {
    for (const double gain : {0.0, 0.5}) {
      const PlainNoise truth{which, 1.0, 20.0, 3, gain};
      std::vector<double> wanted = model.of(truth, lags);
      for (double& v : wanted) v *= 2e-3;
      // A gain of 0 leaves one octave.
      const std::vector<PlainNoise> good = noises_as_rough_as(wanted, lags, which, ranges, model);
      ASSERT_FALSE(good.empty());
      const auto same = std::find_if(good.begin(), good.end(),
                                     [&](const PlainNoise& n) { return n.octaves == (gain > 0.0 ? 3 : 1); });
      ASSERT_NE(same, good.end());
      const PlainNoise& found = *same;
      EXPECT_NEAR(found.amplitude / 2e-3, 1.0, 0.1) << which << " " << gain;
      EXPECT_NEAR(found.frequency / 20.0, 1.0, 0.1) << which << " " << gain;
    }
  }
}

TEST(Roughness, MisfitIsTheRootMeanSquareLogRatio) {
  const std::vector<double> a{1.0, 2.0}, b{1.0, 2.0}, twice{2.0, 4.0};
  EXPECT_EQ(roughness_misfit(a, b), 0.0);
  EXPECT_NEAR(roughness_misfit(a, twice), std::log(2.0), 1e-12);
  EXPECT_LE(roughness_misfit(a, std::vector<double>{0.0, 0.0}), 3.0);
}

// Places on a unit sphere, whose roughness within 6 edges is `smooth` where x is above `from`.
SurfaceStatistics sphere_smooth_beyond(double from, double smooth) {
  SurfaceStatistics statistics;
  statistics.edge = 0.05;
  LocalStatistic roughness{SurfaceQuantity::roughness, 6.0, {}};
  CounterRandom random(7);
  for (int i = 0; i < 600; ++i) {
    const double z = random.uniform(-1.0, 1.0), angle = random.uniform(0.0, 6.283185307179586);
    const double r = std::sqrt(1.0 - z * z);
    statistics.places.push_back({r * std::cos(angle), r * std::sin(angle), z});
    const double middle = statistics.places.back().x > from ? smooth : -4.0;
    roughness.values.push_back(middle + 0.5 * random.normal());
  }
  statistics.local.push_back(std::move(roughness));
  return statistics;
}

TEST(ImagedGround, TheSideWithoutDetailsIsFound) {
  EXPECT_NEAR(unseen_share(sphere_smooth_beyond(0.1, -8.0)), 0.45, 0.08);
}

TEST(ImagedGround, ABodyThatIsRoughEverywhereHasNone) {
  EXPECT_EQ(unseen_share(sphere_smooth_beyond(2.0, -8.0)), 0.0);
}

// A smoother region of a real body, such as a sea of regolith, is no ground without details.
TEST(ImagedGround, ARegionOfAThirdOfTheRoughnessIsNone) {
  EXPECT_EQ(unseen_share(sphere_smooth_beyond(0.1, -5.1)), 0.0);
}

ShapeHistogram described(const TriangleMesh& mesh, const SurfaceSamples& samples, double radius) {
  return ahd_histogram(samples.points, samples.normals, sample_curvature(mesh, samples, radius).gaussian);
}

std::vector<MeshPlace> sample_places(const TriangleMesh& mesh, const SurfaceSamples& samples) {
  const SurfaceTree tree(mesh);
  std::vector<MeshPlace> places;
  for (const Vec3d& p : samples.points) places.push_back(nearest_place(mesh, tree, p));
  return places;
}

TEST(MovedMesh, UnmovedHasTheDescriptorOfItsMesh) {
  const TriangleMesh mesh = testing::torus(1.0, 0.4);
  const SurfaceSamples samples = sample_surface(mesh, 600, 1);
  const MovedMesh moved(mesh, sample_places(mesh, samples), 0.2);
  EXPECT_GT(similarity(moved.histogram(mesh.vertices), described(mesh, samples, 0.2)), 0.99);
}

TEST(MovedMesh, SamplesFollowTheirTriangles) {
  const TriangleMesh mesh = testing::icosphere(4);
  const SurfaceSamples samples = sample_surface(mesh, 600, 1);
  const MovedMesh moved(mesh, sample_places(mesh, samples), 0.3);
  TriangleMesh egg = mesh;
  for (Vec3d& p : egg.vertices) p.x *= 1.6;
  SurfaceSamples on_egg = samples;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    on_egg.points[i].x *= 1.6;
    const Triangle& t = egg.triangles[samples.triangles[i]];
    on_egg.normals[i] =
        normalized(cross(egg.vertices[t[1]] - egg.vertices[t[0]], egg.vertices[t[2]] - egg.vertices[t[0]]));
  }
  const ShapeHistogram egg_histogram = moved.histogram(egg.vertices);
  EXPECT_GT(similarity(egg_histogram, described(egg, on_egg, 0.3)), 0.97);
  EXPECT_LT(similarity(egg_histogram, moved.histogram(mesh.vertices)), 0.8);
}

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

MetaballBody unit_ball() {
  MetaballBody body;
  body.spheres.push_back({{0, 0, 0}, 1.0});
  return body;
}

std::vector<ProbePoint> points_on_unit_ball(int n) {
  std::vector<ProbePoint> points;
  for (int i = 0; i < n; ++i) {
    const double z = -1.0 + (2.0 * i + 1.0) / n, angle = 2.4 * i, r = std::sqrt(1.0 - z * z);
    const Vec3d p{r * std::cos(angle), r * std::sin(angle), z};
    points.push_back({p, p});
  }
  return points;
}

FractalLayer hills() {
  FractalLayer layer;
  layer.amplitude = 0.02;
  layer.frequency = 2.0;
  layer.octaves = 3;
  return layer;
}

TEST(SurfaceProbe, StandsOnTheFieldsSurface) {
  const std::vector<ProbePoint> points = points_on_unit_ball(500);
  const SurfaceProbe probe(unit_ball(), points, 0.5);
  const std::vector<FractalLayer> layers{hills()};
  const std::vector<double> heights = probe.heights(layers, 3);
  Recipe recipe;
  recipe.seed = 3;
  recipe.body = unit_ball();
  recipe.layers.push_back(hills());
  const ImplicitField field(recipe);
  double largest = 0.0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    EXPECT_NEAR(field.value(points[i].start + heights[i] * points[i].direction), 0.0, 2e-3);
    largest = std::max(largest, std::fabs(heights[i]));
  }
  EXPECT_GT(largest, 0.01);
}

TEST(SurfaceProbe, BareBaseHasNoHeight) {
  const SurfaceProbe probe(unit_ball(), points_on_unit_ball(100), 0.5);
  for (const double t : probe.heights({}, 1)) EXPECT_NEAR(t, 0.0, 1e-6);
}

TEST(SurfaceProbe, FindsTheTarget) {
  const SurfaceTree larger(testing::icosphere(5, 1.1));
  for (const double t : target_heights(larger, points_on_unit_ball(100), 0.5)) EXPECT_NEAR(t, 0.1, 1e-3);
}

TEST(ProbeLayout, HasTheBasesMeshAndLinesOfEveryLag) {
  const TargetBody target = prepare_target(testing::icosphere(4), "sphere");
  MetaballBody base;
  base.spheres.push_back({{0, 0, 0}, 0.5 / std::sqrt(3.0)});
  const ProbeLayout layout = lay_out_probes(target, base, 50, 1);
  ASSERT_GE(layout.lags.size(), 3u);
  ASSERT_EQ(layout.triples.size(), layout.lags.size());
  EXPECT_EQ(layout.places.size(), 50 * (1 + 2 * layout.lags.size()));
  EXPECT_NEAR(static_cast<double>(layout.mesh.triangles.size()), 5120.0, 2000.0);
  const std::vector<ProbePoint> places = layout.place_points();
  for (std::size_t k = 0; k < layout.lags.size(); ++k) {
    EXPECT_EQ(layout.triples[k].size(), 50u);
    for (const HeightTriple& t : layout.triples[k]) {
      // The chords of a ball of radius 0.29 are a little shorter than their tangents.
      EXPECT_NEAR(norm(places[t.after].start - places[t.before].start) / (2.0 * layout.lags[k]), 1.0, 0.1);
      EXPECT_NEAR(norm(places[t.after].direction), 1.0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace astrolith
