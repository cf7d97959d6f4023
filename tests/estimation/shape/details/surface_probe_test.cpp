#include "estimation/shape/details/surface_probe.h"

#include <cmath>

#include "estimation/shape/details/probe_layout.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

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
