#include "synthesis/field/surface_colors.h"

#include <algorithm>
#include <array>

#include "numerics/parallel_for.h"
#include "synthesis/exemplar/exemplar_colors.h"
#include "synthesis/field/layer_paint_internal.h"

namespace astrolith {
namespace {

constexpr std::size_t kColorsChunk = 256;  // points of one gathered block

std::uint8_t color_byte(float value) {
  return static_cast<std::uint8_t>(255.0f * math::clamp(value, 0.0f, 1.0f) + 0.5f);
}

LayerPaint paint_of(const ExemplarLayer& layer, const std::string& place, ArrayStore& textures) {
  const ExemplarColors colors = exemplar_colors(layer, place);
  LayerPaint paint;
  paint.mean = to_float(colors.mean);
  for (const ColorChannel& channel : colors.channels) {
    paint.channels.push_back({make_exemplar_texture(channel.layer, place, textures), to_float(channel.axis)});
  }
  return paint;
}

// What a layer paints that paints().
LayerPaint make_paint(const Layer& layer, const std::string& place, ArrayStore& textures) {
  return std::visit(
      [&]<class Kind>(const Kind& l) -> LayerPaint {
        if constexpr (Kind::kTraits.paints_bodies) {
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

void SurfaceColors::paint(const Vec3d& origin, std::span<const MeshVertex> vertices,
                          std::span<VertexColor> colors) const {
  const std::size_t chunks = (vertices.size() + kColorsChunk - 1) / kColorsChunk;
  parallel_for(0, static_cast<std::int64_t>(chunks), [&](std::int64_t c) {
    const std::size_t first = static_cast<std::size_t>(c) * kColorsChunk;
    const std::size_t count = std::min(kColorsChunk, vertices.size() - first);
    paint_some(origin, vertices.subspan(first, count), colors.subspan(first, count));
  });
}

std::vector<VertexColor> SurfaceColors::colors_of(const Vec3d& origin, const TriangleMesh& mesh) const {
  std::vector<VertexColor> colors(mesh.vertices.size());
  const std::size_t chunks = (colors.size() + kColorsChunk - 1) / kColorsChunk;
  parallel_for(0, static_cast<std::int64_t>(chunks), [&](std::int64_t c) {
    const std::size_t first = static_cast<std::size_t>(c) * kColorsChunk;
    const std::size_t count = std::min(kColorsChunk, colors.size() - first);
    std::array<MeshVertex, kColorsChunk> vertices;
    for (std::size_t i = 0; i < count; ++i) vertices[i] = {to_float(mesh.vertices[first + i]), {}};
    paint_some(origin, {vertices.data(), count}, {&colors[first], count});
  });
  return colors;
}

void SurfaceColors::paint_some(const Vec3d& origin, std::span<const MeshVertex> vertices,
                               std::span<VertexColor> colors) const {
  const bool in_patch = field_.has_patch_layers();
  const std::size_t n = vertices.size();
  std::array<float, kColorsChunk> x, y, z;
  Box box;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3f& local = vertices[i].position;
    const Vec3d p{origin.x + double{local.x}, origin.y + double{local.y}, origin.z + double{local.z}};
    const Vec3f at = to_float(p);
    box.extend({double{at.x}, double{at.y}, double{at.z}});
    const Vec3f& given = in_patch ? local : at;
    x[i] = given.x, y[i] = given.y, z[i] = given.z;
  }
  constexpr float kBare = static_cast<float>(kBareColor[0]) / 255.0f;
  std::array<Vec3f, kColorsChunk> painted;
  std::fill_n(painted.begin(), n, Vec3f{kBare, kBare, kBare});
  field_.gather(box).paint(paints_, in_patch ? &origin : nullptr, {x.data(), n}, {y.data(), n}, {z.data(), n},
                           {painted.data(), n});
  for (std::size_t i = 0; i < n; ++i) {
    colors[i] = {color_byte(painted[i].x), color_byte(painted[i].y), color_byte(painted[i].z)};
  }
}

}  // namespace astrolith
