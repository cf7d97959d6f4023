#include "synthesis/field/surface_colors.h"

#include <algorithm>
#include <array>

#include "synthesis/exemplar/exemplar_colors.h"
#include "synthesis/field/point_chunks_internal.h"

namespace astrolith {
namespace {

std::uint8_t color_byte(float value) {
  return static_cast<std::uint8_t>(255.0f * math::clamp(value, 0.0f, 1.0f) + 0.5f);
}

// What a layer paints that paints().
LayerPaint make_paint(const Layer& layer, const std::string& place, ArrayStore& textures) {
  return std::visit(
      [&](const auto& l) -> LayerPaint {
        if constexpr (requires { l.paints(); }) {
          return paint_of(l, place, textures);
        } else {
          return {};
        }
      },
      layer);
}

}  // namespace

bool has_colors(const Recipe& recipe) {
  return std::any_of(recipe.layers.begin(), recipe.layers.end(), paints);
}

SurfaceColors::SurfaceColors(const Recipe& recipe, const std::string& name, const ImplicitField& field)
    : field_(field) {
  const std::span<const int> places = field.recipe_layers();
  for (std::uint32_t number = 0; number < places.size(); ++number) {
    const auto i = static_cast<std::size_t>(places[number]);
    if (!paints(recipe.layers[i])) continue;
    paints_.push_back(make_paint(recipe.layers[i], name + ": layers[" + std::to_string(i) + "]", textures_));
    paints_.back().layer = number;
  }
  for (LayerPaint& paint : paints_) paint.arrays = textures_.view();
}

SurfaceColors::~SurfaceColors() = default;

template <class Local>
void SurfaceColors::paint_points(const Vec3d& origin, const Local& local,
                                 std::span<VertexColor> colors) const {
  for_each_chunk(field_, origin, colors.size(), local, [&](const PointChunk& chunk) {
    constexpr float kBare = static_cast<float>(kBareColor[0]) / 255.0f;
    std::array<Vec3f, PointChunk::kMost> painted;
    painted.fill({kBare, kBare, kBare});
    chunk.block.paint(paints_, chunk.origin, chunk.along(0), chunk.along(1), chunk.along(2),
                      {painted.data(), chunk.count});
    for (std::size_t i = 0; i < chunk.count; ++i) {
      colors[chunk.first + i] = {color_byte(painted[i].x), color_byte(painted[i].y),
                                 color_byte(painted[i].z)};
    }
  });
}

void SurfaceColors::paint(const Vec3d& origin, std::span<const MeshVertex> vertices,
                          std::span<VertexColor> colors) const {
  paint_points(
      origin, [&](std::size_t i) { return vertices[i].position; }, colors);
}

std::vector<VertexColor> SurfaceColors::colors_of(const Vec3d& origin, const TriangleMesh& mesh) const {
  std::vector<VertexColor> colors(mesh.vertices.size());
  paint_points(
      origin, [&](std::size_t i) { return to_float(mesh.vertices[i]); }, colors);
  return colors;
}

}  // namespace astrolith
