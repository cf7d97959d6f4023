#include "synthesis/field/surface_labels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/interval.h"
#include "numerics/parallel_for.h"
#include "synthesis/gabor/gabor_tiles.h"

namespace astrolith {
namespace {

constexpr double kRounding = 4e-6;  // rounding of F, relative to the largest coordinate

bool is_boulders(const Layer& layer) { return std::holds_alternative<BoulderLayer>(layer); }

// The numbers of the layers in the order in which they make the surface: boulders last.
std::vector<std::size_t> order_of_layers(const Recipe& recipe) {
  std::vector<std::size_t> order;
  for (const bool boulders : {false, true}) {
    for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
      if (is_boulders(recipe.layers[i]) == boulders) order.push_back(i);
    }
  }
  return order;
}

// A layer that changes nothing. It keeps the place of a layer in the recipe, because the random numbers of
// other layers depend on their place.
Layer idle() { return BoulderLayer{}; }

std::string meaning(std::size_t label, const Layer& layer) {
  return std::visit(
      [&](const auto& l) {
        return "label " + std::to_string(label) + ": " + std::string(type_word(layer)) +
               (l.name.empty() ? "" : " \"" + l.name + "\"");
      },
      layer);
}

}  // namespace

SurfaceLabels::SurfaceLabels(const Recipe& recipe, const std::string& name,
                             const std::optional<PatchCube>& patch) {
  Recipe so_far = recipe;
  std::fill(so_far.layers.begin(), so_far.layers.end(), idle());
  stages_.push_back({0, false, ImplicitField(so_far, name, patch)});
  for (const std::size_t i : order_of_layers(recipe)) {
    so_far.layers[i] = recipe.layers[i];
    stages_.push_back(
        {static_cast<int>(i) + 1, is_boulders(recipe.layers[i]), ImplicitField(so_far, name, patch)});
  }
  legend_.push_back("label 0: the bare body");
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    legend_.push_back(meaning(i + 1, recipe.layers[i]));
  }
  const ImplicitField& whole = stages_.back().field;
  in_patch_ = whole.has_patch_layers();
  const double largest =
      in_patch_ ? std::max(patch->side, whole.height_bound()) : largest_coordinate(whole.bounds());
  rounding_ = static_cast<float>(kRounding * largest);
}

// A field has the lists of the layers up to its own, which are the first lists of the whole recipe.
std::vector<int> SurfaceLabels::fields_with_impulses() const {
  std::vector<int> counts(stages_.back().field.gabor_caches().size(), 0);
  for (const Stage& stage : stages_) {
    const std::size_t lists = stage.field.gabor_caches().size();
    for (std::size_t i = 0; i < lists; ++i) ++counts[i];
  }
  return counts;
}

void SurfaceLabels::label(const Vec3d& origin, std::span<const MeshVertex> vertices,
                          std::span<VertexLabel> labels) const {
  label(origin, vertices, labels, {});
}

void SurfaceLabels::label(const Vec3d& origin, std::span<const MeshVertex> vertices,
                          std::span<VertexLabel> labels, std::span<float> ground) const {
  const std::size_t chunks = (vertices.size() + kLabelsChunk - 1) / kLabelsChunk;
  parallel_for(0, static_cast<std::int64_t>(chunks), [&](std::int64_t c) {
    const std::size_t first = static_cast<std::size_t>(c) * kLabelsChunk;
    const std::size_t count = std::min(kLabelsChunk, vertices.size() - first);
    label_some(origin, vertices.subspan(first, count), labels.subspan(first, count),
               ground.empty() ? ground : ground.subspan(first, count));
  });
}

void SurfaceLabels::label_some(const Vec3d& origin, std::span<const MeshVertex> vertices,
                               std::span<VertexLabel> labels, std::span<float> ground) const {
  const std::size_t n = vertices.size();
  std::array<float, kLabelsChunk> x, y, z, lx, ly, lz, bare, before, after, largest;
  Box box;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3f& local = vertices[i].position;
    lx[i] = local.x, ly[i] = local.y, lz[i] = local.z;
    x[i] = static_cast<float>(origin.x + double{vertices[i].position.x});
    y[i] = static_cast<float>(origin.y + double{vertices[i].position.y});
    z[i] = static_cast<float>(origin.z + double{vertices[i].position.z});
    box.extend({double{x[i]}, double{y[i]}, double{z[i]}});
  }
  for (const Stage& stage : stages_) {
    const FieldBlock block = stage.field.gather(box);
    if (in_patch_) {
      block.evaluate_local(origin, {lx.data(), n}, {ly.data(), n}, {lz.data(), n}, {after.data(), n},
                           kExactEverywhere);
    } else {
      block.evaluate({x.data(), n}, {y.data(), n}, {z.data(), n}, {after.data(), n});
    }
    const bool is_bare = stage.label == 0;
    for (std::size_t i = 0; i < n; ++i) {
      const float change = is_bare ? rounding_ : std::fabs(after[i] - before[i]);
      if (is_bare) bare[i] = after[i];
      if (is_bare || change > largest[i]) {
        largest[i] = change;
        labels[i].label = stage.label;
      }
      labels[i].elevation = after[i] - bare[i];
    }
    if (!ground.empty() && !stage.is_boulders) std::copy_n(after.begin(), n, ground.begin());
    before = after;
  }
}

}  // namespace astrolith
