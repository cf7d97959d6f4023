#include <fmt/format.h>

// Adds a recipe's layers to the field model that holds its body, in the recipe's order.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "numerics/errors.h"
#include "synthesis/field/layer_stack_internal.h"

namespace astrolith {

StackState::StackState(const Recipe& given_recipe, const std::string& recipe_name, FieldModel& given_model)
    : recipe(given_recipe),
      name(recipe_name),
      model(given_model),
      masks(plan_masks(given_recipe.layers)),
      supports(given_model.body.supports) {}

LayerSite StackState::site(const NoiseFrame& frame, std::size_t below) const {
  model.update();
  const Vec3d e = supports.extent();
  return {frame,
          model.body,
          model.arrays,
          model.metaballs.lists(),
          std::max({e.x, e.y, e.z}),
          field_below(model, below, frame),
          model.height_bound,
          [&given_recipe = recipe] { return bare_body(given_recipe).bounds; }};
}

void StackState::update_model() {
  double bound = 0.0;
  for (std::size_t i = model.layers.size(); i-- > 0;) {
    bound += model.layers[i].join.change_bound;
    model.layers[i].join.remaining_change = static_cast<float>(bound * (1.0 + 1e-5));
  }
  model.update();
}

void StackState::report_left_out(int layer, const NoiseDetail& detail) {
  if (detail.left_out > 0.0) model.left_out.push_back({layer, detail.left_out, detail.finest});
}

namespace {

// A point takes about 0.1 ms where the spots of all layers take as many draws.
constexpr double kMostSpotDraws = 8192.0;
// A point far from all others takes about 0.1 ms where the Gabor layers take as many draws.
constexpr double kMostGaborDraws = 65536.0;

void expect_few_draws(const std::string& what, double draws, double most, const std::string& remedy) {
  if (draws <= most) return;
  const auto whole_number = [](double v) { return std::to_string(std::llround(v)); };
  throw InputError(what + ", with those of earlier layers, take " + whole_number(draws) +
                   " random draws at each point, at most " + whole_number(most) + " are allowed; " + remedy);
}

class LayerStack {
 public:
  LayerStack(const Recipe& recipe, const std::string& name, FieldModel& model)
      : stack_(recipe, name, model), height_limit_(height_limit(model)) {}

  void add_all(const Progress& progress) {
    FieldModel& model = stack_.model;
    const BodyLeaf& first = model.tables.leaf(0);
    if (first.warped) stack_.report_left_out(-1, first.warp.detail);
    if (!(height_limit_ > 0.0)) {
      throw InputError(stack_.name +
                       ": body.operations: their widths and bulges add matter where no metaball is; lower "
                       "them below the size of the body");
    }
    for (int i = 0; i < static_cast<int>(stack_.recipe.layers.size()); ++i) {
      stack_.index = i;
      add_layer();
      model.recipe_layers.resize(model.layers.size(), i);
      find_first_too_high();
    }
    check_heights();
    patch_.add_all();
    stack_.update_model();
    landforms_.add_boulders(progress);
    std::stable_sort(model.left_out.begin(), model.left_out.end(),
                     [](const LayerLeftOut& a, const LayerLeftOut& b) { return a.layer < b.layer; });
  }

 private:
  void add_layer() {
    std::visit(
        [this]<class Kind>(const Kind& layer) {
          if constexpr (Kind::kTraits.is_noise) {
            add_noise(layer);
          } else {
            landforms_.add(layer);
          }
        },
        stack_.layer());
  }

  template <class Kind>
  void add_noise(const Kind& kind) {
    const Layer& layer = stack_.layer();
    const bool moves = has_height(layer);
    if (!moves && !paints(layer) && !kind.use.albedo) return;
    FieldModel& model = stack_.model;
    const LayerSource source{stack_.recipe, layer_number(kind.seed, stack_.index), stack_.place(),
                             model.shared.get()};
    const LayerMaker maker = layer_maker(layer, source, model.arrays);
    const std::size_t number = model.layers.size();
    const NoiseFrame frame(Kind::kTraits.on_surface ? stack_.supports : joins_.domain());
    const LayerNoise noise = maker(stack_.site(frame, number), model.arrays);
    const std::uint32_t first_list = add_lists(noise, maker);
    const LayerJoin join = joins_.join(kind.use, patch_.height_bound(noise, maker), moves);
    if (moves) stack_.numbers[stack_.index] = number;
    model.layers.push_back({noise, join, first_list});
  }

  // Appends lists of impulses for a layer of spots or Gabor noise, after a check that a point far from all
  // others does not take too long with the layers so far. Returns the number of the first list.
  std::uint32_t add_lists(const LayerNoise& noise, const LayerMaker& maker) {
    FieldModel& model = stack_.model;
    const NoiseLists kind = noise_traits(noise).lists;
    const bool spots = kind == NoiseLists::kSpots;
    if (!spots && kind != NoiseLists::kGabor) return 0;
    const auto number = static_cast<std::uint32_t>(model.layers.size());
    ArrayStore discarded;
    const NoiseFrame whole(Box{{}, {}});  // a domain without extent leaves out no size of the layer
    const LayerNoise complete = maker(stack_.site(whole, number), discarded);
    const double draws = draws_at_a_point(complete, discarded.view());
    if (spots) {
      expect_few_draws(stack_.place() + ".density: these spots", spot_draws_ += draws, kMostSpotDraws,
                       "lower density, layers or size, or use larger cells or fewer parts");
    } else {
      expect_few_draws(stack_.place() + ".impulses_per_kernel: these impulses", gabor_draws_ += draws,
                       kMostGaborDraws, "lower impulses_per_kernel, or use lobes of fewer bandwidths");
    }
    std::vector<ImpulseList>& lists = spots ? model.spot_lists : model.gabor_lists;
    const auto first = static_cast<std::uint32_t>(lists.size());
    for (std::uint32_t i = 0; i < num_impulse_lists(noise); ++i) lists.push_back({number, i});
    model.gabor_caches.resize(model.gabor_lists.size());
    return first;
  }

  // Remembers the layer since which elevations may reach the height limit.
  void find_first_too_high() {
    const bool too_high = !(stack_.model.height_bound < height_limit_);
    if (too_high == first_too_high_.has_value()) return;
    first_too_high_ = too_high ? std::optional(stack_.index) : std::nullopt;
  }

  // Throws InputError where the elevations could reach the height limit.
  void check_heights() const {
    if (!first_too_high_) return;
    const Layer& layer = stack_.recipe.layers[static_cast<std::size_t>(*first_too_high_)];
    throw InputError(fmt::format(
        "{}.{}: heights of up to {:.3g} would fill the space around the body; make them smaller, "
        "all heights together at most {:.3g}",
        stack_.layer_path(*first_too_high_), height_field(layer), stack_.model.height_bound, height_limit_));
  }

  StackState stack_;
  StackJoins joins_{stack_};
  PatchNoises patch_{stack_, joins_};
  StackLandforms landforms_{stack_};
  double spot_draws_ = 0.0, gabor_draws_ = 0.0;
  double height_limit_;                // length units
  std::optional<int> first_too_high_;  // set by find_first_too_high()
};

}  // namespace

void add_layers(const Recipe& recipe, const std::string& name, FieldModel& model, const Progress& progress) {
  LayerStack(recipe, name, model).add_all(progress);
}

}  // namespace astrolith
