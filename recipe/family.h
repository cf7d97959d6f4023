// A family of bodies: what differs from member to member of a recipe. Member k of a recipe is a function of
// the recipe and k alone, so that every machine makes it alike.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace astrolith {

// How a number is drawn. A normal one is drawn anew until it lies in [low, high].
enum class Distribution { kUniform, kLogUniform, kNormal, kInteger, kChoice };
inline constexpr Distribution kDistributions[] = {Distribution::kUniform, Distribution::kLogUniform,
                                                  Distribution::kNormal, Distribution::kInteger,
                                                  Distribution::kChoice};

// The distribution's name in recipes.
constexpr std::string_view distribution_word(Distribution distribution) {
  switch (distribution) {
    case Distribution::kLogUniform:
      return "log_uniform";
    case Distribution::kNormal:
      return "normal";
    case Distribution::kInteger:
      return "integer";
    case Distribution::kChoice:
      return "choice";
    case Distribution::kUniform:
      break;
  }
  return "uniform";
}

// A number of the recipe that each member draws.
struct DrawnField {
  std::string field;  // its path, as in "layers[0].amplitude"
  Distribution distribution = Distribution::kUniform;
  std::optional<double> low, high;        // low <= high; all but a choice
  std::optional<double> mean, deviation;  // of a normal number; deviation > 0
  std::vector<double> values;             // of a choice: one at least, each as likely as the others
};

inline constexpr int kMostDrawnFields = 100;

struct Family {
  std::vector<DrawnField> fields;  // kMostDrawnFields at most, no field twice
  bool any_view = false;           // each member's picture is taken from a direction of its own
  bool any_sun = false;            // and under a sun of its own, on the viewer's side
};

// The least and the greatest number that the field can get.
double min_value(const DrawnField& drawn);
double max_value(const DrawnField& drawn);

struct Recipe;

// Sets numbers of the recipe: the fields and their numbers, in one order. Returns the index in `fields` of
// the first that names no number of the recipe, or -1. A field that the recipe leaves out with all of its
// object, such as "erosion.talus_angle" without an erosion, names none. A whole number is needed where the
// field is one: throws InputError "recipe: layers[0].octaves: ..." for others.
int set_numbers(Recipe& recipe, const std::vector<std::string_view>& fields,
                const std::vector<double>& numbers);

}  // namespace astrolith
