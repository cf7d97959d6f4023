// Adds a recipe's layers to the field model that holds its body, in the recipe's order.
#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "numerics/errors.h"
#include "recipe/height_field.h"
#include "synthesis/field/drawing_work.h"
#include "synthesis/field/landform_layers_internal.h"
#include "synthesis/field/noise_facts.h"
#include "synthesis/field/patch_noises_internal.h"

namespace astrolith {
namespace {

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
    if (!moves && !paints(layer)) return;
    FieldModel& model = stack_.model;
    const LayerSource source{stack_.recipe, layer_number(kind.seed, stack_.index), stack_.place()};
    const LayerMaker maker = layer_maker(layer, source, model.arrays);
    const std::size_t number = model.layers.size();
    const NoiseFrame frame(Kind::kTraits.on_surface ? stack_.supports : joins_.domain());
    const LayerNoise noise = maker(stack_.site(frame, number), model.arrays);
    const std::uint32_t first_list = add_lists(noise, maker);
    const LayerJoin join = joins_.join(kind.use, patch_.height_bound(noise, maker), moves);
    if (moves) stack_.numbers[stack_.index] = number;
    model.layers.push_back({noise, join, first_list});
  }

  // Appends lists of impulses for a layer, after a check that they take not too long. Returns the number of
  // the first list.
  std::uint32_t add_lists(const LayerNoise& noise, const LayerMaker& maker) {
    FieldModel& model = stack_.model;
    std::vector<ImpulseList>* lists = impulse_lists(traits_of(noise).lists);
    if (lists == nullptr) return 0;
    const std::size_t number = model.layers.size();
    ArrayStore discarded;
    const NoiseFrame whole(Box{{}, {}});  // a domain without extent leaves out no size of the layer
    const LayerNoise complete = maker(stack_.site(whole, number), discarded);
    work_.add(complete, discarded.view(), stack_.place());
    const auto first = static_cast<std::uint32_t>(lists->size());
    for (std::uint32_t i = 0; i < num_impulse_lists(noise); ++i) {
      lists->push_back({static_cast<std::uint32_t>(number), i});
    }
    model.gabor_caches.resize(model.gabor_lists.size());
    return first;
  }
  // The model's lists of a kind, or null for noise without impulses.
  std::vector<ImpulseList>* impulse_lists(NoiseLists kind) {
    switch (kind) {
      case NoiseLists::kSpots:
        return &stack_.model.spot_lists;
      case NoiseLists::kGabor:
        return &stack_.model.gabor_lists;
      case NoiseLists::kNone:
      case NoiseLists::kCraters:
        break;
    }
    return nullptr;
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
    char words[160];
    std::snprintf(words, sizeof words,
                  ": heights of up to %.3g would fill the space around the body; make them smaller, all "
                  "heights together at most %.3g",
                  stack_.model.height_bound, height_limit_);
    const Layer& layer = stack_.recipe.layers[static_cast<std::size_t>(*first_too_high_)];
    throw InputError(stack_.place_of(*first_too_high_) + "." + std::string(height_field(layer)) + words);
  }

  StackState stack_;
  LayerJoins joins_{stack_};
  PatchNoises patch_{stack_, joins_};
  LandformLayers landforms_{stack_};
  DrawingWork work_;
  double height_limit_;                // length units
  std::optional<int> first_too_high_;  // set by find_first_too_high()
};

}  // namespace

void add_layers(const Recipe& recipe, const std::string& name, FieldModel& model, const Progress& progress) {
  LayerStack(recipe, name, model).add_all(progress);
}

}  // namespace astrolith
