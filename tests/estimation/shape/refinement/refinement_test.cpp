#include "estimation/shape/refinement/refinement.h"

#include <numbers>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// Evenly spaced points on a sphere (golden spiral).
std::vector<Vec3d> points_on_sphere(int n, double radius, const Vec3d& center) {
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n;
    const double ring = std::sqrt(1.0 - z * z);
    const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    points.push_back(center + radius * Vec3d{ring * std::cos(angle), ring * std::sin(angle), z});
  }
  return points;
}

RefinementOptions options() {
  RefinementOptions o;
  o.max_iterations = 60;
  o.loss_scale = 0.05;
  o.containment_weight = 0.1;
  o.relative_decrease = 1e-10;
  return o;
}

TEST(Refinement, OneSphereFindsItsPlaceAndRadius) {
  const FitPoints points{points_on_sphere(300, 1.5, {0.3, -0.2, 0.1}), {}, {}};
  const RefinementSummary summary = refine({3.0, {{{0, 0, 0}, 1.0}}}, points, options());
  ASSERT_EQ(summary.model.spheres.size(), 1u);
  EXPECT_NEAR(summary.model.spheres[0].radius, 1.5, 1e-6);
  EXPECT_NEAR(norm(summary.model.spheres[0].center - Vec3d{0.3, -0.2, 0.1}), 0.0, 1e-6);
  EXPECT_LT(summary.final_cost, 1e-10);
}

TEST(Refinement, OutsidePointsDriveAnIslandAway) {
  FitPoints points{points_on_sphere(300, 1.0, {0, 0, 0}), {}, {}};
  const Vec3d island{2.5, 0, 0};
  for (const double r : {0.1, 0.3, 0.45}) {
    for (const Vec3d& p : points_on_sphere(40, r, island)) points.outside.push_back(p);
  }
  points.outside.push_back(island);
  RefinementOptions o = options();
  o.containment_weight = 1.0;
  const RefinementSummary summary = refine({3.0, {{{0, 0, 0}, 1.0}, {island, 0.4}}}, points, o);
  const auto parameters = evaluation_parameters(summary.model);
  MetaballSums<double> sums;
  for (const Sphere& s : summary.model.spheres) {
    accumulate_metaball(parameters, MetaballSphere<double>{s.center, 1 / (s.radius * s.radius)}, island,
                        sums);
  }
  EXPECT_LT(metaball_distance(parameters, sums).distance, 0.0);
}

TEST(Refinement, SameBitsForOneAndTwoThreads) {
  const FitPoints points{points_on_sphere(500, 1.0, {0, 0, 0}), points_on_sphere(60, 0.5, {0, 0, 0}), {}};
  const MetaballModel start{3.0, {{{0.3, 0, 0}, 0.8}, {{-0.3, 0.1, 0}, 0.8}, {{0, 0, 0.3}, 0.7}}};
  std::vector<MetaballModel> models;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    models.push_back(refine(start, points, options()).model);
  }
  EXPECT_EQ(models[0].sharpness, models[1].sharpness);
  for (std::size_t i = 0; i < start.spheres.size(); ++i) {
    EXPECT_EQ(models[0].spheres[i].center, models[1].spheres[i].center);
    EXPECT_EQ(models[0].spheres[i].radius, models[1].spheres[i].radius);
  }
}

TEST(Refinement, StopsWhenAskedAndKeepsTheBest) {
  const FitPoints points{points_on_sphere(300, 1.5, {0.3, -0.2, 0.1}), {}, {}};
  const RefinementSummary summary =
      refine({3.0, {{{0, 0, 0}, 1.0}}}, points, options(), [](double, std::string_view) { return false; });
  EXPECT_TRUE(summary.interrupted);
  EXPECT_EQ(summary.model.spheres.size(), 1u);
}

}  // namespace
}  // namespace astrolith
