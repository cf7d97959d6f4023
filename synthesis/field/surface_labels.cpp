#include "synthesis/field/surface_labels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/interval.h"
#include "synthesis/field/point_chunks_internal.h"

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
    : field_(field) {
  legend_.push_back("label 0: the bare body");
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    legend_.push_back(meaning(i + 1, recipe.layers[i]));
  }
  const double largest = field.has_patch_layers() && field.has_local_form()
                             ? std::max(patch->side, field.height_bound())
                             : largest_coordinate(field.bounds());
  rounding_ = static_cast<float>(kRounding * largest);
}

void SurfaceLabels::label(const Vec3d& origin, std::span<const MeshVertex> vertices,
                          std::span<VertexLabel> labels, std::span<float> ground) const {
  const auto local = [&](std::size_t i) { return vertices[i].position; };
  for_each_chunk(field_, origin, vertices.size(), local, [&](const PointChunk& chunk) {
    std::array<float, PointChunk::kMost> bare, before, largest;
    const auto compare = [&](std::size_t first, const FieldStage& stage) {
      const bool is_bare = stage.layer < 0;
      for (std::size_t k = 0; k < stage.value.size(); ++k) {
        const std::size_t i = first + k;
        VertexLabel& label = labels[chunk.first + i];
        const float after = stage.value[k];
        const float change = is_bare ? rounding_ : std::fabs(after - before[i]);
        if (is_bare) bare[i] = after;
        if (is_bare || change > largest[i]) {
          largest[i] = change;
          label.label = stage.layer + 1;
        }
        label.elevation = after - bare[i];
        before[i] = after;
        if (!ground.empty() && !stage.is_boulders) ground[chunk.first + i] = after;
      }
    };
    chunk.block.evaluate_stages(chunk.origin, chunk.along(0), chunk.along(1), chunk.along(2), compare);
  });
}

}  // namespace astrolith
