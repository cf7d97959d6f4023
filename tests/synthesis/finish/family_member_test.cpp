#include "synthesis/finish/family_member.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

DrawnField drawn(const std::string& field, Distribution distribution, double low, double high) {
  DrawnField result;
  result.field = field;
  result.distribution = distribution;
  result.low = low;
  result.high = high;
  return result;
}

Recipe ball() {
  Recipe recipe;
  recipe.body = MetaballBody{};
  recipe.body->spheres = {{{0, 0, 0}, 1.0}};
  recipe.layers = {FractalLayer{}, FractalLayer{}};
  recipe.seed = 5;
  return recipe;
}

Recipe make_family(std::vector<DrawnField> fields) {
  Recipe recipe = ball();
  recipe.family = Family{std::move(fields)};
  return recipe;
}

// The largest distance between the distribution of the numbers that 1,000 members draw and `share_below`.
double largest_distance(const Recipe& recipe, const std::function<double(double)>& share_below) {
  constexpr int kMembers = 1000;
  std::vector<double> numbers;
  for (std::uint64_t k = 0; k < kMembers; ++k) numbers.push_back(family_member(recipe, k).drawn.at(0).second);
  std::sort(numbers.begin(), numbers.end());
  double largest = 0.0;
  for (int i = 0; i < kMembers; ++i) {
    const double expected = share_below(numbers[static_cast<std::size_t>(i)]);
    largest = std::max({largest, std::abs(expected - i / double{kMembers}),
                        std::abs(expected - (i + 1) / double{kMembers})});
  }
  return largest;
}

// Kolmogorov and Smirnov: 1,000 numbers of the distribution lie farther away in 1 % of cases.
constexpr double kOnePercent = 1.628 / 31.623;

TEST(FamilyMember, DrawsFromTheDistributionsThatTheRecipeStates) {
  EXPECT_LT(largest_distance(make_family({drawn("layers[0].amplitude", Distribution::kUniform, 2.0, 6.0)}),
                             [](double x) { return (x - 2.0) / 4.0; }),
            kOnePercent);
  EXPECT_LT(
      largest_distance(make_family({drawn("layers[0].amplitude", Distribution::kLogUniform, 0.01, 10.0)}),
                       [](double x) { return std::log(x / 0.01) / std::log(1000.0); }),
      kOnePercent);
  DrawnField normal = drawn("layers[0].amplitude", Distribution::kNormal, 1.0, 6.0);
  normal.mean = 3.0;
  normal.deviation = 2.0;
  const auto below = [](double x) { return 0.5 * std::erfc((3.0 - x) / (2.0 * std::sqrt(2.0))); };
  EXPECT_LT(largest_distance(make_family({normal}),
                             [&](double x) { return (below(x) - below(1.0)) / (below(6.0) - below(1.0)); }),
            kOnePercent);
}

TEST(FamilyMember, DrawsWholeNumbersAndChoicesEvenly) {
  DrawnField choice;
  choice.field = "layers[1].amplitude";
  choice.distribution = Distribution::kChoice;
  choice.values = {0.25, 0.5, 8.0};
  const Recipe recipe = make_family({drawn("layers[0].octaves", Distribution::kInteger, 2.0, 5.0), choice});
  std::vector<int> octaves(6, 0), choices(3, 0);
  for (std::uint64_t k = 0; k < 1200; ++k) {
    const FamilyMember member = family_member(recipe, k);
    ++octaves.at(static_cast<std::size_t>(std::get<FractalLayer>(member.recipe.layers[0]).octaves));
    const double chosen = std::get<FractalLayer>(member.recipe.layers[1]).amplitude;
    ++choices.at(static_cast<std::size_t>(std::find(choice.values.begin(), choice.values.end(), chosen) -
                                          choice.values.begin()));
  }
  for (int n = 2; n <= 5; ++n)
    EXPECT_NEAR(octaves[static_cast<std::size_t>(n)], 300, 60) << n;  // 4 deviations
  for (const int count : choices) EXPECT_NEAR(count, 400, 66);
}

TEST(FamilyMember, IsAFunctionOfTheRecipeAndTheNumber) {
  const Recipe recipe = make_family({drawn("layers[0].amplitude", Distribution::kUniform, 1.0, 2.0)});
  Recipe more = recipe;
  more.family->fields.push_back(drawn("layers[1].amplitude", Distribution::kUniform, 1.0, 2.0));
  const FamilyMember member = family_member(recipe, 4711);
  EXPECT_EQ(recipe_to_json(family_member(recipe, 4711).recipe), recipe_to_json(member.recipe));
  EXPECT_EQ(family_member(more, 4711).drawn.at(0), member.drawn.at(0));
  EXPECT_NE(family_member(recipe, 4712).drawn.at(0), member.drawn.at(0));
  EXPECT_NE(family_member(recipe, 4712).recipe.seed, member.recipe.seed);
  EXPECT_FALSE(member.recipe.family);
  // Pinned: a set that was begun must go on alike.
  EXPECT_EQ(member.recipe.seed, CounterRandom(recipe.seed, 4711).next() >> 11);
  EXPECT_EQ(family_member(ball(), 4711).recipe.seed, 4711u);
}

TEST(FamilyMember, HasAViewAndASunOfItsOwn) {
  double mean_height = 0.0;
  for (std::uint64_t k = 0; k < 400; ++k) {
    const FamilyMember member = family_member(ball(), k);
    EXPECT_NEAR(dot(member.view, member.view), 1.0, 1e-12);
    EXPECT_NEAR(dot(member.sun, member.sun), 1.0, 1e-12);
    EXPECT_GE(member.sun.z, 0.0);
    mean_height += member.view.z / 400.0;
  }
  EXPECT_NEAR(mean_height, 0.0, 0.12);  // four deviations of the mean of 400 uniform heights
}

TEST(FamilyMember, RefusesNumbersThatBreakARuleTogether) {
  CraterLayer craters;
  craters.population = CraterPopulation{};
  craters.population->drawn.count = 3;
  craters.population->drawn.least_diameter = 0.1;
  craters.population->drawn.greatest_diameter = 0.4;
  Recipe recipe =
      make_family({drawn("layers[2].population.least_diameter", Distribution::kUniform, 0.1, 0.3),
                   drawn("layers[2].population.greatest_diameter", Distribution::kUniform, 0.1, 0.5)});
  recipe.layers.push_back(craters);
  int refused = 0;
  for (std::uint64_t k = 0; k < 50; ++k) {
    try {
      family_member(recipe, k);
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 5);
  EXPECT_LT(refused, 30);
}

}  // namespace
}  // namespace astrolith
