// Continues the craters and boulders of a recipe below its finest size, as published counts of a known body
// say.
//
//   Finish finish = finish_recipe(read_recipe("itokawa.json"), "itokawa.json", {"itokawa", 4.0, 0.05});
//
// The layers that are added draw their landforms by cells (recipe/landforms.h), so that a patch of metres
// has what the body has down to centimetres. Where a relief shows smooth ground, boulders lie on rough ground
// alone.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "recipe/recipe.h"

namespace astrolith {

struct RoughGround {
  LayerMask mask;            // for a population: the relief's roughness over the distance of its heights
  double mean_weight = 1.0;  // of the mask over the body, in (0, 1]
};

// The rough ground of the recipe's last relief, which gets a name where it has none. Boulders of a rubble
// pile gather where the ground is rough. The weight is 1 from the median roughness up, and 0 below a quarter
// of it and on the smoothest tenth of the ground, where a relief shows no more than the steps of its heights.
// None where the recipe has no relief, or one without roughness.
std::optional<RoughGround> rough_ground(Recipe& recipe);

// Landforms of one kind on a known body, between two sizes. The number of at least D on a square kilometre is
//   N(D) = reference_count (D / reference)^-exponent,   or
//   N(D) = reference_count exp((reference / scale)^shape - (D / scale)^shape)   with `weibull`.
struct KnownLandforms {
  bool craters = false;  // or boulders
  double least = 0.0;    // metres; smaller ones of the kind are too rare to be drawn, or follow another law
  double greatest = 0.0;
  double reference = 1.0;        // metres
  double reference_count = 0.0;  // of that size and more, per square kilometre
  double exponent = 0.0;
  std::optional<WeibullSizes> weibull = std::nullopt;  // metres
  double depth = 0.0, depth_deviation = 0.0;           // craters: over diameter, and over the mean depth
  double measured_from = 0.0;                          // metres: the law is drawn below, not measured
  std::string_view source;
};

struct KnownBody {
  std::string_view name;
  std::span<const KnownLandforms> landforms;
  std::string_view without_craters;  // why no craters are drawn; empty where some are
};

// The known bodies, by name.
std::span<const KnownBody> known_bodies();

// The number of landforms of at least `diameter` (metres) on a square kilometre.
double known_number(const KnownLandforms& landforms, double diameter);

struct FinishRequest {
  std::string body;            // a name of known_bodies()
  std::optional<double> from;  // sizes from here, length units; absent: finest_size() of the recipe
  double to = 0.0;             // down to here, length units
};

// A layer that was added; lengths in the recipe's unit.
struct FinishLayer {
  int layer = 0;  // its index in the recipe
  KnownLandforms known;
  double least = 0.0, greatest = 0.0;
  double density = 0.0;        // mean over the body, of these sizes, per squared length unit
  double measured_from = 0.0;  // smaller ones are drawn by the same law without being measured
};

struct Finish {
  Recipe recipe;
  double from = 0.0, to = 0.0;
  std::vector<FinishLayer> layers;
  std::string_view without_craters;  // of KnownBody
  double rough_share = 1.0;          // mean weight of boulders' places: below 1 where smooth ground is spared
};

// The finest size that a recipe describes: the diameter of the smallest crater or boulder that it lists or
// draws, or the distance of a relief's heights where that is smaller; where it has none of these, the
// diameter of the smallest additive metaball. In length units.
double finest_size(const Recipe& recipe);

// The recipe with the landforms of a known body after its layers, craters first. Where the recipe has a
// relief, boulders lie the denser the rougher the ground is, and spare what it shows smooth: rough_ground().
// Throws InputError, naming `name`, for a body that is not known, a recipe without a body, a unit other than
// m and km, and for sizes that leave nothing to draw.
Finish finish_recipe(const Recipe& recipe, const std::string& name, const FinishRequest& request);

}  // namespace astrolith
