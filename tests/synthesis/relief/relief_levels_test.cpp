#include "synthesis/relief/relief_levels.h"

#include <cmath>

#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/relief/relief_bounds.h"
#include "synthesis/relief/relief_level_ground.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/reliefs.h"

namespace astrolith {
namespace {

constexpr double kLevelSpacing = 0.025;

// Ground that is rough where x > 0 and flat elsewhere.
double half_rough(const Vec3d& p) {
  return p.x > 0.1 ? 0.003 * std::sin(90.0 * p.x + 7.0 * p.y) * std::sin(85.0 * p.y - 9.0 * p.z) : 0.0;
}

// A body under a relief with levels below it.
struct Continued {
  ImplicitField field;
  const ReliefNoise& noise;

  template <class Height = double (*)(const Vec3d&)>
  explicit Continued(int levels, const Height& height = half_rough)
      : field(recipe(levels, height)), noise(*field.tables().layers[0].noise.get_if<ReliefNoise>()) {}
  template <class Height = double (*)(const Vec3d&)>
  static Recipe recipe(int levels, const Height& height = half_rough) {
    Recipe made = testing::potato_recipe(60, 5);
    ReliefLayer layer = testing::relief_layer(made, kLevelSpacing, -0.01, 0.01, height);
    layer.finer = levels;
    made.layers = {layer};
    return made;
  }
  const ArrayView& arrays() const { return field.tables().arrays; }
  double at(const Vec3d& p) const { return double{height_at(noise, arrays(), to_float(p))}; }
};

// Points of the bare surface, but for some micrometres.
std::vector<Vec3d> body_points(const Recipe& recipe) {
  std::vector<Vec3d> points;
  for (const ReliefPlace& p : testing::find_places(recipe, 0.4 * kLevelSpacing)) {
    points.push_back(testing::position(p, 0.4 * kLevelSpacing));
  }
  return points;
}

TEST(ReliefLevels, AddStonesOnRoughGroundAlone) {
  const Continued bare(0), continued(2);
  double rough = 0.0, flat = 0.0;
  for (const Vec3d& p : body_points(Continued::recipe(0))) {
    const double added = continued.at(p) - bare.at(p);
    if (p.x > 0.2) rough = std::max(rough, std::fabs(added));
    if (p.x < -0.4) flat = std::max(flat, std::fabs(added));
  }
  EXPECT_GT(rough, 3e-4);
  EXPECT_LT(rough, 6e-3);
  EXPECT_LT(flat, 1e-6);
}

// What a level adds has no weight in means over an edge of the model.
TEST(ReliefLevels, AverageOutOverTheModel) {
  const Continued bare(0), continued(3);
  const std::vector<Vec3d> points = body_points(Continued::recipe(0));
  const double radius = 2.0 * kLevelSpacing;
  double squares = 0.0, squared_means = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < points.size(); i += 97) {
    if (points[i].x < 0.2) continue;
    double sum = 0.0;
    int near = 0;
    for (const Vec3d& p : points) {
      if (squared_norm(p - points[i]) < radius * radius) sum += continued.at(p) - bare.at(p), ++near;
    }
    const double added = continued.at(points[i]) - bare.at(points[i]), mean = sum / near;
    squares += added * added, squared_means += mean * mean, ++count;
  }
  ASSERT_GT(count, 20);
  EXPECT_LT(std::sqrt(squared_means / squares), 0.35);
}

TEST(ReliefLevels, HaveTheBitsOfOnePointInABatch) {
  const Continued continued(3);
  const std::vector<Vec3d> points = body_points(Continued::recipe(0));
  std::vector<float> x, y, z;
  for (std::size_t i = 0; i < points.size(); i += 7) {
    const Vec3f p = to_float(points[i]);
    x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
  }
  std::vector<float> heights(x.size());
  evaluate_heights(continued.noise, continued.arrays(), static_cast<int>(x.size()), x.data(), y.data(),
                   z.data(), heights.data());
  for (std::size_t i = 0; i < x.size(); ++i) {
    ASSERT_EQ(math::to_bits(heights[i]),
              math::to_bits(height_at(continued.noise, continued.arrays(), {x[i], y[i], z[i]})))
        << i;
  }
}

TEST(ReliefLevels, StayWithinTheBoundsOfTheNoise) {
  const Continued continued(2);
  const Vec3d half{0.01, 0.01, 0.01};
  for (const Vec3d& p : body_points(Continued::recipe(0))) {
    const Interval bound = bound_heights(continued.noise, continued.arrays(), Box{p - half, p + half});
    const double height = continued.at(p);
    ASSERT_TRUE(height >= bound.low && height <= bound.high);
    ASSERT_LE(std::fabs(height), continued.noise.height_bound);
  }
}

// Where nothing can be said of stones there are none.
TEST(ReliefLevels, AddNothingToAnEvenRelief) {
  const auto even = [](const Vec3d&) { return 0.004; };
  const Continued bare(0, even), continued(2, even);
  for (const Vec3d& p : body_points(Continued::recipe(0))) ASSERT_NEAR(continued.at(p), bare.at(p), 1e-9);
}

TEST(ReliefTexture, RepeatsAndHasNoMean) {
  const Recipe recipe = Continued::recipe(0);
  ArrayStore arrays;
  const BodyTables body = make_body(*recipe.body, recipe.seed, arrays);
  const ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
  const std::vector<ReliefPlace> places = testing::find_places(recipe, kLevelSpacing);
  std::vector<double> heights;
  for (const ReliefPlace& p : places) heights.push_back(half_rough(testing::position(p, kLevelSpacing)));
  const ReliefTiles tiles = make_relief_tiles(places, "test");
  const ReliefPatches patches({{body, arrays.view(), metaballs.lists()}, places, tiles, heights},
                              kLevelSpacing, kLevelSpacing / 1.2);
  const ReliefTexture texture = relief_texture(patches, 9);
  double sum = 0.0, squares = 0.0, steps = 0.0, seam = 0.0;
  const auto n = static_cast<std::size_t>(texture.side);
  for (std::size_t y = 0; y < n; ++y) {
    for (std::size_t x = 0; x < n; ++x) {
      const double here = texture.heights[y * n + x], next = texture.heights[y * n + (x + 1) % n];
      sum += here, squares += here * here;
      (x + 1 == n ? seam : steps) += (here - next) * (here - next);
    }
  }
  const double count = static_cast<double>(n * n);
  EXPECT_NEAR(sum / count, 0.0, 1e-9);
  EXPECT_GT(squares / count, 0.03);
  EXPECT_LT(squares / count, 2.0);
  EXPECT_LT(seam / static_cast<double>(n), 2.0 * steps / count);
  EXPECT_GE(texture.exponent, 0.3);
  EXPECT_LE(texture.exponent, 1.5);
}

}  // namespace
}  // namespace astrolith
