// Adds a recipe's layers to the field model that holds its body.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "recipe/height_field.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/field_model_internal.h"
#include "synthesis/field/layers_below_internal.h"
#include "synthesis/field/mask_plan.h"
#include "synthesis/landforms/population_cells.h"

namespace astrolith {
namespace {

// The elevations that the layers of the model make at points of the bare surface. There s = 0, so that F is
// the elevation.
std::vector<float> elevations_at(const FieldModel& model, std::span<const Vec3d> points) {
  std::vector<float> elevations(points.size());
  parallel_for(0, static_cast<std::int64_t>(points.size()), [&](std::int64_t i) {
    elevations[static_cast<std::size_t>(i)] = value_at(model, points[static_cast<std::size_t>(i)]);
  });
  return elevations;
}

// A point takes about 0.1 ms where the spots of all layers take as many draws.
constexpr double kMostSpotDraws = 8192.0;
// A point far from all others takes about 0.1 ms where the Gabor layers take as many draws.
constexpr double kMostGaborDraws = 65536.0;

// Adds a recipe's layers to the field model in the recipe's order.
class LayerStack {
 public:
  LayerStack(const Recipe& recipe, const std::string& name, FieldModel& model)
      : recipe_(recipe),
        name_(name),
        model_(model),
        masks_(plan_masks(recipe.layers)),
        height_limit_(height_limit(model)),
        supports_(model.body.supports),
        domain_(supports_) {
    const BodyLeaf& first = model.tables.leaf(0);
    if (model.body.plain() && first.warped) domain_ = widened(supports_, first.warp.bound);
  }

  void add_all(const Progress& progress) {
    const BodyLeaf& first = model_.tables.leaf(0);
    if (first.warped) report_left_out(-1, first.warp.detail);
    if (!(height_limit_ > 0.0)) {
      throw InputError(name_ +
                       ": body.operations: their widths and bulges add matter where no metaball is; lower "
                       "them below the size of the body");
    }
    for (index_ = 0; index_ < static_cast<int>(recipe_.layers.size()); ++index_) {
      std::visit([this](const auto& layer) { add(layer); }, recipe_.layers[static_cast<std::size_t>(index_)]);
      model_.recipe_layers.resize(model_.layers.size(), index_);
      const bool too_high = !(model_.height_bound < height_limit_);
      if (too_high != first_too_high_.has_value())
        first_too_high_ = too_high ? std::optional(index_) : std::nullopt;
    }
    check_heights();
    add_patch_noises();
    sum_changes();
    model_.update();
    add_boulders(progress);
    std::stable_sort(model_.left_out.begin(), model_.left_out.end(),
                     [](const LayerLeftOut& a, const LayerLeftOut& b) { return a.layer < b.layer; });
  }

 private:
  template <class AnyLayer>
  void add(const AnyLayer& layer) {
    push(layer, make_noise(layer, recipe_.seed, number_of(layer), domain_, model_.arrays));
  }
  void add(const SpotLayer& layer) {
    const SpotNoise noise = make_noise(layer, recipe_.seed, number_of(layer), domain_, model_.arrays);
    check_work(layer);
    push(layer, noise, add_lists(noise.kinds.count, model_.spot_lists));
  }
  void add(const GaborLayer& layer) {
    if (!(layer.height_rms > 0.0)) return;  // a layer of colour alone has no height
    if (layer.evaluation == GaborEvaluation::kTiles) return add_tiled(layer);
    const GaborSurfaceNoise noise =
        make_noise(layer, recipe_.seed, number_of(layer), supports_, model_.arrays);
    check_work(layer);
    push(layer, noise, add_lists(noise.bands.count, model_.gabor_lists));
    model_.gabor_caches.resize(model_.gabor_lists.size());
  }
  void add_tiled(const GaborLayer& layer) {
    const TiledGaborLayer tiled{layer,
                                make_phase_tiles(layer, recipe_.seed, number_of(layer), model_.arrays)};
    tiled_gabor_.emplace(index_, tiled);
    const TiledGaborNoise noise = placed(tiled, supports_, model_.arrays);
    check_work(tiled.set.narrow);
    push(tiled, noise, add_lists(noise.narrow.bands.count, model_.gabor_lists));
    model_.gabor_caches.resize(model_.gabor_lists.size());
  }
  void add(const ExemplarLayer& layer) {
    if (!layer.has_height() && !layer.paints()) return;
    const ExemplarNoise made = make_exemplar(layer, place_of(index_), model_.arrays);
    exemplars_.emplace(index_, made);
    push(layer, placed(layer, made, number_of_next_layer(), supports_, model_.arrays));
  }
  void add(const CraterLayer& layer) {
    std::vector<PlacedCrater> craters =
        place_craters(layer, bare(), recipe_.seed, number_of(layer), place_of(index_), crater_places(layer));
    std::vector<Vec3d> centers;
    for (const PlacedCrater& crater : craters) centers.push_back(crater.position);
    sum_changes();
    model_.update();
    const std::vector<float> elevations = elevations_at(model_, centers);
    centers = unwarped(std::move(centers));
    CraterRelief relief =
        make_crater_relief(layer, craters, centers, elevations, model_.height_bound, model_.arrays);
    relief.list = static_cast<std::uint32_t>(model_.crater_layers.size());
    add_patch_craters(layer, relief, centers);
    model_.crater_layers.push_back(number_of_next_layer());
    model_.crater_trees.push_back(crater_tree(model_.arrays.view().span(relief.craters)));
    model_.height_bound = relief.elevation_bound;
    LayerJoin join;
    join.height_bound = relief.elevation_bound;
    join.change_bound = std::numeric_limits<double>::infinity();  // craters replace the elevation
    model_.layers.push_back({LayerNoise(relief), join});
    model_.placed_craters.push_back({index_, std::move(craters)});
  }

  // Adds the craters in the frame of the patch, if the layer draws them by cells. Their bases and all but
  // their centres are those in the body's frame.
  void add_patch_craters(const CraterLayer& layer, const CraterRelief& relief,
                         std::span<const Vec3d> centers) {
    const bool local =
        layer.population && layer.population->drawn.by_cells && model_.patch && model_.body.plain();
    model_.patch_craters.emplace_back();
    if (!local) return;
    const std::span<const CraterKernel> in_body = model_.arrays.view().span(relief.craters);
    std::vector<CraterKernel> craters(in_body.begin(), in_body.end());
    for (std::size_t i = 0; i < craters.size(); ++i) {
      const Vec3f center = to_float(centers[i] - model_.patch->center);
      craters[i].x = center.x;
      craters[i].y = center.y;
      craters[i].z = center.z;
    }
    CraterRelief moved = relief;
    moved.craters = model_.arrays.add(craters);
    model_.patch_craters.back() = PatchCraters{moved, crater_tree(craters)};
  }

  // Boulders are added by add_boulders(), when all layers have made the surface that they lie on.
  void add(const BoulderLayer&) {}

  void add_boulders(const Progress& progress) {
    model_.update();
    const Terrain terrain{[this](const Vec3d& p) { return static_cast<double>(value_at(model_, p)); },
                          model_.height_bound};
    std::vector<FieldBoulder> all;
    for (int i = 0; i < static_cast<int>(recipe_.layers.size()); ++i) {
      const auto* layer = std::get_if<BoulderLayer>(&recipe_.layers[static_cast<std::size_t>(i)]);
      if (layer == nullptr) continue;
      index_ = i;
      std::vector<PlacedBoulder> placed =
          place_boulders(*layer, bare(), terrain, recipe_.seed, layer_number(layer->seed, i), place_of(i),
                         progress, boulder_places(*layer, progress));
      const std::vector<FieldBoulder> boulders = field_boulders(*layer, placed);
      all.insert(all.end(), boulders.begin(), boulders.end());
      add_patch_boulders(*layer, placed);
      model_.placed_boulders.push_back({i, std::move(placed)});
    }
    std::vector<Box> boxes;
    for (const FieldBoulder& boulder : all) boxes.push_back(boulder.box);
    model_.boulder_tree = BoxTree(boxes);
    model_.boulders = std::move(all);
  }

  // Adds the boulders in the frame of the patch, if the layer draws them by cells.
  void add_patch_boulders(const BoulderLayer& layer, std::vector<PlacedBoulder> boulders) {
    const bool local = layer.population && layer.population->drawn.by_cells && model_.patch;
    if (!local) return model_.patch_boulders.resize(model_.patch_boulders.size() + boulders.size());
    for (PlacedBoulder& boulder : boulders) boulder.center -= model_.patch->center;
    for (const FieldBoulder& boulder : field_boulders(layer, boulders)) {
      model_.patch_boulders.emplace_back(boulder.kernel);
    }
  }

  // Where the drawn craters of a layer may lie. The base of a crater depends on older ones that cover its
  // centre, so that craters matter somewhat beyond what they cover.
  DrawingPlaces crater_places(const CraterLayer& layer) {
    constexpr double kBasesOfBases = 4.0;
    if (!layer.population) return {};
    const Population& drawn = layer.population->drawn;
    DrawingPlaces places{weight_of(drawn), {}, 0.5, 0.0, {}};
    if (!drawn.by_cells) return places;
    report_sizes_left_out(drawn);
    if (!model_.patch) return places;
    const double extent = std::max(layer.simple.extent, layer.complex_from ? layer.complex.extent : 0.0);
    places.reach = kBasesOfBases * 0.5 * extent;
    places.margin = height_reach() + widest_boulder();
    places.region = patch_box();
    return places;
  }
  DrawingPlaces boulder_places(const BoulderLayer& layer, const Progress& progress) {
    if (!layer.population) return {};
    const Population& drawn = layer.population->drawn;
    DrawingPlaces places{weight_of(drawn), {}, boulder_reach(layer), model_.height_bound, progress};
    if (!drawn.by_cells) return places;
    report_sizes_left_out(drawn);
    if (model_.patch) places.region = patch_box();
    return places;
  }

  // The patch, with a margin for the differences that give normals.
  Box patch_box() const {
    const Vec3d& center = model_.patch->center;
    return widened(Box{center, center}, 0.51 * model_.patch->side);
  }
  // How far a boulder that is drawn by cells reaches at most, length units.
  double widest_boulder() const {
    double widest = 0.0;
    for (const Layer& layer : recipe_.layers) {
      const auto* boulders = std::get_if<BoulderLayer>(&layer);
      const Population* drawn = population_of(layer);
      if (boulders == nullptr || drawn == nullptr || !drawn->by_cells) continue;
      widest = std::max(widest, boulder_reach(*boulders) * drawn->greatest_diameter);
    }
    return widest;
  }
  // A bound of all elevations, those of later layers too; length units. It is found without the populations
  // that are drawn by cells, whose craters rise by a bound of their own.
  double height_reach() {
    if (height_reach_) return *height_reach_;
    Recipe others = recipe_;
    double rise = 0.0;
    for (Layer& layer : others.layers) {
      if (auto* craters = std::get_if<CraterLayer>(&layer)) {
        if (!craters->population || !craters->population->drawn.by_cells) continue;
        rise += crater_rise(*craters);
        craters->population.reset();
      } else if (auto* boulders = std::get_if<BoulderLayer>(&layer)) {
        *boulders = {};
      }
    }
    FieldModel model;
    model.patch = model_.patch;
    model.body = make_body(*others.body, others.seed, model.arrays);
    model.update();
    model.metaballs = all_metaballs(model.body, model.tables.arrays);
    add_layers(others, name_, model);
    height_reach_ = model.height_bound + rise;
    return *height_reach_;
  }

  // The weight of the places of a population; empty where it is 1 everywhere. It reads the model as it is
  // when it is called.
  PlaceWeight weight_of(const Population& drawn) {
    if (!drawn.locality && !drawn.mask) return {};
    sum_changes();
    model_.update();
    const std::string place = place_of(index_) + ".population";
    const auto arrays = std::make_shared<ArrayStore>();
    std::optional<LocalWeight> local;
    if (drawn.locality) local = make_local_weight(*drawn.locality, *recipe_.body, place, *arrays);
    LayerJoin join;
    std::size_t masking = 0;
    if (drawn.mask) {
      const auto number = numbers_.find(masks_.masking[static_cast<std::size_t>(index_)]);
      if (number == numbers_.end()) fail_without_height(*drawn.mask, place);
      masking = number->second;
      set_range(*drawn.mask, join);
    }
    return [this, arrays, local, join, masking, masked = drawn.mask.has_value()](const Vec3d& p) {
      float weight = 1.0f;
      if (masked) {
        weight *= smooth_step(layer_height_at(model_, masking, p), join.mask_from, join.mask_inverse_range);
      }
      if (local) weight *= weight_at(*local, arrays->view(), to_float(p));
      return weight;
    };
  }

  void report_sizes_left_out(const Population& drawn) {
    const SizesByCells sizes = sizes_by_cells(drawn, bare(), !model_.patch);
    if (sizes.number_left_out == 0.0) return;
    model_.left_out.push_back({index_, sizes.share_left_out, drawn.least_diameter, sizes.number_left_out});
  }

  // Throws InputError where the elevations could reach the height limit.
  void check_heights() const {
    if (!first_too_high_) return;
    char words[160];
    std::snprintf(words, sizeof words,
                  ": heights of up to %.3g would fill the space around the body; make them smaller, all "
                  "heights together at most %.3g",
                  model_.height_bound, height_limit_);
    const Layer& layer = recipe_.layers[static_cast<std::size_t>(*first_too_high_)];
    throw InputError(place_of(*first_too_high_) + "." + std::string(height_field(layer)) + words);
  }

  // Appends lists of impulses for the layer that is pushed next. Returns the number of the first list.
  std::uint32_t add_lists(std::uint32_t count, std::vector<ImpulseList>& lists) const {
    const auto first = static_cast<std::uint32_t>(lists.size());
    for (std::uint32_t i = 0; i < count; ++i) lists.push_back({number_of_next_layer(), i});
    return first;
  }
  std::uint32_t number_of_next_layer() const { return static_cast<std::uint32_t>(model_.layers.size()); }

  // Finds for each layer by how much it and all layers after it may change an elevation.
  void sum_changes() {
    double bound = 0.0;
    for (std::size_t i = model_.layers.size(); i-- > 0;) {
      bound += model_.layers[i].join.change_bound;
      model_.layers[i].join.remaining_change = static_cast<float>(bound * (1.0 + 1e-5));
    }
  }

  template <typename AnyLayer>
  int number_of(const AnyLayer& layer) const {
    return layer_number(layer.seed, index_);
  }

  const BareSurface& bare() {
    if (!bare_) bare_.emplace(bare_body(recipe_));
    return *bare_;
  }
  std::string place_of(int layer) const { return name_ + ": layers[" + std::to_string(layer) + "]"; }

  // Throws InputError where the spots so far take too long to compute, with all sizes of this layer.
  void check_work(const SpotLayer& layer) {
    ArrayStore discarded;
    const NoiseFrame whole(Box{{}, {}});
    const SpotNoise noise = make_noise(layer, recipe_.seed, number_of(layer), whole, discarded);
    spot_draws_ += draws_at_a_point(noise, discarded.view());
    expect_few_draws("density: these spots", spot_draws_, kMostSpotDraws,
                     "lower density, layers or size, or use larger cells or fewer parts");
  }
  // Throws InputError where the Gabor layers so far take too long to compute, with all bands of this layer.
  void check_work(const GaborLayer& layer) {
    ArrayStore discarded;
    const GaborSurfaceNoise noise = make_noise(layer, recipe_.seed, number_of(layer), Box{{}, {}}, discarded);
    gabor_draws_ += draws_at_a_point(noise, discarded.view());
    expect_few_draws("impulses_per_kernel: these impulses", gabor_draws_, kMostGaborDraws,
                     "lower impulses_per_kernel, or use lobes of fewer bandwidths");
  }
  void expect_few_draws(const std::string& what, double draws, double most, const std::string& remedy) const {
    if (draws <= most) return;
    const auto whole_number = [](double v) { return std::to_string(std::llround(v)); };
    throw InputError(place_of(index_) + "." + what + ", with those of earlier layers, take " +
                     whole_number(draws) + " random draws at each point, at most " + whole_number(most) +
                     " are allowed; " + remedy);
  }

  // A Gabor layer with `evaluation: tiles`, and what is made of it for every frame.
  struct TiledGaborLayer : GaborLayer {
    PhaseTileSet set;
  };

  // An exemplar with the anchors of a frame, which are added to `arrays`. It lies on the first `below` layers
  // of the model.
  ExemplarNoise placed(const ExemplarLayer& layer, const ExemplarNoise& made, std::size_t below,
                       const NoiseFrame& frame, ArrayStore& arrays) const {
    model_.update();
    return placed_exemplar(made, layer, recipe_.seed, number_of(layer), frame,
                           {ground_of(frame), field_below(model_, below, frame), model_.height_bound},
                           arrays);
  }
  // Tiles with the anchors of a frame, and the impulses of the narrow lobes.
  TiledGaborNoise placed(const TiledGaborLayer& layer, const NoiseFrame& frame, ArrayStore& arrays) const {
    std::vector<ExemplarNoise> tiles;
    for (const PhaseTileSet::Tile& tile : layer.set.tiles) {
      tiles.push_back(
          placed_exemplar(tile.made, tile.layer, tile.seed, 0, frame, {ground_of(frame)}, arrays));
    }
    return join_phase_tiles(layer, layer.set, tiles, gabor_impulses(layer.set.narrow, frame, arrays), arrays);
  }
  GaborSurfaceNoise gabor_impulses(const GaborLayer& layer, const NoiseFrame& frame,
                                   ArrayStore& arrays) const {
    const Vec3d e = supports_.extent();
    return make_noise(layer, recipe_.seed, number_of(layer), frame, std::max({e.x, e.y, e.z}), arrays);
  }
  // The body for the anchors of a frame. It is valid until the model's arrays grow.
  GaborGround ground_of(const NoiseFrame& frame) const {
    GaborGround ground{model_.body, model_.arrays.view(), model_.metaballs.lists()};
    if (frame.moved) ground.origin = &frame.origin;
    return ground;
  }

  // The noise of a layer in a frame with an origin of its own. The layer has or gets the number `number` in
  // the model.
  template <class AnyLayer>
  auto moved_noise(const AnyLayer& layer, std::size_t number, const NoiseFrame& frame,
                   ArrayStore& arrays) const {
    if constexpr (std::is_same_v<AnyLayer, ExemplarLayer>) {
      return placed(layer, exemplars_.at(index_), number, frame, arrays);
    } else if constexpr (std::is_same_v<AnyLayer, TiledGaborLayer>) {
      return placed(layer, frame, arrays);
    } else if constexpr (std::is_same_v<AnyLayer, GaborLayer>) {
      return gabor_impulses(layer, frame, arrays);
    } else {
      return make_noise(layer, recipe_.seed, number_of(layer), frame, arrays);
    }
  }

  // Whether float coordinates of the body's frame are too coarse for a noise in the field's patch.
  template <typename Noise>
  bool too_fine_for_body(const Noise& noise) const {
    if (!model_.patch || !model_.body.plain()) return false;
    if constexpr (std::is_same_v<Noise, FractalNoise>) {
      if (noise.has_local_form()) return noise.detail.left_out > 0.0;
    }
    return noise.detail.left_out > 0.0 ||
           largest_coordinate(domain_) > kMostPreciseCells * noise.detail.finest;
  }

  // A layer that stands in the frame of the patch. Its noise is made when all heights are known.
  struct PatchLayer {
    std::size_t layer;  // number in the model
    int index;          // place in the recipe
    double displaced;   // bound of the displacement of its coordinates, length units
  };

  // Leaves the noise of a layer to add_patch_noises() where the patch needs that. Returns a bound of its
  // heights.
  template <class AnyLayer, typename Noise>
  double height_bound_of(const AnyLayer& layer, const Noise& noise) {
    if (!too_fine_for_body(noise)) {
      report_left_out(index_, noise.detail);
      return noise.height_bound;
    }
    patch_layers_.push_back({model_.layers.size(), index_, largest_coordinate(Box{displaced_, displaced_})});
    ArrayStore discarded;
    const NoiseFrame whole(Box{{}, {}}, model_.patch->center);
    return std::max(noise.height_bound,
                    moved_noise(layer, model_.layers.size(), whole, discarded).height_bound);
  }

  void report_left_out(int index, const NoiseDetail& detail) {
    if (detail.left_out > 0.0) model_.left_out.push_back({index, detail.left_out, detail.finest});
  }

  // Makes the noises of the layers that are too fine for the body's frame. Points of a block lie within two
  // sides of the centre; Gabor noise is evaluated at their projections.
  void add_patch_noises() {
    if (patch_layers_.empty()) return;
    const PatchCube& patch = *model_.patch;
    make_patch_warp();
    const double warp = model_.patch_warp ? model_.patch_warp->bound : 0.0;
    for (const PatchLayer& l : patch_layers_) {
      index_ = l.index;
      const auto tiled = tiled_gabor_.find(l.index);
      if (tiled != tiled_gabor_.end()) {
        add_patch_noise(tiled->second, l, patch, warp);
        continue;
      }
      std::visit([&](const auto& layer) { add_patch_noise(layer, l, patch, warp); },
                 recipe_.layers[static_cast<std::size_t>(l.index)]);
    }
  }
  template <class AnyLayer>
  void add_patch_noise(const AnyLayer& layer, const PatchLayer& l, const PatchCube& patch, double warp) {
    if constexpr (requires { layer.use; }) {
      const bool on_surface =
          std::is_base_of_v<GaborLayer, AnyLayer> || std::is_same_v<AnyLayer, ExemplarLayer>;
      const double reach = 2.0 * patch.side + (on_surface ? warp + model_.height_bound : l.displaced) +
                           reach_of_exemplars_after(l.index);
      const NoiseFrame frame(widened(Box{{}, {}}, reach), patch.center);
      const auto noise = moved_noise(layer, l.layer, frame, model_.arrays);
      report_left_out(l.index, noise.detail);
      model_.layers[l.layer].in_patch = static_cast<std::int32_t>(model_.patch_noises.size());
      model_.patch_noises.push_back(LayerNoise(noise));
      model_.patch_caches.emplace_back();
      if constexpr (std::is_same_v<AnyLayer, GaborLayer>)
        model_.patch_caches.back().resize(noise.bands.count);
      if constexpr (std::is_same_v<AnyLayer, TiledGaborLayer>)
        model_.patch_caches.back().resize(noise.narrow.bands.count);
    }
  }
  // How far beyond the points of a patch the exemplars above a layer look for their slopes: the farthest
  // anchor of a point lies within an edge of it.
  double reach_of_exemplars_after(int index) const {
    double reach = 0.0;
    for (const auto& [at, made] : exemplars_) {
      const auto& layer = std::get<ExemplarLayer>(recipe_.layers[static_cast<std::size_t>(at)]);
      if (at > index) reach = std::max(reach, 2.0 * exemplar_edge(layer));
    }
    return reach;
  }
  // The body's warp in the frame of the patch, with the octaves that it has in the body's frame.
  void make_patch_warp() {
    model_.update();
    const BodyLeaf& first = model_.tables.leaf(0);
    if (!first.warped) return;
    const Vec3d& center = model_.patch->center;
    constexpr float kEverywhere = std::numeric_limits<float>::max();
    CoordinateWarp warp = first.warp;
    for (ArrayRange<NoiseOctave>& octaves : warp.octaves) {
      const std::span<const NoiseOctave> of_body = model_.arrays.view().span(octaves);
      octaves = model_.arrays.add(local_octaves(Noise::kSimplex, of_body, center));
    }
    warp.low = {-kEverywhere, -kEverywhere, -kEverywhere};
    warp.high = {kEverywhere, kEverywhere, kEverywhere};
    model_.patch_warp = warp;
  }

  // Whether the layer changes no elevation, but paints the surface.
  template <class AnyLayer>
  static bool has_no_height(const AnyLayer& layer) {
    if constexpr (std::is_same_v<AnyLayer, ExemplarLayer>) return !layer.has_height();
    return false;
  }

  template <class AnyLayer, typename Noise>
  void push(const AnyLayer& layer, const Noise& noise, std::uint32_t first_list = 0) {
    const LayerUse& use = *use_of(recipe_.layers[static_cast<std::size_t>(index_)]);
    LayerJoin join;
    join.how = use.combination;
    const bool only_paints = has_no_height(layer);
    if (only_paints) join.how.kind = Combine::kMask;
    join.height_bound = height_bound_of(layer, noise);
    join.displaced = displaced_;
    if (use.locality) {
      join.local = true;
      join.locality = make_local_weight(*use.locality, *recipe_.body, place_of(index_), model_.arrays);
    }
    if (use.mask) set_mask(*use.mask, join);
    const int last_use = masks_.last_use[static_cast<std::size_t>(index_)];
    if (last_use >= 0 && !only_paints) {
      slots_[index_] = join.keeps = mask_slots_.take(index_, last_use);
      model_.num_kept_heights = static_cast<std::uint32_t>(mask_slots_.count());
    }
    const double before = model_.height_bound;
    model_.height_bound = elevation_bound(join.how, before, join.height_bound);
    if (join.changes_elevation()) {
      const bool is_change = join.how.kind == Combine::kAdd;
      join.change_bound = is_change ? join.height_bound : before + model_.height_bound;
    }
    if (join.how.kind == Combine::kWarp) displace_later(join.how.direction, join.height_bound);
    if (!only_paints) numbers_[index_] = model_.layers.size();
    model_.layers.push_back({LayerNoise(noise), join, first_list});
  }

  // Widens the domain of the later layers, whose coordinates a warp displaces by up to |direction| * height.
  void displace_later(const Vec3d& direction, double height) {
    const Vec3d d{std::fabs(direction.x) * height, std::fabs(direction.y) * height,
                  std::fabs(direction.z) * height};
    displaced_ += d;
    domain_.min -= d;
    domain_.max += d;
  }

  void set_mask(const LayerMask& mask, LayerJoin& join) const {
    const auto slot = slots_.find(masks_.masking[static_cast<std::size_t>(index_)]);
    if (slot == slots_.end()) fail_without_height(mask, place_of(index_));
    join.mask = slot->second;
    set_range(mask, join);
  }
  [[noreturn]] static void fail_without_height(const LayerMask& mask, const std::string& place) {
    throw InputError(place + ".mask.layer: \"" + mask.layer +
                     "\" has no height; give that layer one, or name another");
  }
  static void set_range(const LayerMask& mask, LayerJoin& join) {
    join.mask_from = static_cast<float>(mask.from);
    join.mask_to = static_cast<float>(mask.to);
    join.mask_inverse_range = 1.0f / (join.mask_to - join.mask_from);
  }

  // Points of the bare surface, as craters are given them: on the metaballs' side of a plain body's warp.
  std::vector<Vec3d> unwarped(std::vector<Vec3d> points) const {
    const BodyLeaf& first = model_.tables.leaf(0);
    if (!model_.body.plain() || !first.warped) return points;
    for (Vec3d& p : points) {
      const Vec3f at = warped(first.warp, model_.tables.arrays, to_float(p));
      p = {at.x, at.y, at.z};
    }
    return points;
  }

  const Recipe& recipe_;
  const std::string& name_;  // name of the recipe, for errors
  FieldModel& model_;
  MaskPlan masks_;
  MaskSlots mask_slots_;
  double height_limit_;                // length units
  std::optional<int> first_too_high_;  // the layer since which elevations may reach the limit
  // No surface lies outside the supports of the body's kernels. `domain_` is where layers are evaluated: the
  // supports, widened by the warps of the body and of the layers so far.
  Box supports_, domain_;
  Vec3d displaced_;           // bound of the displacement of later layers along each axis, length units
  std::map<int, int> slots_;  // slot of the kept heights of each masking layer
  std::map<int, std::size_t> numbers_;  // number in the model of each layer of noise, by its place
  std::optional<double> height_reach_;  // set by height_reach()
  std::vector<PatchLayer> patch_layers_;
  double spot_draws_ = 0.0, gabor_draws_ = 0.0;  // by draws_at_a_point()
  std::map<int, ExemplarNoise> exemplars_;       // without anchors, by the layer's place in the recipe
  std::map<int, TiledGaborLayer> tiled_gabor_;   // by the layer's place in the recipe
  std::optional<BareSurface> bare_;              // made for the first layer that needs it
  int index_ = 0;
};

}  // namespace

void FieldModel::finish() {
  tables.spot_lists = arrays.add(spot_lists);
  tables.gabor_lists = arrays.add(gabor_lists);
  tables.crater_layers = arrays.add(crater_layers);
  tables.boulders = arrays.add(boulders);
  update();
}

void FieldModel::update() {
  tables.arrays = arrays.view();
  tables.layers = layers.data();
  tables.num_layers = static_cast<std::uint32_t>(layers.size());
  tables.num_kept_heights = num_kept_heights;
  tables.body = body;
  tables.height_bound = height_bound;
  tables.height_reach = static_cast<float>(height_bound * (1.0 + 1e-5));
  tables.longest_step = static_cast<float>(height_bound);
  tables.steepest = static_cast<float>(body.lipschitz_bound);
  tables.reads_projections = std::any_of(layers.begin(), layers.end(), [](const FieldLayer& layer) {
    const NoiseTraits traits = traits_of(layer.noise);
    return traits.on_surface && traits.bounded_by_box;
  });
  tables.patch_noises = patch_noises.data();
  if (patch) tables.patch_origin = patch->center;
}

void add_layers(const Recipe& recipe, const std::string& name, FieldModel& model, const Progress& progress) {
  LayerStack(recipe, name, model).add_all(progress);
}

}  // namespace astrolith
