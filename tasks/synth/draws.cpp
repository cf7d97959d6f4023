#include "tasks/synth/draws.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>
#include <string_view>

#include "numerics/errors.h"
#include "numerics/length_unit.h"
#include "recipe/recipe_json.h"
#include "synthesis/finish/known_population.h"
#include "tasks/job/body_library.h"
#include "tasks/job/load_recipe.h"
#include "tasks/synth/finish.h"

namespace astrolith {
namespace {

constexpr std::array kOptions{"--diameter", "--axes", "--class", "--source", "--near", "--details"};

double parse_number(std::string_view text, std::string_view option, std::string_view form) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !(number > 0.0)) {
    throw InputError(fmt::format("{}: must be {}, with numbers above 0", option, form));
  }
  return number;
}

// A value, and its spread where "+-" stands behind it.
struct Spread {
  std::string_view value;
  std::optional<double> deviation;
};
Spread parse_spread(std::string_view text, std::string_view option, std::string_view form) {
  const std::size_t at = text.find("+-");
  if (at == std::string_view::npos) return {text, {}};
  return {text.substr(0, at), parse_number(text.substr(at + 2), option, form)};
}

void set_diameter(const std::string& text, DrawConditions& draw) {
  constexpr std::string_view kForm = "a diameter, as in 330 or 330+-20";
  const Spread spread = parse_spread(text, "--diameter", kForm);
  draw.diameter = parse_number(spread.value, "--diameter", kForm);
  draw.diameter_deviation = spread.deviation.value_or(0.0);
}

void set_axes(const std::string& text, DrawConditions& draw) {
  constexpr std::string_view kForm =
      "the ratios of the axes, longest first, as in 1.4:1.1:1 or 1.4:1.1:1+-0.05";
  const Spread spread = parse_spread(text, "--axes", kForm);
  if (spread.deviation) draw.axes_deviation = *spread.deviation;
  draw.axes.clear();
  for (std::string_view rest = spread.value; draw.axes.size() < 4;) {
    const std::size_t colon = rest.find(':');
    draw.axes.push_back(parse_number(rest.substr(0, colon), "--axes", kForm));
    if (colon == std::string_view::npos) break;
    rest.remove_prefix(colon + 1);
  }
}

template <class T, std::size_t n>
void set_word(const std::string& text, const T (&values)[n], std::string_view (*to_word)(T),
              std::optional<T>& value) {
  for (const T candidate : values) {
    if (to_word(candidate) == text) value = candidate;
  }
}

// The known body whose landforms lie on one of this size (metres) and class.
std::string_view known_body(double diameter, BodyClass kind) {
  constexpr double kRubblePile = 1000.0;
  if (diameter > kRubblePile) return "eros";
  if (kind == BodyClass::kTop) return "bennu";
  return kind == BodyClass::kElongated || kind == BodyClass::kContactBinary ? "itokawa" : "ryugu";
}

}  // namespace

void declare_draw_options(Job& job, DrawOptions& options) {
  job.options
      .add_option("--diameter", options.diameter,
                  "of a population: the diameter of the sphere of equal volume, in the recipe's unit, with "
                  "its standard "
                  "deviation where there is one, as in 330+-20")
      .placeholder("D[+-S]")
      .default_text("between those of the donors");
  job.options
      .add_option(
          "--axes", options.axes,
          "of a population: the ratios of the three axes, longest first, with the standard deviation of "
          "their "
          "logarithms, as in 1.4:1.1:1+-0.1; a light curve gives the first, a long apparition the second")
      .placeholder("A:B:C[+-S]")
      .default_text("near those of measured bodies");
  job.options.add_option("--class", options.kind, "of a population: what the donors look like")
      .check(one_of({"top", "contact_binary", "elongated", "rounded", "fragment"}))
      .default_text("any");
  job.options
      .add_option(
          "--source", options.source,
          "of a population: how the donors were measured; models from radar and light curves are smoother")
      .check(one_of({"camera", "radar", "adaptive_optics", "light_curve"}))
      .default_text("any");
  job.options
      .add_option(
          "--near", options.near,
          "of a population: a body that has the largest share in each draw, so that all are its neighbours")
      .placeholder("BODY")
      .default_text("any");
  job.options
      .add_option(
          "--details", options.details,
          "of a population: what lies on a drawn body. relief: the ground of the measured body that is most "
          "like it in size and class, laid as --laid lays it, or as --like where that is given; laws: "
          "craters "
          "and boulders by the counts of a known body of its size, as --finish draws them, down to a quarter "
          "of the finest size; "
          "all: both; auto: the relief where the population has any; none")
      .check(one_of({"auto", "all", "relief", "laws", "none"}));
}

Recipe with_ground(Job& job, const DrawOptions& options, const FamilyMember& member,
                   const BodyPopulation& population, const std::filesystem::path& file) {
  Recipe recipe = member.recipe;
  if (options.details == "none" && options.like)
    throw InputError(
        "--like: ends the ground of a measured body, and --details none has none; leave out one of them");
  if (options.details == "none") return recipe;
  const MeasuredBody* donor = options.details == "laws" ? nullptr : ground_donor(*member.body, population);
  if (donor == nullptr && (options.details == "relief" || options.details == "all")) {
    throw InputError(file.string() +
                     ": population: has no body with a relief; fit_population takes recipes of fit_shape "
                     "with one, or leave out --details");
  }
  if (donor == nullptr && options.like) {
    throw InputError(
        "--like: ends the ground of a measured body, and this draw has none; leave it out, or take "
        "--details relief or all of a population with reliefs");
  }
  job.summary["drawn_body"]["ground"] = donor == nullptr ? "" : donor->name;
  if (donor != nullptr) {
    const std::filesystem::path donor_file = find_body(file).parent_path() / donor->recipe;
    recipe = lay_ground(*member.body, *donor, load_recipe(donor_file), donor_file.string());
    if (options.like) std::get<ReliefLayer>(recipe.layers.front()).arrangement = ReliefArrangement::kLike;
    job.say("ground of " + donor->name);
  }
  if (options.details == "relief" || options.details == "auto") return recipe;
  constexpr double kFiner = 0.25;
  const double meters = metres_per_unit(recipe.length_unit);
  const FinishOptions laws{std::string(known_body(member.body->diameter * meters, member.body->kind)), 0.0,
                           kFiner * finest_size(recipe)};
  return finished(job, laws, recipe, file.string(), 0.0);
}

void apply_conditions(const Job& job, const DrawOptions& options, const std::filesystem::path& file,
                      Recipe& recipe) {
  if (!recipe.population) {
    for (const char* option : kOptions) {
      if (job.options.option(option).count() == 0) continue;
      throw InputError(fmt::format(
          "{}: {}: is one body, and {} is about draws; name a population, such as asteroids (with "
          "--near {} for bodies like it)",
          option, file.string(), option, file.stem().string()));
    }
    return;
  }
  DrawConditions& draw = recipe.population->draw;
  if (!options.diameter.empty()) set_diameter(options.diameter, draw);
  if (!options.axes.empty()) set_axes(options.axes, draw);
  set_word(options.kind, kBodyClasses, class_word, draw.kind);
  set_word(options.source, kShapeSources, source_word, draw.source);
  if (!options.near.empty()) draw.near = options.near;
  validate_recipe(recipe, file.string());
}

void report_draw(Job& job, const FamilyMember& member) {
  if (!member.body) return;
  auto donors = nlohmann::ordered_json::array();
  for (const Donor& donor : member.recipe.body->morph->donors) {
    donors.push_back({{"name", donor.name}, {"share", donor.share}});
  }
  job.summary["drawn_body"] = {{"diameter", member.body->diameter},
                               {"class", std::string(class_word(member.body->kind))},
                               {"donors", std::move(donors)},
                               {"attempts", member.body->attempts}};
  job.say(member.recipe.description);
}

}  // namespace astrolith
