#include "synthesis/finish/lay_on_base.h"

#include <fmt/format.h>

#include "numerics/errors.h"
#include "synthesis/body/body_tables.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/relief/relief_noise.h"

namespace astrolith {
namespace {

constexpr int kSizeCells = 64;  // of the mesh that shows how long the base is: within some thousandths

double longest_side(const Recipe& recipe, const std::string& name) {
  const TriangleMesh mesh = bare_body(recipe).meshed_at(kSizeCells);
  if (mesh.vertices.empty()) throw InputError(name + ": body: is empty; give one with a surface");
  Box box;
  for (const Vec3d& v : mesh.vertices) box.extend(v);
  return box.longest_side();
}

// The length of one unit of the details in units of the base.
double unit_ratio(const Recipe& details, const std::string& details_name, const Recipe& base,
                  const std::string& base_name) {
  const std::string &from = details.length_unit, &to = base.length_unit;
  if (from == to) return 1.0;
  if (from == "body") return longest_side(base, base_name);
  if (from == "m" && to == "km") return 1e-3;
  if (from == "km" && to == "m") return 1e3;
  throw InputError(
      details_name + ": length_unit: \"" + from + "\" has no physical scale on " + base_name +
      ", which is in \"" + to +
      "\"; fit the photo again with --mm-per-px, or state length_unit \"m\" or \"km\" and the lengths in it");
}

const ReliefLayer* find_relief(const Recipe& recipe) {
  for (const Layer& layer : recipe.layers) {
    if (const ReliefLayer* relief = std::get_if<ReliefLayer>(&layer)) return relief;
  }
  return nullptr;
}

double measured_edge(const Recipe& recipe, const std::string& name) {
  const ReliefLayer* relief = find_relief(recipe);
  if (relief != nullptr) return relief->donor_scale * relief->edge_length();
  throw InputError(name +
                   ": layers: hold no relief, whose model has edges; take lengths by \"body\" or \"units\"");
}

// The length in units of the base of what is one unit long in the details.
double length_ratio(const Recipe& details, const std::string& details_name, const Recipe& base,
                    const std::string& base_name, BaseLengths lengths) {
  if (lengths == BaseLengths::kUnits) return unit_ratio(details, details_name, base, base_name);
  if (lengths == BaseLengths::kEdges) {
    return measured_edge(base, base_name) / measured_edge(details, details_name);
  }
  if (!details.body) {
    throw InputError(details_name +
                     ": body: absent, so that lengths are no shares of it; take lengths by \"units\"");
  }
  return longest_side(base, base_name) / longest_side(details, details_name);
}

bool is_unnamed_relief(const Layer& layer) {
  const ReliefLayer* relief = std::get_if<ReliefLayer>(&layer);
  return relief != nullptr && relief->name.empty();
}

}  // namespace

BaseLengths parse_base_lengths(std::string_view word) {
  if (word == "units") return BaseLengths::kUnits;
  if (word == "body") return BaseLengths::kBody;
  if (word == "edges") return BaseLengths::kEdges;
  throw InputError(fmt::format("base lengths: must be units, body or edges, are {}", word));
}

Recipe lay_on_base(const Recipe& details, const std::string& details_name, const Recipe& base,
                   const std::string& base_name, BaseLengths lengths) {
  if (!base.body) throw InputError(base_name + ": body: absent; give a recipe with a body as the base");
  if (details.family) {
    throw InputError(
        fmt::format("{}: family: names places and lengths of this recipe alone; take it out, merge both by "
                    "--write-recipe, and state it there, where these layers begin at layers[{}]",
                    details_name, base.layers.size()));
  }
  const double ratio = length_ratio(details, details_name, base, base_name, lengths);
  Recipe result = base;
  if (!result.albedo && details.albedo) {
    result.albedo = details.albedo;
    result.albedo->rescale(ratio);
  }
  if (find_relief(details) != nullptr) std::erase_if(result.layers, is_unnamed_relief);
  for (const Layer& layer : details.layers) {
    result.layers.push_back(rescaled(details.body ? drawn_from(*details.body, layer) : layer, ratio));
  }
  return result;
}

Layer drawn_from(const MetaballBody& measured, const Layer& layer) {
  Layer result = layer;
  if (ReliefLayer* relief = std::get_if<ReliefLayer>(&result)) {
    if (relief->arrangement == ReliefArrangement::kMeasured) relief->arrangement = ReliefArrangement::kLaid;
    if (!relief->donor) relief->donor = measured;
  }
  return result;
}

Layer rescaled(const Layer& layer, double ratio) {
  Layer result = layer;
  std::visit([ratio](auto& l) { l.rescale(ratio); }, result);
  LayerUse* use = find_use(result);
  if (use == nullptr) return result;
  if (use->locality) use->locality->width *= ratio;
  if (use->mask) use->mask->rescale(ratio);
  use->combination.width *= ratio;
  return result;
}

Recipe with_own_heights(Recipe recipe, const std::string& name) {
  ArrayStore arrays;
  const BodyTables body = make_body(*recipe.body, recipe.seed, arrays);
  const ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
  bool any = false;
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    auto* relief = std::get_if<ReliefLayer>(&recipe.layers[i]);
    if (relief == nullptr) continue;
    if (relief->arrangement == ReliefArrangement::kMeasured && !relief->fill_unseen) continue;
    const int index = static_cast<int>(i);
    const LayerSource source{recipe, layer_number(relief->seed, index),
                             fmt::format("{}: layers[{}]", name, index)};
    *relief = with_own_heights(*relief, source, {body, arrays.view(), metaballs.lists()});
    any = true;
  }
  if (any) return recipe;
  throw InputError(name + ": layers: no relief draws its heights; add --like, --laid or --fill-unseen");
}

}  // namespace astrolith
