// What is certain about a field over whole boxes.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "synthesis/field/content_bounds.h"
#include "synthesis/field/field_model_internal.h"

namespace astrolith {
namespace {

// A box as a layer needs it.
struct LayerBox {
  const Box& box;
  const Box& projected;       // where its points are projected on the bare surface
  const SpotImpulses* spots;  // of the layer, that reach the box; null where none were drawn
};

// A layer's heights over a box.
template <typename Noise>
Interval bound_layer(const Noise& noise, const LayerBox& at) {
  return noise.bound_heights(at.box);
}
Interval bound_layer(const SpotNoise& noise, const LayerBox& at) {
  return noise.bound_heights(at.box, at.spots);
}
Interval bound_layer(const GaborSurfaceNoise& noise, const LayerBox&) {
  return {-noise.height_bound(), noise.height_bound()};
}

// Heights over a box that masks ask for, by slot.
using KeptIntervals = std::vector<Interval>;

// Weights over a box; neither is below 0.
Interval bound_weight(const LayerJoin& join, const Box& box, const KeptIntervals& kept) {
  const Interval all{1.0, 1.0};
  return product(join.locality ? join.locality->bound(box) : all,
                 join.mask ? join.mask->bound(kept[static_cast<std::size_t>(join.mask->slot)]) : all);
}

// Elevations over a box from those that the layers before made.
template <typename Noise>
Interval bound_elevation(const Noise& noise, const LayerJoin& join, const LayerBox& at, const Box& box,
                         const Interval& before, KeptIntervals& kept) {
  const Interval heights = bound_layer(noise, at);
  if (join.keeps >= 0) {
    const double slack = kHeightSlack * join.height_bound;
    kept[static_cast<std::size_t>(join.keeps)] = plus(heights, {-slack, slack});
  }
  return join.changes_elevation() ? join_bounds(join.how, bound_weight(join, box, kept), before, heights)
                                  : before;
}
Interval bound_elevation(const CraterRelief& relief, const LayerJoin&, const LayerBox& at, const Box&,
                         const Interval& before, KeptIntervals&) {
  return relief.bound(at.projected, before);
}

Interval bound_heights(const FieldModel& model, const DrawnSpots& spots, const Box& box,
                       const Box& projected) {
  Interval elevation;
  KeptIntervals kept(static_cast<std::size_t>(model.kept_heights));
  for (std::size_t i = 0; i < model.layers.size(); ++i) {
    const PlacedLayer& layer = model.layers[i];
    const Box where = layer_box(layer, box);
    const LayerBox at{where, projected, spots_of(spots, i)};
    elevation = std::visit(
        [&](const auto& l) { return bound_elevation(l, layer.join, at, box, elevation, kept); }, layer.noise);
  }
  const double slack = kHeightSlack * model.height_bound;
  return {elevation.low - slack, elevation.high + slack};
}

// By the bound of all heights everywhere, which costs nothing; near the surface or far.
BlockContent content_by_height_bound(const FieldModel& model, const PreparedBody& body, const Box& at) {
  if (body.plain()) return content_by_height_bound(bound_metaballs(body.metaballs, at), model.height_bound);
  const double height = model.height_bound * (1.0 + kHeightSlack);
  return content_by_distance(bound_distance(body, at, height), {-height, height});
}

std::array<Box, 8> octants(const Box& box) {
  const Vec3d c = box.center();
  std::array<Box, 8> children;
  for (unsigned k = 0; k < 8; ++k) {
    Box& child = children[k];
    child.min = {k & 1 ? c.x : box.min.x, k & 2 ? c.y : box.min.y, k & 4 ? c.z : box.min.z};
    child.max = {k & 1 ? box.max.x : c.x, k & 2 ? box.max.y : c.y, k & 4 ? box.max.z : c.z};
  }
  return children;
}

bool within(const Box& inner, const Box& outer) {
  return inner.min.x >= outer.min.x && inner.min.y >= outer.min.y && inner.min.z >= outer.min.z &&
         inner.max.x <= outer.max.x && inner.max.y <= outer.max.y && inner.max.z <= outer.max.z;
}

// Extends `bounds` by the smallest boxes of an octree that are not proved empty. The grid of a mesh depends
// on the result: it is a promise that it does not change.
void extend_bounds(const FieldModel& model, const PreparedBody& body, const Box& box, int depth,
                   Box& bounds) {
  if (!bounds.empty() && within(box, bounds)) return;
  const Box at = body_box(model, box);
  const PreparedBody reaching = body_reaching(body, at);
  const BlockContent content = content_by_height_bound(model, reaching, at);
  if (content == BlockContent::kOutside) return;
  if (depth == 0 || content == BlockContent::kInside) {
    bounds.extend(box.min);
    bounds.extend(box.max);
    return;
  }
  for (const Box& child : octants(box)) extend_bounds(model, reaching, child, depth - 1, bounds);
}

}  // namespace

Box body_box(const FieldModel& model, const Box& box) { return model.warp ? model.warp->image(box) : box; }

namespace {

BlockContent content_of_combined(const FieldModel& model, const PreparedBody& body, const DrawnSpots& spots,
                                 const Box& box) {
  const double height = model.height_bound * (1.0 + kHeightSlack);
  const Interval distance = bound_distance(body, box, height);
  const BlockContent content = content_by_distance(distance, {-height, height});
  if (content != BlockContent::kMixed || model.layers.empty()) return content;
  const Box projected = projected_box(box, distance, height);
  return content_by_distance(distance, bound_heights(model, spots, box, projected));
}

BlockContent content_without_boulders(const FieldModel& model, const PreparedBody& body,
                                      const DrawnSpots& spots, const Box& box) {
  if (!body.plain()) return content_of_combined(model, body, spots, box);
  const Box at = body_box(model, box);
  const MetaballInterval bound = bound_metaballs(body.metaballs, at, model.height_bound);
  const BlockContent content = content_by_height_bound(bound, model.height_bound);
  if (content != BlockContent::kMixed || model.layers.empty()) return content;
  const auto divisor = [&] { return smallest_gradient(body.metaballs, at); };
  const Box projected = model.craters.empty() ? at : projected_box(at, bound, model.height_bound, divisor());
  return content_by_heights(bound, bound_heights(model, spots, box, projected), divisor);
}

}  // namespace

// A union only adds.
BlockContent content_of(const FieldModel& model, const PreparedBody& body, const DrawnSpots& spots,
                        const Box& box) {
  const BlockContent content = content_without_boulders(model, body, spots, box);
  const bool boulders = content == BlockContent::kOutside && model.boulders.touches(box);
  return boulders ? BlockContent::kMixed : content;
}

DrawnSpots spots_reaching(const FieldModel& model, const Box& box, const DrawnSpots& of_larger) {
  DrawnSpots spots;
  for (std::size_t i = 0; i < model.layers.size(); ++i) {
    const auto* noise = std::get_if<SpotNoise>(&model.layers[i].noise);
    if (noise == nullptr) continue;
    spots.resize(model.layers.size());
    spots[i] = noise->gather(layer_box(model.layers[i], box), spots_of(of_larger, i));
  }
  return spots;
}

// Repeated on what is left until that stops shrinking much, because supports reach far beyond the surface.
Box surface_bounds(const FieldModel& model) {
  constexpr int kDepth = 6;
  Box box = support_bounds(model.body);
  if (model.warp) box = widened(box, model.warp->bound());
  for (int pass = 0; pass < 4; ++pass) {
    Box tighter;
    extend_bounds(model, model.body, box, kDepth, tighter);
    if (tighter.empty()) return tighter;
    const bool shrunk = norm(tighter.extent()) < 0.7 * norm(box.extent());
    box = tighter;
    if (!shrunk) break;
  }
  if (!model.boulders.empty()) {
    box.extend(model.boulders.bounds().min);
    box.extend(model.boulders.bounds().max);
  }
  return box;
}

}  // namespace astrolith
