#include "synthesis/finish/population_draw.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "gravity/body_mass.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/finish/family_member.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

struct Frame {
  Vec3d center, half_axes;
  std::array<Vec3d, 3> axes;
};
Frame find_frame(const TriangleMesh& mesh) {
  const BodyMass mass = body_mass(mesh);
  const PrincipalAxes principal = principal_axes(mass.inertia);
  const auto& [a, b, c] = principal.moments;
  const auto half = [&](double square) { return std::sqrt(2.5 * square / mass.volume); };
  return {mass.center, {half(b + c - a), half(a + c - b), half(a + b - c)}, principal.axes};
}

MeasuredBody measured(const std::string& name, BodyClass kind, double diameter, const Recipe& recipe) {
  const TriangleMesh mesh = make_coarse_mesh(ImplicitField(recipe), 48);
  const Frame frame = find_frame(mesh);
  MeasuredBody body;
  body.name = name;
  body.kind = kind;
  body.diameter = diameter;
  body.center = frame.center;
  body.half_axes = frame.half_axes;
  std::copy(frame.axes.begin(), frame.axes.end(), body.axes);
  body.body = {*recipe.body};
  return body;
}

// Six potatoes: two are called tops, and one of these was measured by radar.
Recipe population() {
  Recipe recipe;
  recipe.length_unit = "m";
  recipe.seed = 5;
  recipe.population.emplace();
  for (std::uint64_t i = 1; i <= 6; ++i) {
    const BodyClass kind = i <= 2 ? BodyClass::kTop : BodyClass::kElongated;
    recipe.population->bodies.push_back(measured(
        "potato_" + std::to_string(i), kind, 100.0 * static_cast<double>(i), testing::potato_recipe(25, i)));
  }
  recipe.population->bodies[0].source = ShapeSource::kRadar;
  validate_recipe(recipe, "population");
  return recipe;
}
const Recipe& shared_population() {
  static const Recipe recipe = population();
  return recipe;
}

TriangleMesh make_mesh(const Recipe& recipe) { return make_coarse_mesh(ImplicitField(recipe), 64); }

TEST(PopulationDraw, IsAFunctionOfTheSeed) {
  Recipe recipe = shared_population();
  const std::string first = recipe_to_json(draw_body(recipe).recipe);
  EXPECT_EQ(recipe_to_json(draw_body(recipe).recipe), first);
  recipe.seed = 6;
  EXPECT_NE(recipe_to_json(draw_body(recipe).recipe), first);
  EXPECT_EQ(recipe_to_json(family_member(recipe, 3).recipe), recipe_to_json(family_member(recipe, 3).recipe));
  EXPECT_NE(recipe_to_json(family_member(recipe, 3).recipe), recipe_to_json(family_member(recipe, 4).recipe));
}

// Draws are one piece of the volume, about the origin, longest along x, of donors that the population has.
TEST(PopulationDraw, GivesWholeBodiesOfTheirSize) {
  Recipe recipe = shared_population();
  recipe.population->draw.diameter = 330.0;
  recipe.population->draw.diameter_deviation = 20.0;
  double sum = 0.0, squares = 0.0;
  constexpr int kDraws = 12;
  for (recipe.seed = 0; recipe.seed < kDraws; ++recipe.seed) {
    const DrawnBody drawn = draw_body(recipe);
    const TriangleMesh mesh = make_mesh(drawn.recipe);
    const MeshTopology topology = analyze_topology(mesh);
    EXPECT_TRUE(topology.closed);
    EXPECT_EQ(topology.components, 1);
    EXPECT_EQ(topology.genus, 0);
    EXPECT_NEAR(std::cbrt(6.0 / std::numbers::pi * volume(mesh)), drawn.diameter, 0.01 * drawn.diameter);
    EXPECT_LT(norm(volume_centroid(mesh)), 0.01 * drawn.diameter);
    const Frame frame = find_frame(mesh);
    EXPECT_GT(std::fabs(frame.axes[0].x), 0.8);
    EXPECT_FALSE(drawn.recipe.population);
    double shares = 0.0;
    for (const DonorShare& donor : drawn.donors) shares += donor.share;
    EXPECT_NEAR(shares, 1.0, 0.03);
    EXPECT_TRUE(drawn.donors.size() == 2 || drawn.donors.size() == 3);
    sum += drawn.diameter;
    squares += drawn.diameter * drawn.diameter;
  }
  const double mean = sum / kDraws;
  EXPECT_NEAR(mean, 330.0, 20.0);
  EXPECT_NEAR(std::sqrt(squares / kDraws - mean * mean), 20.0, 14.0);
}

TEST(PopulationDraw, HeedsItsConditions) {
  Recipe recipe = shared_population();
  DrawConditions& draw = recipe.population->draw;
  draw.kind = BodyClass::kElongated;
  for (recipe.seed = 0; recipe.seed < 3; ++recipe.seed) {
    for (const DonorShare& donor : draw_body(recipe).donors) EXPECT_GE(donor.body, 2u);
  }
  draw.kind.reset();
  draw.near = "potato_3";
  for (recipe.seed = 0; recipe.seed < 3; ++recipe.seed) EXPECT_EQ(draw_body(recipe).donors.front().body, 2u);
  draw.near.clear();
  draw.axes = {1.6, 1.2, 1.0};
  draw.axes_deviation = 0.0;
  double longest = 0.0, middle = 0.0;
  for (recipe.seed = 0; recipe.seed < 8; ++recipe.seed) {
    const Vec3d half = find_frame(make_mesh(draw_body(recipe).recipe)).half_axes;
    longest += half.x / half.z / 8.0, middle += half.y / half.z / 8.0;
  }
  EXPECT_NEAR(longest, 1.6, 0.2);
  EXPECT_NEAR(middle, 1.2, 0.15);
}

void expect_refused(const Recipe& recipe, const std::string& words) {
  try {
    validate_recipe(recipe, "p");
    draw_body(recipe);
    ADD_FAILURE() << "drew a body: " << words;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
  }
}

TEST(PopulationDraw, RefusesWhatItCannotGive) {
  const auto with = [](const auto& change) {
    Recipe recipe = shared_population();
    change(*recipe.population);
    return recipe;
  };
  expect_refused(with([](BodyPopulation& p) { p.draw.kind = BodyClass::kRounded; }), "0 of 6 bodies fulfil");
  expect_refused(with([](BodyPopulation& p) { p.draw.source = ShapeSource::kRadar; }),
                 "1 of 6 bodies fulfil");
  expect_refused(with([](BodyPopulation& p) { p.draw.near = "eros"; }), "no body is called \"eros\"");
  expect_refused(with([](BodyPopulation& p) { p.draw.axes = {10, 1, 1}; }), "have a ratio of 10");
  expect_refused(with([](BodyPopulation& p) { p.draw.axes = {1, 1.2, 1}; }), "must begin with the longest");
  expect_refused(with([](BodyPopulation& p) { p.draw.diameter = 0.0; }), "diameter");
  expect_refused(with([](BodyPopulation& p) { p.bodies.resize(1); }), "must be at least 2");
  expect_refused(with([](BodyPopulation& p) { p.bodies[1].name = "potato_1"; }), "is there already");
  expect_refused(with([](BodyPopulation& p) { p.bodies[1].axes[0] = {1, 1, 0}; }), "right-handed");
  Recipe both = shared_population();
  both.body = MetaballBody{};
  both.body->spheres = {{{}, 1.0}};
  EXPECT_THROW(validate_recipe(both, "p"), InputError);
}

// A family's fields are drawn before the body, and may be those of the draw.
TEST(PopulationDraw, TakesFieldsOfAFamily) {
  Recipe recipe = shared_population();
  recipe.population->draw.diameter = 100.0;
  DrawnField field;
  field.field = "population.draw.diameter";
  field.low = 50.0, field.high = 60.0;
  recipe.family = Family{{field}, false, false};
  const FamilyMember member = family_member(recipe, 2);
  ASSERT_TRUE(member.body);
  EXPECT_GE(member.body->diameter, 50.0);
  EXPECT_LE(member.body->diameter, 60.0);
}

}  // namespace
}  // namespace astrolith
