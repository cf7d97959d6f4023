#include "synthesis/finish/known_population.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/length_unit.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "recipe/recipe_json.h"
#include "synthesis/body/morph_grid.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/layer_join.h"
#include "synthesis/landforms/ground_roughness.h"
#include "synthesis/landforms/population_cells.h"

namespace astrolith {
namespace {

constexpr int kPlaces = 4096;
constexpr double kLeast = 1e-4;  // of the distance: below is what rounding makes of flat ground
// Shares: kSmooth of the median roughness, the others of the ground. Boulders lie in patches of rough ground.
constexpr double kSmooth = 0.25, kSmoothest = 0.1, kRough = 0.9;

// The number of the last relief; -1 where there is none.
int last_relief(const Recipe& recipe) {
  for (int i = static_cast<int>(recipe.layers.size()) - 1; i >= 0; --i) {
    if (std::holds_alternative<ReliefLayer>(recipe.layers[static_cast<std::size_t>(i)])) return i;
  }
  return -1;
}

// A name by which no layer goes.
std::string free_name(const Recipe& recipe) {
  std::string name = "relief";
  for (int k = 2; find_layer(recipe.layers, name) >= 0; ++k) name = "relief " + std::to_string(k);
  return name;
}

// The recipe whose elevation is the height of its layer `number` alone, a relief, which keeps its place in
// the list and with it its random numbers.
Recipe relief_alone(const Recipe& recipe, int number) {
  Recipe alone = recipe;
  alone.layers.resize(static_cast<std::size_t>(number) + 1);
  for (Layer& layer : alone.layers) {
    if (BoulderLayer* boulders = std::get_if<BoulderLayer>(&layer)) *boulders = BoulderLayer();
  }
  ReliefLayer& relief = std::get<ReliefLayer>(alone.layers.back());
  relief.use = {};
  relief.use.combination.kind = Combine::kReplace;
  relief.finer = 0;
  return alone;
}

// The roughness of a relief over a distance at places that are uniform over the area of the bare body.
std::vector<double> sample_roughness(const Recipe& recipe, int number, double distance) {
  const ImplicitField field(relief_alone(recipe, number));
  const BareSurface surface(bare_body(recipe));
  CounterRandom random(recipe.seed);
  std::vector<Vec3d> numbers(kPlaces);
  for (Vec3d& n : numbers) n = {random.uniform(), random.uniform(), random.uniform()};
  const std::vector<Vec3d> places = surface.scatter(numbers);
  std::vector<double> roughness(places.size());
  // On the bare surface F is the height alone.
  const auto height = [&](const Vec3d& p) { return field.value(surface.projected(p)); };
  parallel_for(0, static_cast<std::int64_t>(places.size()), [&](std::int64_t i) {
    const Vec3d& p = places[static_cast<std::size_t>(i)];
    roughness[static_cast<std::size_t>(i)] = roughness_around(p, surface.normal(p), distance, height);
  });
  return roughness;
}

constexpr double kAnySize = std::numeric_limits<double>::infinity();

// 373 boulders of 5 m and more lie on 0.393 km^2.
constexpr KnownLandforms kItokawa[] = {
    {.least = 0.0,
     .greatest = kAnySize,
     .reference = 5.0,
     .reference_count = 949.0,
     .exponent = 3.05,
     .measured_from = 5.0,
     .source = "373 of 5 m on 0.393 km^2, Michikami et al. 2008; Michikami and Hagermann 2021"}};

// Dimorphos has 3.5 times the density of boulders of 5 m and more. 108 craters of 10 m and more and about
// 1560 of 2.5 m and more lie on a sphere of 244 m. Below 2 to 3 m they become fewer.
constexpr KnownLandforms kBennu[] = {{.craters = true,
                                      .least = 2.5,
                                      .greatest = 10.0,
                                      .reference = 10.0,
                                      .reference_count = 144.0,
                                      .exponent = 1.93,
                                      .depth = 0.13,
                                      .depth_deviation = 0.31,
                                      .measured_from = 2.5,
                                      .source = "Daly et al. 2020, 2022; Bierhaus et al. 2022"},
                                     {.craters = true,
                                      .least = 10.0,
                                      .greatest = kAnySize,
                                      .reference = 10.0,
                                      .reference_count = 144.0,
                                      .exponent = 1.93,
                                      .depth = 0.10,
                                      .depth_deviation = 0.3,
                                      .measured_from = 10.0,
                                      .source = "108 on a sphere of 244 m, Daly et al. 2020"},
                                     {.least = 0.0,
                                      .greatest = kAnySize,
                                      .reference = 5.0,
                                      .reference_count = 1383.0,
                                      .exponent = 2.9,
                                      .measured_from = 5.0,
                                      .source = "Pajola et al. 2024, over Itokawa's; Tricarico 2021"}};

// 6760 boulders of 15 m and more lie on 1124 km^2. About 40 craters of 20 m and more lie on a square
// kilometre, and about 4 of 100 m (R = 0.08). Below 10 m they are extremely rare.
constexpr KnownLandforms kEros[] = {
    {.craters = true,
     .least = 10.0,
     .greatest = 100.0,
     .reference = 20.0,
     .reference_count = 40.0,
     .exponent = 1.43,
     .depth = 0.13,
     .depth_deviation = 0.3,
     .measured_from = 20.0,
     .source = "NEAR counts; Berthoud et al. 2001, Chapman 2002; the depth is assumed"},
    {.least = 0.0,
     .greatest = kAnySize,
     .reference = 15.0,
     .reference_count = 6.01,
     .exponent = 3.25,
     .measured_from = 5.0,
     .source = "6760 of 15 m on 1124 km^2, Thomas et al. 2001; Michikami and Hagermann 2021"}};

constexpr KnownLandforms kRyugu[] = {{.least = 0.0,
                                      .greatest = kAnySize,
                                      .reference = 5.0,
                                      .reference_count = 1630.0,
                                      .exponent = 2.65,
                                      .measured_from = 5.0,
                                      .source = "4400 of 5 m on 2.7 km^2, Michikami et al. 2019"}};

// On an equal area Dimorphos has 5.1 times Itokawa's boulders of 5 m and more, and 2.3 times Bennu's of 1 m
// and more. Weibull's law below 5 m has these two numbers, and the slope of the power law at 5 m. That
// slope, 3.4, is assumed.
constexpr KnownLandforms kDimorphos[] = {
    {.least = 5.0,
     .greatest = kAnySize,
     .reference = 5.0,
     .reference_count = 4840.0,
     .exponent = 3.4,
     .measured_from = 5.0,
     .source = "Pajola et al. 2024, over Itokawa's; the exponent is assumed"},
    {.least = 0.0,
     .greatest = 5.0,
     .reference = 5.0,
     .reference_count = 4840.0,
     .weibull = WeibullSizes{0.004170687, 0.3293115},
     .measured_from = 1.0,
     .source = "Weibull's law through the densities of 5 m and 1 m, Pajola et al. 2024"}};

constexpr std::string_view kFewCraters = "small craters are few, and no density of them was at hand";
constexpr KnownBody kBodies[] = {{"itokawa", kItokawa, kFewCraters},
                                 {"bennu", kBennu, ""},
                                 {"eros", kEros, ""},
                                 {"ryugu", kRyugu, kFewCraters},
                                 {"dimorphos", kDimorphos, kFewCraters}};

// Random numbers of the layers that are added: the same whatever layers the recipe has.
constexpr int kFirstSeed = 716'000;

// The names, as a list for messages: itokawa, bennu, ...
std::string known_body_names() {
  std::string names;
  for (const KnownBody& body : kBodies) names += (names.empty() ? "" : ", ") + std::string(body.name);
  return names;
}

const KnownBody& body_named(const std::string& name) {
  for (const KnownBody& body : kBodies) {
    if (body.name == name) return body;
  }
  throw InputError("finish: \"" + name + "\" is no known body; name one of " + known_body_names());
}

double meters_per_unit(const Recipe& recipe, const std::string& name) {
  if (recipe.length_unit == "m" || recipe.length_unit == "km") return metres_per_unit(recipe.length_unit);
  throw InputError(name + ": length_unit: \"" + recipe.length_unit +
                   "\" has no physical scale, which known bodies need; state lengths in m or km");
}

Population make_population(const KnownLandforms& known, double least, double greatest, double meters) {
  Population population;
  const double number = known_number(known, meters * least) - known_number(known, meters * greatest);
  population.density = round_to_seven_digits(number * 1e-6 * meters * meters);
  population.least_diameter = round_to_seven_digits(least);
  population.greatest_diameter = round_to_seven_digits(greatest);
  population.exponent = known.weibull ? population.exponent : known.exponent;
  if (known.weibull) population.weibull = WeibullSizes{known.weibull->scale / meters, known.weibull->shape};
  return population;
}

Layer make_layer(const KnownLandforms& known, const Population& population, int seed) {
  if (!known.craters) {
    BoulderLayer layer;
    layer.name = "finish boulders";
    layer.seed = seed;
    layer.population.emplace().drawn = population;
    return layer;
  }
  CraterLayer layer;
  layer.name = "finish craters";
  layer.seed = seed;
  layer.simple.depth = known.depth;
  layer.simple.smoothing = 0.2;
  layer.population.emplace().drawn = population;
  layer.population->depth_deviation = known.depth_deviation;
  return layer;
}

// Adds the layers of known landforms to a finish. Landforms too large to be drawn by cells get a layer that
// draws them on the whole body.
class Finishing {
 public:
  Finishing(Finish& finish, double meters, double longest_side)
      : finish_(finish),
        meters_(meters),
        most_by_cells_(round_down(kGreatestByCells * longest_side)),
        rough_(rough_ground(finish.recipe)) {}

  void add(const KnownLandforms& known) {
    const double least = std::max(finish_.to, known.least / meters_),
                 greatest = std::min(finish_.from, known.greatest / meters_);
    add(known, std::max(least, most_by_cells_), greatest, false);
    add(known, least, std::min(greatest, most_by_cells_), true);
  }

 private:
  // A number that rounding to seven digits leaves below the limit.
  static double round_down(double most) { return round_to_seven_digits(0.999 * most); }

  void add(const KnownLandforms& known, double least, double greatest, bool by_cells) {
    if (!(least < 0.999 * greatest)) return;
    Population population = make_population(known, least, greatest, meters_);
    population.by_cells = by_cells;
    const double density = *population.density;
    if (!known.craters && rough_) spare_smooth_ground(population);
    const int place = static_cast<int>(finish_.recipe.layers.size());
    finish_.recipe.layers.push_back(
        make_layer(known, population, kFirstSeed + static_cast<int>(finish_.layers.size())));
    finish_.layers.push_back({place, known, population.least_diameter, population.greatest_diameter, density,
                              known.measured_from / meters_});
  }

  // Counts of a known body are means over its ground, smooth and rough.
  void spare_smooth_ground(Population& population) {
    population.mask = rough_->mask;
    population.density = round_to_seven_digits(*population.density / rough_->mean_weight);
    finish_.rough_share = rough_->mean_weight;
  }

  Finish& finish_;
  double meters_;
  double most_by_cells_;
  std::optional<RoughGround> rough_;
};

}  // namespace

std::optional<RoughGround> rough_ground(Recipe& recipe) {
  const int number = last_relief(recipe);
  if (number < 0) return {};
  ReliefLayer& relief = std::get<ReliefLayer>(recipe.layers[static_cast<std::size_t>(number)]);
  // A mask means the last layer of a name.
  if (!relief.name.empty() && find_layer(recipe.layers, relief.name) != number) return {};
  const double distance = round_to_seven_digits(relief.donor_scale * relief.spacing);
  std::vector<double> roughness = sample_roughness(recipe, number, distance);
  if (roughness.empty()) return {};
  std::sort(roughness.begin(), roughness.end());
  const auto quantile = [&](double share) {
    return roughness[static_cast<std::size_t>(share * static_cast<double>(roughness.size()))];
  };
  const double to = round_to_seven_digits(quantile(kRough)),
               from = round_to_seven_digits(std::max(kSmooth * quantile(0.5), quantile(kSmoothest)));
  if (!(to - from > kLeast * distance)) return {};
  if (relief.name.empty()) relief.name = free_name(recipe);
  double sum = 0.0;
  for (const double r : roughness) {
    sum += static_cast<double>(
        smooth_step(static_cast<float>(r), static_cast<float>(from), 1.0f / static_cast<float>(to - from)));
  }
  return RoughGround{{relief.name, from, to, distance}, sum / static_cast<double>(roughness.size())};
}

std::span<const KnownBody> known_bodies() { return kBodies; }

double known_number(const KnownLandforms& known, double diameter) {
  if (!known.weibull) {
    return known.reference_count * portable::pow(diameter / known.reference, -known.exponent);
  }
  const auto exponent = [&](double d) {
    return portable::pow(d / known.weibull->scale, known.weibull->shape);
  };
  return known.reference_count * portable::exp(exponent(known.reference) - exponent(diameter));
}

double finest_size(const Recipe& recipe) {
  double landform = kAnySize, metaball = kAnySize;
  for (const Layer& layer : recipe.layers) {
    if (const Population* drawn = find_population(layer))
      landform = std::min(landform, drawn->least_diameter);
    std::visit(
        [&]<class Kind>(const Kind& l) {
          if constexpr (!Kind::kTraits.is_noise) landform = std::min(landform, l.least_listed());
        },
        layer);
  }
  // What a relief shows is measured; landforms below the distance of its heights are not.
  for (const Layer& layer : recipe.layers) {
    if (const ReliefLayer* relief = std::get_if<ReliefLayer>(&layer))
      landform = std::min(landform, relief->donor_scale * relief->spacing);
  }
  if (landform < kAnySize) return landform;
  for (const Sphere& sphere : recipe.body->spheres) metaball = std::min(metaball, 2.0 * sphere.radius);
  if (recipe.body->morph) metaball = 2.0 * morph_spacing(*recipe.body->morph);
  return metaball;
}

Finish finish_recipe(const Recipe& recipe, const std::string& name, const FinishRequest& request) {
  const KnownBody& body = body_named(request.body);
  if (!recipe.body)
    throw InputError(name + ": body: absent; lay its layers on a body before they are finished");
  const double meters = meters_per_unit(recipe, name);
  Finish finish{
      recipe, request.from ? *request.from : finest_size(recipe), request.to, {}, body.without_craters};
  if (!(finish.to > 0.0 && finish.to < finish.from)) {
    throw InputError(
        fmt::format("{}: finish: sizes go from {:.4g}{} down to {:.4g}, which is not below; lower the end or "
                    "raise the start",
                    name, finish.from, request.from ? "" : ", the finest of the recipe,", finish.to));
  }
  Finishing finishing(finish, meters, bare_body(recipe).bounds.longest_side());
  for (const KnownLandforms& known : body.landforms) finishing.add(known);
  if (finish.layers.empty()) {
    throw InputError(fmt::format("{}: finish: {} has no landforms between these sizes, {:.4g} and {:.4g}",
                                 name, request.body, finish.to, finish.from));
  }
  return finish;
}

}  // namespace astrolith
