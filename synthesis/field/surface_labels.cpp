#include "synthesis/field/surface_labels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/interval.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr double kRounding = 4e-6;  // rounding of F, relative to the largest coordinate

std::string meaning(std::size_t label, const Layer& layer) {
  return std::visit(
      [&](const auto& l) {
        return "label " + std::to_string(label) + ": " + std::string(type_word(layer)) +
               (l.name.empty() ? "" : " \"" + l.name + "\"");
      },
      layer);
}

}  // namespace

SurfaceLabels::SurfaceLabels(const Recipe& recipe, const ImplicitField& field,
                             const std::optional<PatchCube>& patch)
    : field_(field), in_patch_(field.has_patch_layers()) {
  legend_.push_back("label 0: the bare body");
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    legend_.push_back(meaning(i + 1, recipe.layers[i]));
  }
  const double largest = in_patch_ && field.has_local_form() ? std::max(patch->side, field.height_bound())
                                                             : largest_coordinate(field.bounds());
  rounding_ = static_cast<float>(kRounding * largest);
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
  std::array<float, kLabelsChunk> x, y, z, lx, ly, lz, bare, before, largest;
  Box box;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3f& local = vertices[i].position;
    lx[i] = local.x, ly[i] = local.y, lz[i] = local.z;
    x[i] = static_cast<float>(origin.x + double{local.x});
    y[i] = static_cast<float>(origin.y + double{local.y});
    z[i] = static_cast<float>(origin.z + double{local.z});
    box.extend({double{x[i]}, double{y[i]}, double{z[i]}});
  }
  const auto compare = [&](std::size_t first, const FieldStage& stage) {
    const bool is_bare = stage.layer < 0;
    for (std::size_t k = 0; k < stage.value.size(); ++k) {
      const std::size_t i = first + k;
      const float after = stage.value[k];
      const float change = is_bare ? rounding_ : std::fabs(after - before[i]);
      if (is_bare) bare[i] = after;
      if (is_bare || change > largest[i]) {
        largest[i] = change;
        labels[i].label = stage.layer + 1;
      }
      labels[i].elevation = after - bare[i];
      before[i] = after;
      if (!ground.empty() && !stage.is_boulders) ground[i] = after;
    }
  };
  const FieldBlock block = field_.gather(box);
  if (in_patch_) {
    block.evaluate_stages(&origin, {lx.data(), n}, {ly.data(), n}, {lz.data(), n}, compare);
  } else {
    block.evaluate_stages(nullptr, {x.data(), n}, {y.data(), n}, {z.data(), n}, compare);
  }
}

}  // namespace astrolith
