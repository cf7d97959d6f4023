#include "synthesis/picture/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "synthesis/finish/view_ground.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

using testing::has;
using testing::icosphere;
using testing::refusal_text;

// Looks along -x from `distance` on the x axis; +z is up and +y to the right.
SceneCamera camera_on_x(double distance, double focal, int side = 64, Calibration calibration = {}) {
  calibration.width = calibration.height = side;
  calibration.fx = calibration.fy = focal;
  calibration.cx = calibration.cy = 0.5 * (side - 1);
  return {calibration, {distance, 0, 0}, {{{0, 1, 0}, {0, 0, -1}, {-1, 0, 0}}}};
}

Vec3d direction_to_sphere(CounterRandom& random) {
  return normalized(Vec3d{random.normal(), random.normal(), random.normal()});
}

SceneRanges range_along(const Scene& scene, const Vec3d& origin, const Vec3d& direction,
                        const RangeOptions& options = {}) {
  return scene.ranges({&origin, 1}, {&direction, 1}, options);
}

TEST(Scene, RangesAreThoseOfTheTrianglesInDoublePrecision) {
  // The octahedron |x| + |y| + |z| = 1, turned and moved.
  Scene scene;
  scene.add(testing::octahedron());
  const double c = std::cos(0.7), s = std::sin(0.7);
  const BodyPose pose{{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}}, {300, -20, 7}};
  scene.place(0, pose);
  CounterRandom random(1);
  std::vector<Vec3d> origins, directions;
  std::vector<double> expected;
  for (int k = 0; k < 3000; ++k) {
    const double distance = k % 2 == 0 ? 3.0 : 5000.0;
    // Every third ray aims at an edge, where single precision takes one triangle for another.
    const double share = random.uniform(0.1, 0.9);
    const Vec3d on = k % 3 == 0 ? Vec3d{share, 1 - share, 0} : normalized(direction_to_sphere(random)) * 0.3;
    const Vec3d from = normalized(on + 0.2 * direction_to_sphere(random)) * distance;
    const Vec3d along = normalized(on - from);
    // The convex body is entered where the last of its planes before is crossed.
    double enter = -1e300;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d n{corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0};
      if (dot(n, along) < 0) enter = std::max(enter, (1 - dot(n, from)) / dot(n, along));
    }
    expected.push_back(enter);
    origins.push_back(rotate(pose.rotation, from) + pose.position);
    directions.push_back(2.5 * rotate(pose.rotation, along));
  }
  const SceneRanges made = scene.ranges(origins, directions);
  double worst = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(made.body[i], 0) << i;
    worst = std::max(worst, std::fabs(made.range[i] - expected[i]) / expected[i]);
  }
  EXPECT_LT(worst, 1e-12) << "of the distance";
}

TEST(Scene, RangesToASphereAndPastIt) {
  Scene scene;
  scene.add(icosphere(6, 250.0));
  std::vector<Vec3d> origins, directions;
  CounterRandom random(2);
  for (int k = 0; k < 1000; ++k) {
    const Vec3d from = 30000.0 * direction_to_sphere(random);
    origins.push_back(from);
    directions.push_back(100.0 * direction_to_sphere(random) - from);
  }
  origins.push_back({1000, 0, 0}), directions.push_back({0, 1, 0});
  origins.push_back({1000, 0, 0}), directions.push_back({1, 0, 0});
  const SceneRanges made = scene.ranges(origins, directions);
  for (std::size_t i = 0; i < 1000; ++i) {
    const Vec3d d = normalized(directions[i]);
    const double along = dot(origins[i], d), across2 = squared_norm(origins[i] - along * d);
    const double truth = -along - std::sqrt(250.0 * 250.0 - across2);
    EXPECT_NEAR(made.range[i], truth, 1e-6 * truth);
  }
  for (const std::size_t i : {1000, 1001}) {
    EXPECT_TRUE(std::isnan(made.range[i]) && std::isnan(made.incidence[i]));
    EXPECT_EQ(made.facet[i], -1);
    EXPECT_EQ(made.body[i], -1);
  }
}

TEST(Scene, NoiseAndBeamsHaveTheirWidths) {
  Scene scene;
  scene.add(testing::cube(20.0, {-20, -10, -10}));  // a wall at x = 0
  const std::size_t n = 4000;
  const std::vector<Vec3d> origins(n, {100, 0, 0}), directions(n, {-1, 0, 0});
  const SceneRanges noisy = scene.ranges(origins, directions, {0.5, 0, 7});
  double mean = 0, square = 0;
  for (const double r : noisy.range) mean += r / n, square += (r - 100) * (r - 100) / n;
  EXPECT_NEAR(mean, 100, 0.03);
  EXPECT_NEAR(std::sqrt(square), 0.5, 0.02);
  // Within a cone of half angle t the mean of the range r / cos is r (1 + t^2 / 4).
  const double half = 2.0 * std::numbers::pi / 180;
  EXPECT_NEAR(range_along(scene, origins[0], directions[0], {0, 4.0, 1}).range[0],
              100 * (1 + half * half / 4), 0.003);
}

TEST(Scene, SphereReflectsByItsLaw) {
  Scene scene;
  const TriangleMesh mesh = icosphere(5);
  scene.add(mesh, std::vector<float>(mesh.vertices.size(), 0.05f));
  const SceneCamera camera = camera_on_x(4.0, 100);
  const Vec3d sun = normalized(Vec3d{1, 1, 0.5});
  for (const char* law : {"lambert", "lommel-seeliger", "hapke w .05 g -.3 theta 20"}) {
    const Reflectance reflectance = parse_reflectance("law", law);
    const SceneImage image = scene.image(camera, sun, {reflectance, 1, true});
    int lit = 0;
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
      if (image.body[i] < 0) continue;
      const Vec3d seen = camera.direction({static_cast<double>(i % 64), static_cast<double>(i / 64)});
      const Vec3d normal =
          normalized(camera.position() + image.depth[i] / dot(seen, camera.boresight()) * seen);
      const double m0 = dot(normal, sun), m = -dot(normal, seen), phase = std::acos(-dot(sun, seen));
      EXPECT_NEAR(image.incidence[i], std::acos(m0) * 180 / std::numbers::pi, 0.05);
      EXPECT_NEAR(image.phase[i], phase * 180 / std::numbers::pi, 1e-4);
      EXPECT_TRUE(m0 > 0 || image.radiance[i] == 0.0f) << i;
      if (m0 < 0.05 || m < 0.2) continue;
      EXPECT_NEAR(image.emission[i], std::acos(m) * 180 / std::numbers::pi, 0.05);
      const double above = reflectance_at(reflectance, 1, 1, 0);
      EXPECT_NEAR(image.radiance[i], 0.05 * reflectance_at(reflectance, m0, m, phase) / above, 1e-4);
      ++lit;
    }
    EXPECT_GT(lit, 500);
  }
}

// A small body between the sun and a large one, each with a pose.
TEST(Scene, BodiesEclipseEachOther) {
  Scene scene;
  scene.add(icosphere(5));
  scene.add(icosphere(5, 0.2));
  const Vec3d sun = normalized(Vec3d{1, 0.5, 0}), moon = 3.0 * sun;
  scene.place(1, {kIdentity3, moon});
  const SceneCamera camera = camera_on_x(10.0, 260);
  const SceneImage image = scene.image(camera, sun, {parse_reflectance("law", "lambert"), 1, true});
  int dark = 0, seen = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (image.body[i] != 0 || image.incidence[i] > 85) continue;
    const Vec3d d = camera.direction({static_cast<double>(i % 64), static_cast<double>(i / 64)});
    const Vec3d p = camera.position() + image.depth[i] / dot(d, camera.boresight()) * d;
    const double across = norm((moon - p) - dot(moon - p, sun) * sun);
    if (std::fabs(across - 0.2) < 0.001) continue;
    ++seen;
    dark += across < 0.2 ? 1 : 0;
    EXPECT_EQ(image.radiance[i] == 0.0f, across < 0.2) << i;
  }
  EXPECT_GT(dark, 50);
  EXPECT_GT(seen, 1000);
}

TEST(Scene, PicturesAreTheSameForAllThreadsAndPoses) {
  Scene scene;
  scene.add(icosphere(4));
  const auto draw = [&](int threads) {
    const ThreadLimit limit(threads);
    return scene.image(camera_on_x(4.0, 100), {1, 1, 0}, {{}, 3, false});
  };
  const SceneImage one = draw(1), two = draw(2);
  EXPECT_EQ(one.radiance, two.radiance);
  EXPECT_EQ(one.facet, two.facet);
  EXPECT_EQ(std::memcmp(one.depth.data(), two.depth.data(), one.depth.size() * sizeof(double)), 0);
  // A copy has poses of its own.
  Scene moved = scene;
  moved.place(0, {kIdentity3, {0, 5, 0}});
  EXPECT_EQ(range_along(scene, {4, 0, 0}, {-1, 0, 0}).body[0], 0);
  EXPECT_EQ(range_along(moved, {4, 0, 0}, {-1, 0, 0}).body[0], -1);
  EXPECT_EQ(range_along(moved, {4, 5, 0}, {-1, 0, 0}).range[0],
            range_along(scene, {4, 0, 0}, {-1, 0, 0}).range[0]);
}

TEST(SceneCamera, DistortionIsUndone) {
  Calibration calibration;
  calibration.skew = 1.5;
  calibration.k1 = -0.28, calibration.k2 = 0.09, calibration.k3 = -0.01;
  calibration.p1 = 0.0012, calibration.p2 = -0.0007;
  const SceneCamera camera = camera_on_x(9.0, 900, 1024, calibration);
  for (double row = -0.5; row <= 1023.5; row += 64) {
    for (double column = -0.5; column <= 1023.5; column += 64) {
      const auto place = camera.project(camera.position() + 7.0 * camera.direction({column, row}));
      ASSERT_TRUE(place);
      EXPECT_NEAR(place->column, column, 1e-9);
      EXPECT_NEAR(place->row, row, 1e-9);
    }
  }
  EXPECT_FALSE(camera.project({10, 0, 0}));
}

TEST(SceneCamera, AnswersInTheWholePictureOrIsRefused) {
  CounterRandom random(3);
  int taken = 0;
  double worst = 0;
  for (int k = 0; k < 400; ++k) {
    const double strong = k % 4 == 0 ? 3 : 1;
    const auto number = [&](double most) { return strong * random.uniform(-most, most); };
    Calibration c;
    c.fx = c.fy = random.uniform(300, 2000);
    c.cx = random.uniform(0, 1023), c.cy = random.uniform(0, 1023), c.skew = number(10);
    c.k1 = number(0.5), c.k2 = number(0.3), c.p1 = number(0.02), c.p2 = number(0.02), c.k3 = number(0.1);
    if (refusal_text([&] { SceneCamera(c, {}, kIdentity3); }) != "no error") continue;
    ++taken;
    const SceneCamera camera(c, {}, kIdentity3);
    for (int i = 0; i < 100; ++i) {
      const ImagePoint place{random.uniform(-0.5, 1023.5), random.uniform(-0.5, 1023.5)};
      const ImagePoint seen = camera.project(camera.direction(place)).value();
      worst = std::max({worst, std::fabs(seen.column - place.column), std::fabs(seen.row - place.row)});
    }
  }
  EXPECT_GT(taken, 200);
  EXPECT_LT(taken, 320);
  EXPECT_LT(worst, 1e-9) << "pixels";
}

TEST(Scene, RefusesWhatCannotBe) {
  Scene scene;
  scene.add(icosphere(3));
  const SceneCamera outside = camera_on_x(4.0, 100);
  EXPECT_TRUE(has(refusal_text([&] { scene.image(outside, {0, 0, 0}); }), "sun: 0 0 0 is no direction"));
  EXPECT_TRUE(has(refusal_text([&] { scene.image(camera_on_x(0.5, 100), {1, 0, 0}); }), "inside body 0"));
  EXPECT_TRUE(has(refusal_text([&] { scene.image(outside, {1, 0, 0}, {{}, 17, true}); }), "oversampling"));
  EXPECT_TRUE(has(refusal_text([&] { range_along(scene, {2, 0, 0}, {0, 0, 0}); }), "row 0 is 0 0 0"));
  EXPECT_TRUE(has(refusal_text([&] { scene.place(1, {}); }), "there is no body 1"));
  EXPECT_TRUE(has(refusal_text([&] {
                    scene.place(0, {{{{2, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {}});
                  }),
                  "no rotation"));
  EXPECT_TRUE(has(refusal_text([&] {
                    scene.place(0, {{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {}});
                  }),
                  "mirrors"));
  EXPECT_TRUE(has(refusal_text([&] { scene.add(icosphere(1), {0.1f}); }), "1 albedos for 42 vertices"));
  const auto camera = [](double k1, double focal, int side) {
    return refusal_text([&] {
      Calibration calibration;
      calibration.k1 = k1;
      camera_on_x(4.0, focal, side, calibration);
    });
  };
  EXPECT_TRUE(has(camera(-0.9, 700, 1024), "distortion folds"));
  EXPECT_EQ(camera(-0.1, 700, 1024), "no error");
  EXPECT_TRUE(has(camera(0, 700, 20000), "20000 x 20000 pixels"));
  EXPECT_TRUE(has(camera(0, -1, 64), "focal lengths"));
}

// Waves on a ball, with stones that a patch of it draws by cells.
Recipe stony_ball() {
  Recipe recipe = testing::sphere_recipe(100.0);
  recipe.origin = {500, 0, 0};
  recipe.albedo = GroundAlbedo{.normal = 0.05};
  recipe.layers.push_back(testing::fractal_layer(1.0, 0.02, 6));
  BoulderLayer stones;
  Population& drawn = stones.population.emplace().drawn;
  drawn.density = 0.5;
  drawn.least_diameter = 0.5;
  drawn.greatest_diameter = 5.0;
  drawn.exponent = 2.5;
  drawn.by_cells = true;
  recipe.layers.push_back(stones);
  return recipe;
}

SceneCamera camera_above_ball(double height) {
  return in_axes_of_body(camera_on_x(100.0 + height, 80.0), {kIdentity3, {-500, 0, 0}});
}

TEST(ViewGround, HasFineCellsWhereThePictureShowsThem) {
  ViewGround ground(stony_ball(), "ball", 2.0);
  const auto far = ground.look(camera_above_ball(5000.0));
  EXPECT_EQ(far->levels, 1);
  EXPECT_EQ(ground.look(camera_above_ball(5001.0)), far);
  const auto near = ground.look(camera_above_ball(20.0));
  EXPECT_LE(near->finest, 2.0 * 20.0 / 80.0);
  EXPECT_GT(near->finest, 0.25 * 20.0 / 80.0);
  EXPECT_EQ(near->albedo.size(), near->mesh.vertices.size());
  for (const float a : near->albedo) ASSERT_NEAR(a, 0.05, 0.02);

  Scene scene;
  scene.add(near->mesh, near->albedo);
  const SceneImage image = scene.image(camera_above_ball(20.0), {1.0, 0.4, 0.3});
  for (const std::int16_t body : image.body) ASSERT_EQ(body, 0);  // no gap between levels

  // What was looked at before does not matter, nor do threads.
  const ThreadLimit one(1);
  const auto again = ViewGround(stony_ball(), "ball", 2.0).look(camera_above_ball(20.0));
  EXPECT_EQ(again->mesh.vertices, near->mesh.vertices);
  EXPECT_EQ(again->mesh.triangles, near->mesh.triangles);
}

TEST(ViewGround, RefusesErosionAndSizesOfCells) {
  Recipe recipe = stony_ball();
  EXPECT_TRUE(has(refusal_text([&] { ViewGround(recipe, "ball", 20.0); }), "detail"));
  recipe.erosion = Erosion{};
  EXPECT_TRUE(has(refusal_text([&] { ViewGround(recipe, "ball", 2.0); }), "erosion"));
}

}  // namespace
}  // namespace astrolith
