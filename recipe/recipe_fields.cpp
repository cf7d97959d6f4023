// Lists of fields of a recipe as a whole, its provenance, its erosion and any of its layers, with their
// rules.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <type_traits>

#include "recipe/fields_internal.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

// Checks every number that would be written against its limits. The lists of fields call all other rules.
class FieldChecker final : public FieldVisitor {
 public:
  explicit FieldChecker(const Place& place) : FieldVisitor(Task::kCheck, place) {}

 private:
  void visit_number(double& number, const NumberLimits& limits) override { expect(number, limits, place()); }
  void visit_integer(int& number, const IntegerLimits& limits) override { expect(number, limits, place()); }
};

struct LayerType {
  std::string_view word;
  Layer defaults;
};

Layer fractal_layer(Noise noise) {
  FractalLayer layer;
  layer.noise = noise;
  return layer;
}

template <class... Kinds>
std::vector<LayerType> list_types(const std::variant<FractalLayer, Kinds...>&) {
  return {{"simplex", fractal_layer(Noise::kSimplex)},
          {"perlin", fractal_layer(Noise::kPerlin)},
          {"worley", fractal_layer(Noise::kWorleyF1)},
          {Kinds::kType, Kinds{}}...};
}

const std::vector<LayerType>& layer_types() {
  static const std::vector<LayerType> types = list_types(Layer{});
  return types;
}

std::string layer_type_list() {
  std::vector<std::string_view> words;
  for (const LayerType& type : layer_types()) words.push_back(type.word);
  return quote_list(words, " and ");
}

// Gives `layer` the type that the file states, with default fields.
void choose_type(const std::optional<std::string>& word, const Place& place, Layer& layer) {
  if (!word) place.fail("is missing; add one of " + layer_type_list());
  for (const LayerType& type : layer_types()) {
    if (type.word == *word) {
      layer = type.defaults;
      return;
    }
  }
  place.fail("must be one of " + layer_type_list() + ", is " + quote_text(*word));
}

void check_origin(const Provenance& provenance, const Place& place) {
  if (provenance.input_name.find('/') != std::string::npos) {
    place.field("input_name")
        .fail("must be a file name without folders, is " + quote_text(provenance.input_name));
  }
  const std::string& hash = provenance.input_sha256;
  const bool digits = std::all_of(hash.begin(), hash.end(), [](unsigned char c) { return std::isxdigit(c); });
  if (!hash.empty() && (hash.size() != 64 || !digits)) {
    place.field("input_sha256").fail("must be 64 hexadecimal digits or empty, is " + quote_text(hash));
  }
}

void check_unit(const Recipe& recipe, const Place& place) {
  const std::string& unit = recipe.length_unit;
  if (unit != "m" && unit != "km" && unit != "px" && unit != "body") {
    place.field("length_unit").fail("must be \"m\", \"km\", \"px\" or \"body\", is " + quote_text(unit));
  }
}

void check_seed(const Recipe& recipe, const Place& place) {
  if (recipe.seed < std::uint64_t{1} << 53) return;
  place.field("seed").fail(fmt::format("must be below 2^53, is {}", recipe.seed));
}

void check_recipe_parts(const Recipe& recipe, const Place& place) {
  if (!recipe.body && !recipe.population && recipe.layers.empty()) {
    place.fail("has neither a body nor layers; add one of them");
  }
  if (recipe.body && recipe.population) {
    place.field("population").fail("draws bodies, and the recipe has one already; leave one of them out");
  }
  if (recipe.length_unit == "body" && recipe.body) {
    place.field("length_unit").fail("is \"body\", which is for layers without a body; state \"m\" or \"km\"");
  }
  if (recipe.erosion && !recipe.body && !recipe.population)
    place.field("erosion").fail("needs a body; add one, or leave it out");
}

// The version is the first field, since the fields of another version would only be reported as unknown.
void visit_version(FieldVisitor& v, int& version) {
  std::optional<int> stated;
  if (!v.reading()) stated = version;
  v.required("format_version", stated, range(kRecipeFormatVersion, kRecipeFormatVersion));
  const Place at = v.place().field("format_version");
  if (!stated) at.fail(fmt::format("is missing; add {}", kRecipeFormatVersion));
  if (*stated != kRecipeFormatVersion) {
    at.fail(fmt::format("is {}, this program reads {}; use the program version that wrote the file", *stated,
                        kRecipeFormatVersion));
  }
  if (v.reading()) version = *stated;
}

}  // namespace

std::string_view type_word(const Layer& layer) {
  return std::visit(
      []<class Kind>(const Kind& l) -> std::string_view {
        if constexpr (std::is_same_v<Kind, FractalLayer>) {
          return is_worley(l.noise) ? "worley" : l.noise == Noise::kPerlin ? "perlin" : "simplex";
        } else {
          return Kind::kType;
        }
      },
      layer);
}

void visit_fields(FieldVisitor& v, Provenance& provenance) {
  using Option = std::pair<std::string, std::string>;
  using Figure = std::pair<std::string, double>;
  constexpr double kLargest = std::numeric_limits<double>::max();
  v.field("tool", provenance.tool);
  v.field("input_name", provenance.input_name);
  v.field("input_sha256", provenance.input_sha256);
  v.rule(check_origin, provenance);
  v.field("options", NamedMembers{provenance.options, &Option::first, &Option::second});
  v.field("achieved", NamedMembers{provenance.achieved, &Figure::first, &Figure::second},
          NumberLimits{-kLargest, kLargest, "finite"});
}

void visit_fields(FieldVisitor& v, Erosion& erosion) {
  const bool at_rest = erosion.rotation_period == 0.0;
  v.required("talus_angle", erosion.talus_angle, range(1.0, 85.0));
  v.field("iterations", erosion.iterations, range(1, 100000));
  v.field("density", erosion.density, range(1.0, 30000.0));
  v.field("rotation_period", erosion.rotation_period, at_rest ? kNotNegative : range(0.01, 1e6));
}

void visit_fields(FieldVisitor& v, Layer& layer) {
  std::optional<std::string> type;
  if (!v.reading()) type = std::string(type_word(layer));
  v.required("type", type);
  if (v.reading()) choose_type(type, v.place().field("type"), layer);
  const auto visit_kind = [&v](auto& kind) {
    v.field("name", kind.name);
    visit_fields(v, kind);
    v.field("seed", kind.seed, range(0, kMaxLayerSeed));
  };
  std::visit(visit_kind, layer);
  if (LayerUse* use = find_use(layer)) visit_fields(v, *use);
}

void visit_fields(FieldVisitor& v, Recipe& recipe) {
  visit_version(v, recipe.format_version);
  v.field_if(!recipe.description.empty(), "description", recipe.description);
  v.required("length_unit", recipe.length_unit);
  v.rule(check_unit, recipe);
  v.field("frame", recipe.frame);
  v.field_if(!(recipe.origin == Vec3d{}), "origin", recipe.origin, kAnyNumber);
  v.field("seed", recipe.seed);
  v.rule(check_seed, recipe);
  v.field("provenance", recipe.provenance);
  v.rule(check_recipe_parts, recipe);
  v.field("body", recipe.body);
  v.field("population", recipe.population);
  v.field("layers", recipe.layers);
  v.rule(check_layer_uses, recipe);
  v.field("albedo", recipe.albedo);
  v.rule(check_albedos, recipe);
  v.field("erosion", recipe.erosion);
  v.field("family", recipe.family);
  v.rule(check_family, recipe);
}

void validate_recipe(const Recipe& recipe, const std::string& name) {
  const Place place(name);
  FieldChecker(place).inspect(recipe);
}

void expect(double value, const NumberLimits& limits, const Place& place) {
  const bool above = limits.low_is_allowed ? value >= limits.low : value > limits.low;
  if (above && value <= limits.high) return;  // NaN is outside
  const std::string words = fmt::format(fmt::runtime(limits.words), limits.low, limits.high);
  place.fail(fmt::format("must be {}, is {}; give a value in that range", words, value));
}

void expect(int value, const IntegerLimits& limits, const Place& place) {
  if (value >= limits.low && value <= limits.high) return;
  place.fail(fmt::format("must be an integer from {} to {}, is {}; give one in that range", limits.low,
                         limits.high, value));
}

}  // namespace astrolith
