#include <algorithm>
#include <limits>

#include "numerics/parallel_for.h"
#include "synthesis/field/layer_stack_internal.h"
#include "synthesis/landforms/ground_roughness.h"

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

template <class Landforms>
bool is_drawn_by_cells(const Landforms& layer) {
  return layer.population && layer.population->drawn.by_cells;
}

}  // namespace

void StackLandforms::add(const CraterLayer& layer) {
  FieldModel& model = stack_.model;
  std::vector<PlacedCrater> craters =
      place_craters(layer, bare(), stack_.recipe.seed, layer_number(layer.seed, stack_.index), stack_.place(),
                    crater_places(layer));
  std::vector<Vec3d> centers;
  for (const PlacedCrater& crater : craters) centers.push_back(crater.position);
  stack_.update_model();
  const std::vector<float> elevations = elevations_at(model, centers);
  centers = unwarped(std::move(centers));
  CraterRelief relief =
      make_crater_relief(layer, craters, centers, elevations, model.height_bound, model.arrays);
  relief.list = static_cast<std::uint32_t>(model.crater_layers.size());
  add_patch_craters(layer, relief, centers);
  model.crater_layers.push_back(static_cast<std::uint32_t>(model.layers.size()));
  model.crater_trees.push_back(crater_tree(model.arrays.view().span(relief.craters)));
  model.height_bound = relief.elevation_bound;
  LayerJoin join;
  join.height_bound = relief.elevation_bound;
  join.change_bound = std::numeric_limits<double>::infinity();  // craters replace the elevation
  model.layers.push_back({LayerNoise(relief), join});
  model.placed_craters.push_back({stack_.index, std::move(craters)});
}

// Adds the craters in the frame of the patch, if the layer draws them by cells. Their bases and all but
// their centres are those in the body's frame.
void StackLandforms::add_patch_craters(const CraterLayer& layer, const CraterRelief& relief,
                                       std::span<const Vec3d> centers) {
  FieldModel& model = stack_.model;
  model.patch_craters.emplace_back();
  if (!is_drawn_by_cells(layer) || !model.patch || !model.body.plain()) return;
  const std::span<const CraterKernel> in_body = model.arrays.view().span(relief.craters);
  std::vector<CraterKernel> craters(in_body.begin(), in_body.end());
  for (std::size_t i = 0; i < craters.size(); ++i) {
    const Vec3f center = to_float(centers[i] - model.patch->center);
    craters[i].x = center.x;
    craters[i].y = center.y;
    craters[i].z = center.z;
  }
  CraterRelief moved = relief;
  moved.craters = model.arrays.add(craters);
  model.patch_craters.back() = PatchCraters{moved, crater_tree(craters)};
  model.has_patch_layers = true;
}

void StackLandforms::add_boulders(const Progress& progress) {
  FieldModel& model = stack_.model;
  model.update();
  const Terrain terrain{[&model](const Vec3d& p) { return static_cast<double>(value_at(model, p)); },
                        model.height_bound};
  std::vector<FieldBoulder> all;
  for (const auto& [layer, index] : boulder_layers_) {
    stack_.index = index;
    std::vector<PlacedBoulder> placed =
        place_boulders(*layer, bare(), terrain, stack_.recipe.seed, layer_number(layer->seed, index),
                       stack_.place(), progress, boulder_places(*layer, progress));
    const std::vector<FieldBoulder> boulders = field_boulders(*layer, placed);
    all.insert(all.end(), boulders.begin(), boulders.end());
    add_patch_boulders(*layer, placed);
    model.placed_boulders.push_back({index, std::move(placed)});
  }
  std::vector<Box> boxes;
  for (const FieldBoulder& boulder : all) boxes.push_back(boulder.box);
  model.boulder_tree = BoxTree(boxes);
  model.boulders = std::move(all);
}

// Adds the boulders in the frame of the patch, if the layer draws them by cells.
void StackLandforms::add_patch_boulders(const BoulderLayer& layer, std::vector<PlacedBoulder> boulders) {
  FieldModel& model = stack_.model;
  if (!is_drawn_by_cells(layer) || !model.patch) {
    return model.patch_boulders.resize(model.patch_boulders.size() + boulders.size());
  }
  model.has_patch_layers = true;
  for (PlacedBoulder& boulder : boulders) boulder.center -= model.patch->center;
  for (const FieldBoulder& boulder : field_boulders(layer, boulders)) {
    model.patch_boulders.emplace_back(boulder.kernel);
  }
}

// Where the drawn craters of a layer may lie. The base of a crater depends on older ones that cover its
// centre, so that craters matter somewhat beyond what they cover.
DrawingPlaces StackLandforms::crater_places(const CraterLayer& layer) {
  constexpr double kBaseReach = 4.0;  // extents of the largest crater
  if (!layer.population) return {};
  const Population& drawn = layer.population->drawn;
  DrawingPlaces places{place_weight(drawn), {}, 0.5, 0.0, {}};
  if (!drawn.by_cells) return places;
  report_sizes_left_out(drawn);
  if (!stack_.model.patch) return places;
  const double extent = std::max(layer.simple.extent, layer.complex_from ? layer.complex.extent : 0.0);
  places.reach = kBaseReach * 0.5 * extent;
  places.margin = height_reach() + widest_boulder();
  places.region = patch_box();
  return places;
}

DrawingPlaces StackLandforms::boulder_places(const BoulderLayer& layer, const Progress& progress) {
  if (!layer.population) return {};
  const Population& drawn = layer.population->drawn;
  DrawingPlaces places{place_weight(drawn), {}, drawn_reach(layer), stack_.model.height_bound, progress};
  if (!drawn.by_cells) return places;
  report_sizes_left_out(drawn);
  if (stack_.model.patch) places.region = patch_box();
  return places;
}

// The patch, with a margin for the differences that give normals.
Box StackLandforms::patch_box() const {
  const Vec3d& center = stack_.model.patch->center;
  return widened(Box{center, center}, 0.51 * stack_.model.patch->side);
}

// How far a boulder that is drawn by cells reaches at most, of later layers too; length units.
double StackLandforms::widest_boulder() const {
  double widest = 0.0;
  for (const Layer& layer : stack_.recipe.layers) {
    std::visit(
        [&]<class Kind>(const Kind& l) {
          if constexpr (!Kind::kTraits.is_noise) {
            if (is_drawn_by_cells(l)) {
              widest = std::max(widest, drawn_reach(l) * l.population->drawn.greatest_diameter);
            }
          }
        },
        layer);
  }
  return widest;
}

// A bound of all elevations, those of this layer and of later ones too; length units.
double StackLandforms::height_reach() {
  const NoiseFrame whole(Box{{}, {}});  // a domain without extent leaves out no size of a layer
  double bound = stack_.model.height_bound;
  for (int i = stack_.index; i < static_cast<int>(stack_.recipe.layers.size()); ++i) {
    const Layer& layer = stack_.recipe.layers[static_cast<std::size_t>(i)];
    const auto add = [&]<class Kind>(const Kind& kind) {
      if constexpr (!Kind::kTraits.is_noise) {
        bound += largest_rise(kind);
      } else if (has_height(layer)) {
        ArrayStore discarded;
        const LayerSource source{stack_.recipe, layer_number(kind.seed, i), stack_.layer_path(i),
                                 stack_.model.shared.get()};
        const LayerNoise noise =
            layer_maker(layer, source, discarded)(stack_.site(whole, stack_.model.layers.size()), discarded);
        bound = elevation_bound(kind.use.combination, bound, noise_height_bound(noise));
      }
    };
    std::visit(add, layer);
  }
  return bound;
}

// The weight of the places of a population; empty where it is 1 everywhere. It reads the model as it is
// when it is called.
PlaceWeight StackLandforms::place_weight(const Population& drawn) {
  if (!drawn.locality && !drawn.mask) return {};
  stack_.update_model();
  const std::string place = stack_.place() + ".population";
  const auto arrays = std::make_shared<ArrayStore>();
  std::optional<LocalWeight> local;
  if (drawn.locality) local = make_local_weight(*drawn.locality, *stack_.recipe.body, place, *arrays);
  const PlaceWeight mask = place_mask(drawn, place);
  return [arrays, local, mask](const Vec3d& p) {
    float weight = mask ? mask(p) : 1.0f;
    if (local) weight *= weight_at(*local, arrays->view(), to_float(p));
    return weight;
  };
}

// The weight by a population's mask; empty where it has none.
PlaceWeight StackLandforms::place_mask(const Population& drawn, const std::string& place) {
  if (!drawn.mask) return {};
  const auto number = stack_.numbers.find(stack_.masking());
  if (number == stack_.numbers.end()) fail_without_height(*drawn.mask, place);
  LayerJoin join;
  set_mask_range(*drawn.mask, join);
  const auto height = [&model = stack_.model, masking = number->second](const Vec3d& p) {
    return layer_height_at(model, masking, p);
  };
  if (!drawn.mask->over) {
    return [height, join](const Vec3d& p) {
      return smooth_step(height(p), join.mask_from, join.mask_inverse_range);
    };
  }
  return [height, join, over = *drawn.mask->over, &surface = bare()](const Vec3d& p) {
    const double roughness = roughness_around(p, surface.normal(p), over, height);
    return smooth_step(static_cast<float>(roughness), join.mask_from, join.mask_inverse_range);
  };
}

void StackLandforms::report_sizes_left_out(const Population& drawn) {
  const SizesByCells sizes = sizes_by_cells(drawn, bare(), !stack_.model.patch);
  if (sizes.number_left_out == 0.0) return;
  stack_.model.left_out.push_back(
      {stack_.index, sizes.share_left_out, drawn.least_diameter, sizes.number_left_out});
}

const BareSurface& StackLandforms::bare() {
  if (!bare_) bare_.emplace(bare_body(stack_.recipe));
  return *bare_;
}

// Points of the bare surface, as craters are given them: on the metaballs' side of a plain body's warp.
std::vector<Vec3d> StackLandforms::unwarped(std::vector<Vec3d> points) const {
  const FieldView& tables = stack_.model.tables;
  const BodyLeaf& first = tables.leaf(0);
  if (!stack_.model.body.plain() || !first.warped) return points;
  for (Vec3d& p : points) {
    const Vec3f at = warped(first.warp, tables.arrays, to_float(p));
    p = {at.x, at.y, at.z};
  }
  return points;
}

}  // namespace astrolith
