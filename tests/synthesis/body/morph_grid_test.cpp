#include "synthesis/body/morph_grid.h"

#include <cmath>
#include <string>

#include "geometry/mesh_topology.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_at_point.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/points.h"
#include "tests/synthesis/block_lists.h"
#include "tests/synthesis/lone_body.h"

namespace astrolith {
namespace {

MetaballBody ball(double radius) {
  MetaballBody body;
  body.spheres = {{{}, radius}};
  return body;
}

Donor make_donor(const MetaballBody& body, const Vec3d& half_axes, double share) {
  Donor donor;
  donor.share = share;
  donor.half_axes = half_axes;
  donor.body = {body};
  return donor;
}

MetaballBody make_morph(const Vec3d& half_axes, std::vector<Donor> donors) {
  MetaballBody body;
  body.morph = Morph{half_axes, {}, 1.0, std::move(donors)};
  return body;
}

// A ball with a nose at +x +y, so that mirrors and turns show.
MetaballBody nosed() {
  MetaballBody body = ball(1.0);
  body.a = body.b = 2.0;
  body.spheres.push_back({{0.75, 0.55, 0.2}, 0.5});
  return body;
}

struct Sample {
  float s, gx, gy, gz;
};
Sample sample(const testing::LoneBody& body, const Vec3d& p) {
  const Vec3f q = to_float(p);
  Sample out{};
  body.evaluate(1, &q.x, &q.y, &q.z, &out.s, &out.gx, &out.gy, &out.gz);
  return out;
}

// Balls of any size, stretched, are the ellipsoid itself, whatever their shares and however rough the morph.
TEST(MorphGrid, OfBallsIsTheEllipsoid) {
  const Vec3d axes{3.0, 2.0, 1.5};
  MetaballBody body =
      make_morph(axes, {make_donor(ball(1.0), {1, 1, 1}, 0.2), make_donor(ball(7.0), {7, 7, 7}, 3.0)});
  body.morph->roughness = 1.7;
  const testing::LoneBody lone(body, 1);
  CounterRandom random(3);
  for (int i = 0; i < 500; ++i) {
    const Vec3d u = testing::random_direction(random);
    const Vec3d on{axes.x * u.x, axes.y * u.y, axes.z * u.z};
    const Vec3d n = normalized(Vec3d{u.x / axes.x, u.y / axes.y, u.z / axes.z});
    // The spline adds spacing^2 / 6 times the Laplacian of the distance, up to 2.1 at the long end.
    EXPECT_NEAR(sample(lone, on).s, 0.0, 1e-2);
    EXPECT_NEAR(sample(lone, on + 0.2 * n).s, -0.2, 0.01);
    EXPECT_NEAR(sample(lone, on - 0.2 * n).s, 0.2, 0.02);
  }
}

// Two donors that are one body give that body, at its own axes: the variance that is kept is that of its
// residual times the root of two.
TEST(MorphGrid, KeepsTheVarianceOfResiduals) {
  const Vec3d own{1.1, 1.0, 0.95};
  const auto donor = make_donor(nosed(), own, 1.0);
  MetaballBody body = make_morph(own, {donor, donor});
  body.morph->roughness = 1.0 / std::sqrt(2.0);
  const testing::LoneBody lone(body, 1), alone(nosed(), 1);
  CounterRandom random(4);
  int compared = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3d p = (1.0 + 0.6 * random.uniform()) * testing::random_direction(random);
    const float s = sample(alone, p).s;
    if (std::fabs(s) > 0.02f) continue;
    EXPECT_NEAR(sample(lone, p).s, s, 0.012);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

TEST(MorphGrid, MirrorsAndTurnsDonors) {
  const Vec3d axes{1.4, 1.0, 0.8}, own{1.1, 1.1, 0.95};
  const auto body_with = [&](bool mirrored, double turn) {
    Donor donor = make_donor(nosed(), own, 1.0);
    donor.mirror[0] = mirrored;
    donor.turn = turn;
    return make_morph(axes, {donor, make_donor(ball(1.0), {1, 1, 1}, 1.0)});
  };
  const testing::LoneBody plain(body_with(false, 0.0), 1), mirrored(body_with(true, 0.0), 1),
      turned(body_with(false, 180.0), 1);
  CounterRandom random(5);
  for (int i = 0; i < 300; ++i) {
    const Vec3d p = 1.2 * testing::random_direction(random);
    // Where feet on two sides are as near as each other, the order of the sweeps chooses one.
    if (std::fabs(sample(plain, p).s) > 0.2f) continue;
    EXPECT_NEAR(sample(mirrored, {-p.x, p.y, p.z}).s, sample(plain, p).s, 1e-3);
    EXPECT_NEAR(sample(turned, {-p.x, -p.y, p.z}).s, sample(plain, p).s, 1e-3);
  }
}

MetaballBody example_body() { return *read_recipe(ASTROLITH_EXAMPLES "/drawn_body.json").body; }

// Bounds over boxes of all sizes, some of them beyond the domain, hold s.
TEST(MorphGrid, BoundsHoldTheDistance) {
  const testing::LoneBody lone(example_body(), 1);
  CounterRandom random(6);
  int decided = 0;
  for (int i = 0; i < 400; ++i) {
    const double distance = 600.0 * random.uniform();
    const Vec3d c = distance * testing::random_direction(random);
    const double half = 100.0 * std::pow(10.0, -3.0 * random.uniform());
    const Box box{c - Vec3d{half, half, half}, c + Vec3d{half, half, half}};
    const Interval s = lone.bound(box, 0.0);
    decided += s.low > 0.0 || s.high < 0.0;
    for (int k = 0; k < 20; ++k) {
      const Vec3d p{random.uniform(box.min.x, box.max.x), random.uniform(box.min.y, box.max.y),
                    random.uniform(box.min.z, box.max.z)};
      const double value = double{sample(lone, p).s};
      ASSERT_GE(value, s.low) << half;
      ASSERT_LE(value, s.high) << half;
    }
  }
  EXPECT_GT(decided, 150);
}

// On the surface most bounds are at most four times as wide as a distance can differ within the box.
TEST(MorphGrid, BoundsAreTight) {
  const testing::LoneBody lone(example_body(), 1);
  CounterRandom random(8);
  int near = 0, tight = 0;
  for (int i = 0; i < 2000; ++i) {
    const double distance = 250.0 * random.uniform();
    const Vec3d p = distance * testing::random_direction(random);
    const Sample at = sample(lone, p);
    if (std::fabs(at.s) > 10.0f) continue;
    const Vec3d c = p - double{at.s} * Vec3d{at.gx, at.gy, at.gz};
    const double half = std::pow(10.0, 1.0 - 3.0 * random.uniform());
    const Interval s = lone.bound({c - Vec3d{half, half, half}, c + Vec3d{half, half, half}}, 0.0);
    ++near;
    tight += s.high - s.low < 4.0 * std::sqrt(12.0) * half;
  }
  EXPECT_GT(near, 50);
  EXPECT_GT(tight, 0.8 * near) << near;
}

// s is a first-order distance with a unit gradient: where it is small, the surface is as far away as it says.
TEST(MorphGrid, GradientIsThatOfTheDistance) {
  const testing::LoneBody lone(example_body(), 1);
  CounterRandom random(7);
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d p = 250.0 * random.uniform() * testing::random_direction(random);
    const Sample at = sample(lone, p);
    if (std::fabs(at.s) > 1.0f) continue;
    const Vec3d g{at.gx, at.gy, at.gz};
    EXPECT_NEAR(norm(g), 1.0, 1e-3);
    EXPECT_NEAR(sample(lone, p - double{at.s} * g).s, 0.0, 0.03);
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

// The surface of a drawn body is one closed piece, the same when it is evaluated point by point.
TEST(MorphGrid, MakesOnePiece) {
  Recipe recipe;
  recipe.body = example_body();
  const ImplicitField field(recipe);
  const MeshTopology topology = analyze_topology(make_coarse_mesh(field, 48));
  EXPECT_TRUE(topology.closed);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.genus, 0);
  const FieldView& tables = field.tables();
  const Box box{{150, -30, -30}, {210, 30, 30}};
  BlockListStore blocks(tables);
  blocks.add(tables, box);
  const FieldBlock block = field.gather(box);
  CounterRandom random(8);
  for (int i = 0; i < 200; ++i) {
    const float x = static_cast<float>(random.uniform(150, 210)),
                y = static_cast<float>(random.uniform(-30, 30)),
                z = static_cast<float>(random.uniform(-30, 30));
    float value = 0.0f;
    block.evaluate({&x, 1}, {&y, 1}, {&z, 1}, {&value, 1}, kExactEverywhere);
    EXPECT_EQ(math::to_bits(field_at(tables, blocks.view().block(0), {x, y, z}, kExactEverywhere)),
              math::to_bits(value));
  }
}

// A rough morph that reaches the end of its grid is refused.
TEST(MorphGrid, RefusesShapesThatLeaveItsDomain) {
  MetaballBody far = ball(1.0);
  far.spheres.push_back({{2.6, 0, 0}, 0.4});
  far.spheres.push_back({{1.4, 0, 0}, 0.7});
  const Donor donor = make_donor(far, {1, 1, 1}, 1.0);
  const MetaballBody body = make_morph({1, 1, 1}, {donor, donor});
  EXPECT_THROW(testing::LoneBody(body, 1), InputError);
}

// A field that is like another takes its grids, those of operands, too, and has the same values under other
// layers.
TEST(MorphGrid, IsTakenFromAFieldThatIsLike) {
  Recipe recipe;
  recipe.body = make_morph({3.0, 2.0, 1.5},
                           {make_donor(nosed(), {1, 1, 1}, 1.0), make_donor(ball(1.0), {1, 1, 1}, 1.0)});
  BodyOperation joined;
  joined.operand = {make_morph({1.5, 2.5, 1.0},
                               {make_donor(ball(1.0), {1, 1, 1}, 1.0), make_donor(nosed(), {1, 1, 1}, 2.0)})};
  recipe.body->operations = {joined};
  const ImplicitField first(recipe);
  FractalLayer hills;
  hills.amplitude = 0.1;
  recipe.layers = {hills};
  const ImplicitField own(recipe), like(recipe, "recipe", {}, {}, &first);
  CounterRandom random(3, 0);
  for (int i = 0; i < 200; ++i) {
    const Vec3d p = testing::random_point(random, testing::cube_about_origin(3.0));
    ASSERT_EQ(own.value(p), like.value(p)) << i;
  }
}

}  // namespace
}  // namespace astrolith
