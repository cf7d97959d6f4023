#include "synthesis/relief/relief_noise.h"

#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/reliefs.h"

namespace astrolith {
namespace {

using testing::potato_recipe;
using testing::relief_layer;
using testing::sphere_recipe;

// A body under a relief, and the noise of the relief.
struct Covered {
  ImplicitField field;
  const ReliefNoise& noise;

  template <class Height>
  Covered(Recipe recipe, double spacing, double range, const Height& height)
      : field(with_relief(std::move(recipe), spacing, range, height)),
        noise(*field.tables().layers[0].noise.get_if<ReliefNoise>()) {}
  template <class Height>
  static Recipe with_relief(Recipe recipe, double spacing, double range, const Height& height) {
    recipe.layers = {relief_layer(recipe, spacing, -range, range, height)};
    return recipe;
  }
  double at(const Vec3d& p) const {
    return static_cast<double>(height_at(noise, field.tables().arrays, to_float(p)));
  }
};

Vec3d random_direction(CounterRandom& random) {
  return normalized(Vec3d{random.normal(), random.normal(), random.normal()});
}

double waves(const Vec3d& p) { return 0.02 * std::sin(5 * p.x + 1) * std::cos(4 * p.y - 3 * p.z); }

// The weights of all maps sum to 1 everywhere.
TEST(ReliefNoise, KeepsAConstantHeight) {
  const Covered ball(sphere_recipe(1.0), 0.05, 0.1, [](const Vec3d&) { return 0.03; });
  CounterRandom random(3);
  for (int i = 0; i < 20000; ++i) ASSERT_NEAR(ball.at(random_direction(random)), 0.03, 3e-6) << i;
  EXPECT_NEAR(ball.field.value({0, 0, 1.03}), 0.0, 0.03 * 0.03);  // s is the distance to first order
}

// A point whose projection misses the surface has no height of its own.
TEST(ReliefNoise, BelongsToTheSurface) {
  constexpr double kApart = 0.05;
  const Covered ball(sphere_recipe(1.0), kApart, 0.1, [](const Vec3d&) { return 0.03; });
  CounterRandom random(5);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d p = random_direction(random);
    for (const double near : {-0.4, 0.4}) ASSERT_NEAR(ball.at((1.0 + near * kApart) * p), 0.03, 3e-6) << i;
    for (const double far : {-2.5, 2.5}) ASSERT_EQ(ball.at((1.0 + far * kApart) * p), 0.0) << i;
  }
}

// A spline smooths a wave of wave number k by a share of about (k spacing)^2 / 6 along each of two axes.
TEST(ReliefNoise, FollowsItsHeights) {
  const Covered ball(sphere_recipe(1.0), 0.04, 0.1, waves);
  CounterRandom random(4);
  double squares = 0.0;
  constexpr int kPoints = 5000;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3d p = random_direction(random);
    const double error = ball.at(p) - waves(p);
    squares += error * error;
  }
  EXPECT_LT(std::sqrt(squares / kPoints), 0.02 * 0.02);
}

TEST(ReliefNoise, HasTheBitsOfOnePointInABatch) {
  const Covered potato(potato_recipe(60, 5), 0.02, 0.05, waves);
  CounterRandom random(7);
  std::vector<float> x, y, z;
  for (int i = 0; i < 1500; ++i) {
    x.push_back(static_cast<float>(random.uniform(-0.7, 0.7)));
    y.push_back(static_cast<float>(random.uniform(-0.5, 0.5)));
    z.push_back(static_cast<float>(random.uniform(-0.5, 0.5)));
  }
  std::vector<float> heights(x.size());
  const ArrayView& arrays = potato.field.tables().arrays;
  evaluate_heights(potato.noise, arrays, static_cast<int>(x.size()), x.data(), y.data(), z.data(),
                   heights.data());
  int others = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    ASSERT_EQ(math::to_bits(heights[i]), math::to_bits(height_at(potato.noise, arrays, {x[i], y[i], z[i]})))
        << i;
    others += heights[i] != 0.0f;
  }
  EXPECT_GT(others, 100);
}

// Neighbours differ in proportion to their distance: there are no steps between cells or maps.
TEST(ReliefNoise, HasNoJumps) {
  const Covered ball(sphere_recipe(1.0), 0.05, 0.1, [](const Vec3d& p) { return waves(17.0 * p); });
  const auto largest_jump = [&](double step) {
    CounterRandom random(13);
    double largest = 0.0;
    for (int i = 0; i < 40000; ++i) {
      const Vec3d p = random_direction(random);
      const Vec3d q = normalized(p + step * normalized(cross(p, random_direction(random))));
      largest = std::max(largest, std::fabs(ball.at(p) - ball.at(q)));
    }
    return largest;
  };
  const double wide = largest_jump(1e-2), narrow = largest_jump(1e-3);
  EXPECT_LT(narrow, 0.13 * wide);
}

TEST(ReliefNoise, StaysWithinItsBounds) {
  const Covered ball(sphere_recipe(1.0), 0.05, 0.1, waves);
  CounterRandom random(11);
  const auto mean_width = [&](double half) {  // of the bounds of boxes, the heights in them checked
    double widths = 0.0;
    constexpr int kBoxes = 200;
    for (int i = 0; i < kBoxes; ++i) {
      const Vec3d p = random_direction(random), side{half, half, half};
      const Box box{p - side, p + side};
      const Interval bound = bound_heights(ball.noise, ball.field.tables().arrays, box);
      widths += bound.high - bound.low;
      for (int k = 0; k < 50; ++k) {
        const Vec3d q{random.uniform(box.min.x, box.max.x), random.uniform(box.min.y, box.max.y),
                      random.uniform(box.min.z, box.max.z)};
        const double h = ball.at(q);
        EXPECT_TRUE(h >= bound.low && h <= bound.high) << half << " " << i;
      }
    }
    return widths / kBoxes;
  };
  const double wide = mean_width(0.05);
  EXPECT_LT(wide, 0.5 * 0.04);  // the range of all heights
  EXPECT_LT(mean_width(0.005), 0.5 * wide);
  EXPECT_LT(mean_width(0.0005), 0.1 * wide);
}

// A disc is thinner than a cell. Its upper and lower side have heights of their own.
TEST(ReliefNoise, TellsTheSidesOfAThinBodyApart) {
  Recipe disc;
  disc.body = MetaballBody{};
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * 3.14159265358979 * i / 24;
    for (const double r : {0.25, 0.5, 0.75, 1.0}) {
      disc.body->spheres.push_back({{r * std::cos(angle), r * std::sin(angle), 0}, 0.14});
    }
  }
  const Covered covered(disc, 0.1, 0.1, [](const Vec3d& p) { return p.z > 0 ? 0.02 : -0.01; });
  const ImplicitField bare(disc);
  double inside = 0.0, outside = 1.0;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (inside + outside);
    (bare.inside({0.5, 0.1, middle}) ? inside : outside) = middle;
  }
  ASSERT_LT(2 * inside, 4 * 0.1);
  const double top = covered.at({0.5, 0.1, inside}), bottom = covered.at({0.5, 0.1, -inside});
  EXPECT_NEAR(top, 0.02, 1e-4);
  EXPECT_NEAR(bottom, -0.01, 1e-4);
}

TEST(ReliefNoise, MakesTheSameClosedMeshForAnyThreadCount) {
  const Recipe recipe = Covered::with_relief(potato_recipe(60, 5), 0.02, 0.05, waves);
  std::vector<Vec3f> vertices[2];
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const TriangleMesh mesh = make_coarse_mesh(ImplicitField(recipe), 64);
    const MeshTopology topology = analyze_topology(mesh);
    EXPECT_TRUE(topology.closed && topology.manifold);
    for (const Vec3d& p : mesh.vertices) vertices[threads / 3].push_back(to_float(p));
  }
  ASSERT_EQ(vertices[0].size(), vertices[1].size());
  for (std::size_t i = 0; i < vertices[0].size(); ++i) {
    ASSERT_TRUE(vertices[0][i].x == vertices[1][i].x && vertices[0][i].y == vertices[1][i].y);
  }
}

// A field takes the laid heights of another field of the recipe, in the frame of a patch too.
TEST(ReliefNoise, HasTheSameBitsInAFieldLikeAnother) {
  const Recipe recipe = Covered::with_relief(potato_recipe(8, 7), 0.1, 0.1, waves);
  const ImplicitField first(recipe);
  const PatchCube cube{{0.5, 0.1, 0.0}, 0.5};
  const ImplicitField own(recipe, "recipe", cube), like(recipe, "recipe", cube, {}, &first);
  CounterRandom random(11);
  for (int i = 0; i < 500; ++i) {
    const Vec3d p = cube.center + 0.2 * random_direction(random);
    ASSERT_EQ(own.value(p), like.value(p)) << i;
  }
}

TEST(ReliefNoise, RefusesTheHeightsOfAnotherBody) {
  Recipe recipe = Covered::with_relief(potato_recipe(60, 5), 0.02, 0.05, waves);
  recipe.body->spheres[3].radius *= 1.05;
  EXPECT_THROW(ImplicitField{recipe}, InputError);
  recipe = Covered::with_relief(potato_recipe(60, 5), 0.02, 0.05, waves);
  std::get<ReliefLayer>(recipe.layers[0]).pixels = nullptr;
  EXPECT_THROW(ImplicitField{recipe}, InputError);
}

}  // namespace
}  // namespace astrolith
