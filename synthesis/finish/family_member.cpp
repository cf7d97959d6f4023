#include "synthesis/finish/family_member.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

// Streams of a member's seed; drawn fields have those from kFirstField on.
enum MemberStream : std::uint64_t { kView, kSun, kFirstField };

double normal_within(const DrawnField& drawn, CounterRandom& random) {
  while (true) {
    const double number = *drawn.mean + *drawn.deviation * random.normal();
    if (number >= *drawn.low && number <= *drawn.high) return number;
  }
}

double log_uniform(double low, double high, CounterRandom& random) {
  const double number = low * portable::exp(random.uniform() * portable::log(high / low));
  return std::clamp(number, low, high);
}

double draw(const DrawnField& drawn, CounterRandom& random) {
  switch (drawn.distribution) {
    case Distribution::kLogUniform:
      return log_uniform(*drawn.low, *drawn.high, random);
    case Distribution::kNormal:
      return normal_within(drawn, random);
    case Distribution::kInteger:
      return *drawn.low +
             static_cast<double>(random.below(static_cast<std::uint64_t>(*drawn.high - *drawn.low) + 1));
    case Distribution::kChoice:
      return drawn.values[random.below(drawn.values.size())];
    case Distribution::kUniform:
      break;
  }
  return random.uniform(*drawn.low, *drawn.high);
}

// Uniform over the directions whose z is at least `least_z`.
Vec3d any_direction(double least_z, CounterRandom random) {
  const double z = random.uniform(least_z, 1.0), angle = 6.283185307179586 * random.uniform();
  const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {across * portable::cos(angle), across * portable::sin(angle), z};
}

// Draws the fields of a family for a member with this seed.
void draw_fields(const Family& family, std::uint64_t seed, FamilyMember& member) {
  std::vector<std::string_view> fields;
  std::vector<double> numbers;
  for (const DrawnField& drawn : family.fields) {
    CounterRandom random(seed, kFirstField + fields.size());
    fields.push_back(drawn.field);
    numbers.push_back(draw(drawn, random));
    member.drawn.emplace_back(drawn.field, numbers.back());
  }
  set_numbers(member.recipe, fields, numbers);
  validate_recipe(member.recipe, "recipe");
}

}  // namespace

FamilyMember family_member(const Recipe& recipe, std::uint64_t number) {
  const std::uint64_t seed =
      recipe.family || recipe.population ? CounterRandom(recipe.seed, number).next() >> 11 : number;
  FamilyMember member{recipe,
                      {},
                      {},
                      any_direction(-1.0, CounterRandom(seed, kView)),
                      any_direction(0.0, CounterRandom(seed, kSun))};
  member.recipe.family.reset();
  member.recipe.seed = seed;
  if (recipe.family) draw_fields(*recipe.family, seed, member);
  if (recipe.population) {
    member.body = draw_body(member.recipe);
    member.recipe = member.body->recipe;
  }
  return member;
}

}  // namespace astrolith
