#include "synthesis/body/body_tables.h"

#include "geometry/mesh_topology.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/lone_body.h"

namespace astrolith {
namespace {

OperatorParameters<double> r_function(Operator kind, double alpha) {
  OperatorParameters<double> o;
  o.kind = kind;
  o.alpha = alpha;
  return o;
}

TEST(BodyOperators, AreTheFormulas) {
  CounterRandom random(1);
  for (int i = 0; i < 2000; ++i) {
    const double f = random.normal(), g = random.normal(), alpha = random.uniform(-0.9, 1.0);
    const double root = std::sqrt(f * f + g * g - 2 * alpha * f * g), scale = 1 / (1 + alpha);
    EXPECT_NEAR(combined(r_function(Operator::kUnion, alpha), f, g), scale * (f + g + root), 1e-12);
    EXPECT_NEAR(combined(r_function(Operator::kIntersection, alpha), f, g), scale * (f + g - root), 1e-12);
    EXPECT_NEAR(combined(r_function(Operator::kDifference, alpha), f, g),
                scale * (f - g - std::sqrt(f * f + g * g + 2 * alpha * f * g)), 1e-12);
    EXPECT_NEAR(combined(r_function(Operator::kUnion, 1.0), f, g), std::max(f, g), 1e-9);
    OperatorParameters<double> blend{Operator::kBlend, 1.0, random.uniform(1.0, 8.0), 0.7, 0.0, {0.0, 0.0}};
    const double a = std::max(0.0, 1 + f / 0.7), b = std::max(0.0, 1 + g / 0.7), n = blend.exponent;
    const double norm = std::pow(std::pow(a, n) + std::pow(b, n), 1 / n);
    if (norm > 0) {
      EXPECT_NEAR(combined(blend, f, g), 0.7 * (norm - 1), 1e-9);
    } else {
      EXPECT_EQ(combined(blend, f, g), std::max(f, g));
    }
    OperatorParameters<double> clean{Operator::kCleanUnion, 1.0, 1.0, 1.0, -0.2, {2.0, 0.5}};
    EXPECT_NEAR(combined(clean, f, g),
                f + g + std::sqrt(f * f + g * g) - 0.2 / (1 + 4 * f * f + 0.25 * g * g), 1e-12);
  }
}

// Floats keep their digits deep inside or far outside, where one operand is a thousand times the other.
TEST(BodyOperators, KeepTheirDigitsInFloat) {
  for (const double alpha : {-0.9, 0.0, 0.5, 1.0}) {
    OperatorParameters<float> o;
    for (const Operator kind : {Operator::kUnion, Operator::kIntersection, Operator::kDifference}) {
      o.kind = kind;
      o.alpha = static_cast<float>(alpha);
      for (const float f : {-1e-3f, 1e-3f}) {
        for (const float g : {-1e3f, -0.2f, 0.2f, 1e3f}) {
          const double exact = combined(r_function(kind, static_cast<double>(o.alpha)), double{f}, double{g});
          EXPECT_NEAR(combined(o, f, g), exact, 1e-5 * std::fabs(exact)) << operator_word(kind);
        }
      }
    }
  }
}

MetaballBody ball(const Vec3d& center, double radius) {
  MetaballBody body;
  body.spheres = {{center, radius}};
  return body;
}

Recipe two_balls(const BodyOperation& operation) {
  Recipe recipe;
  recipe.body = ball({0, 0, 0}, 1.0);
  recipe.body->operations = {operation};
  recipe.body->operations[0].operand = {ball({1.1, 0, 0}, 0.8)};
  validate_recipe(recipe, "two balls");
  return recipe;
}

TEST(BodyTables, TheSlopeIsBoundedByThatOfTheSteepestPart) {
  MetaballBody steep = ball({1.1, 0, 0}, 0.8);
  steep.warp = Warp{0.1, 5.0, 2, 0.5, 2.0};
  MetaballBody both = *two_balls({}).body;
  both.operations[0].operand = {steep};
  EXPECT_GE(testing::LoneBody(both, 1).tables().lipschitz_bound,
            testing::LoneBody(steep, 1).tables().lipschitz_bound);
}

TEST(BodyTables, RFunctionsAreBooleanOnTheBodies) {
  for (const double alpha : {-0.5, 0.0, 0.7, 1.0}) {
    BodyOperation operation;
    operation.alpha = alpha;
    const auto with = [&](Operator kind) {
      operation.kind = kind;
      return ImplicitField(two_balls(operation));
    };
    const ImplicitField both = with(Operator::kUnion), common = with(Operator::kIntersection),
                        rest = with(Operator::kDifference);
    CounterRandom random(3);
    for (int i = 0; i < 2000; ++i) {
      const Vec3d p{random.uniform(-1.5, 2.5), random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)};
      const double f = 1.0 - norm(p), g = 0.8 - norm(p - Vec3d{1.1, 0, 0});
      if (std::fabs(f) < 1e-4 || std::fabs(g) < 1e-4) continue;
      EXPECT_EQ(both.inside(p), f > 0 || g > 0);
      EXPECT_EQ(common.inside(p), f > 0 && g > 0);
      EXPECT_EQ(rest.inside(p), f > 0 && g < 0);
    }
    EXPECT_NEAR(both.bounds().max.x, 1.9, 0.15);
    EXPECT_NEAR(common.bounds().min.x, 0.3, 0.15);
    EXPECT_NEAR(rest.value({-1.01, 0, 0}), -0.01, 1e-3);  // the first surface keeps its distances
  }
}

TEST(BodyTables, BlendsFillTheCreaseAndNothingElse) {
  BodyOperation operation;
  operation.kind = Operator::kBlend;
  operation.width = 0.3;
  operation.exponent = 2.0;
  const ImplicitField blend(two_balls(operation));
  const Vec3d crease{0.71364, 0.70052, 0.0};  // on both surfaces
  EXPECT_NEAR(blend.value(crease), 0.3 * (std::sqrt(2.0) - 1.0), 1e-3);
  EXPECT_TRUE(blend.inside(crease + Vec3d{0.02, 0.05, 0}));
  EXPECT_FALSE(blend.inside({-1.01, 0, 0}));
  EXPECT_TRUE(blend.inside({-0.99, 0, 0}));
  operation.kind = Operator::kCleanUnion;
  operation.bulge = -0.1;
  operation.reach[0] = operation.reach[1] = 0.1;
  const ImplicitField carved(two_balls(operation));
  EXPECT_NEAR(carved.value(crease), -0.1, 1e-3);
  EXPECT_NEAR(carved.value({-1.0, 0, 0}), -0.1 / 82.0, 1e-3);
}

MetaballBody random_tree(CounterRandom& random, int depth) {
  MetaballBody body =
      *testing::potato_recipe(1 + static_cast<int>(random.below(20)), random.next(), random.uniform(1, 8))
           .body;
  body.kernel = kKernels[random.below(5)];
  if (random.uniform() < 0.3) body.warp = Warp{random.uniform(-0.1, 0.1), random.uniform(1, 5), 2, 0.5, 2.0};
  for (auto left = random.below(3); depth > 0 && left > 0; --left) {
    BodyOperation o;
    o.kind = kOperators[random.below(5)];
    o.alpha = random.uniform(-0.9, 1.0);
    o.exponent = random.uniform(1.0, 8.0);
    o.width = random.uniform(0.01, 0.3);
    o.bulge = random.uniform(-0.05, 0.05);
    o.reach[0] = random.uniform(0.02, 0.3);
    o.reach[1] = random.uniform(0.02, 0.3);
    o.operand = {random_tree(random, depth - 1)};
    const Vec3d shift{random.uniform(-0.4, 0.4), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)};
    for (Sphere& s : o.operand[0].spheres) s.center += shift;
    body.operations.push_back(std::move(o));
  }
  return body;
}

Recipe random_recipe(CounterRandom& random, int k) {
  Recipe recipe;
  recipe.seed = static_cast<std::uint64_t>(k);
  recipe.body = random_tree(random, 2);
  if (recipe.body->operations.empty()) recipe.body = two_balls({}).body;
  if (k % 2 == 1)
    recipe.layers = {testing::fractal_layer(std::pow(10.0, random.uniform(-3.0, -1.3)), 4.0, 4)};
  if (k % 10 == 9) recipe.layers.push_back(testing::gabor_layer(0.02, 0.003));
  validate_recipe(recipe, "random");
  return recipe;
}

// Boxes that are classified as outside or inside hold no point of the other kind. Distances keep their
// bounds.
TEST(BodyTables, BoundsAreNeverWrong) {
  CounterRandom random(10);
  int proved = 0;
  for (int k = 0; k < 40; ++k) {
    const Recipe recipe = random_recipe(random, k);
    const ImplicitField field(recipe);
    const testing::LoneBody body(*recipe.body, recipe.seed);
    if (field.bounds().empty()) continue;
    for (int b = 0; b < 20; ++b) {
      const Box all = field.bounds();
      const Vec3d corner = testing::random_point(random, all);
      const double size = std::pow(10.0, random.uniform(-2.5, -0.7));
      const Box box{corner, corner + Vec3d{size, size, size}};
      const Interval bound = body.bound(box, 0.3 * size);
      const FieldBlock block = field.gather(box);
      const BlockContent content = block.content();
      proved += content != BlockContent::kMixed;
      std::vector<float> value(60), s(60), gx(60), gy(60), gz(60);
      const auto [x, y, z] = testing::FloatPoints(random, box, value.size());
      block.evaluate(x, y, z, value);
      body.evaluate(60, x.data(), y.data(), z.data(), s.data(), gx.data(), gy.data(), gz.data());
      for (std::size_t i = 0; i < value.size(); ++i) {
        ASSERT_GE(s[i], bound.low);
        ASSERT_LE(s[i], bound.high);
        ASSERT_TRUE(content == BlockContent::kMixed ||
                    (value[i] > 0.0f) == (content == BlockContent::kInside));
        if (i % 20 == 0) {
          ASSERT_EQ(static_cast<double>(value[i]), field.value({x[i], y[i], z[i]}));
        }
      }
    }
  }
  EXPECT_GT(proved, 250);
}

TEST(BodyTables, GradientsAreUnitNormalsOnTheSurface) {
  BodyOperation operation;
  operation.alpha = 0.0;
  const testing::LoneBody body(*two_balls(operation).body, 1);
  const float x = -0.6f, y = 0.8f, z = 0.0f;
  float s = 0, gx = 0, gy = 0, gz = 0;
  body.evaluate(1, &x, &y, &z, &s, &gx, &gy, &gz);
  EXPECT_NEAR(s, 0.0, 1e-5);
  EXPECT_LT(norm(Vec3d{gx, gy, gz} - Vec3d{0.6, -0.8, 0.0}), 2e-3);
}

}  // namespace
}  // namespace astrolith
