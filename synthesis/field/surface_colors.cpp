#include "synthesis/field/surface_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/hash_random.h"
#include "numerics/srgb.h"
#include "synthesis/field/layer_join.h"
#include "synthesis/field/point_chunks_internal.h"
#include "synthesis/landforms/boulder_field.h"
#include "synthesis/landforms/crater_relief.h"

namespace astrolith {
namespace {

std::uint8_t color_byte(float value) {
  return static_cast<std::uint8_t>(255.0f * math::clamp(value, 0.0f, 1.0f) + 0.5f);
}

VertexColor color_bytes(const Vec3f& color) {
  return {color_byte(color.x), color_byte(color.y), color_byte(color.z)};
}

template <class Function>
Vec3f each_channel(const Function& function, const Vec3f& v) {
  const auto of = [&](float x) { return static_cast<float>(function(double{x})); };
  return {of(v.x), of(v.y), of(v.z)};
}

Vec3f encoded(const Vec3d& linear) { return each_channel(linear_to_srgb, to_float(linear)); }

Vec3f logarithms(const Vec3d& factors) {
  return each_channel([](double factor) { return portable::log(factor); }, to_float(factors));
}

// What a layer paints that paints().
LayerPaint make_paint(const Layer& layer, const std::string& place, ArrayStore& textures) {
  return std::visit(
      [&](const auto& l) -> LayerPaint {
        if constexpr (requires { l.paints(); }) {
          return make_exemplar_paint(l, place, textures);
        } else {
          return {};
        }
      },
      layer);
}

NoiseTone make_tone(const LayerAlbedo& albedo, double height, double light_of_albedo) {
  NoiseTone tone;
  tone.covers = albedo.normal.has_value();
  if (tone.covers) tone.color = encoded(light_of_albedo * *albedo.normal * albedo.color);
  if (albedo.contrast != 0.0 && std::fabs(height) > 1e-20)
    tone.per_height = static_cast<float>(albedo.contrast / height);
  return tone;
}

CraterTone make_tone(const CraterLayer& layer, std::span<const PlacedCrater> craters) {
  CraterTone tone;
  tone.fresh = logarithms(layer.albedo->fresh * layer.albedo->color);
  double oldest = layer.population ? layer.population->greatest_age : 0.0;
  for (const PlacedCrater& crater : craters) oldest = std::max(oldest, crater.age);
  for (const PlacedCrater& crater : craters)
    tone.freshness.push_back(oldest > 0.0 ? static_cast<float>(1.0 - crater.age / oldest) : 1.0f);
  return tone;
}

// The tone of a boulder by its own random numbers, which its noise begins with.
BoulderTone make_tone(const BoulderAlbedo& albedo, const PlacedBoulder& boulder, double light_of_albedo) {
  constexpr std::uint64_t kStream = 0xa1bed0;
  CounterRandom random(boulder.noise_seed, kStream);
  double tone = albedo.spread * random.normal();
  if (random.uniform() < albedo.bright_share) tone += portable::log(albedo.bright);
  const auto gain = static_cast<float>(tone);
  return {true, encoded(light_of_albedo * albedo.normal * albedo.color), {gain, gain, gain}};
}

double find_stated_height(const Layer& layer) {
  return std::visit(
      []<class Kind>(const Kind& l) -> double {
        if constexpr (requires { l.stated_height(); }) {
          return l.stated_height().height;
        } else if constexpr (requires { l.amplitude; }) {
          return l.amplitude;
        } else {
          return l.height_rms;
        }
      },
      layer);
}

}  // namespace

double viewing_light(double normal_albedo) { return 0.36 * portable::pow(normal_albedo / 0.1, 1.0 / 3.0); }

std::optional<GroundAlbedo> stated_albedo(const Recipe& recipe) {
  if (recipe.albedo) return recipe.albedo;
  const bool in_layers = std::any_of(recipe.layers.begin(), recipe.layers.end(), has_albedo);
  return in_layers ? std::optional(GroundAlbedo{}) : std::nullopt;
}

bool has_colors(const Recipe& recipe) {
  return stated_albedo(recipe) || std::any_of(recipe.layers.begin(), recipe.layers.end(), paints);
}

SurfaceColors::SurfaceColors(const Recipe& recipe, const std::string& name, const ImplicitField& field)
    : field_(field), albedo_(stated_albedo(recipe)) {
  constexpr float kBare = static_cast<float>(kBareColor[0]) / 255.0f;
  const double scale = albedo_ ? viewing_light(albedo_->normal) / albedo_->normal : 0.0;
  bare_ = albedo_ ? encoded(scale * albedo_->normal * albedo_->color) : Vec3f{kBare, kBare, kBare};
  const std::span<const int> places = field.recipe_layers();
  for (std::uint32_t number = 0; number < places.size(); ++number) {
    const Layer& layer = recipe.layers[static_cast<std::size_t>(places[number])];
    if (paints(layer)) {
      const std::string place = name + ": layers[" + std::to_string(places[number]) + "]";
      paints_.images.push_back(make_paint(layer, place, textures_));
      paints_.images.back().layer = number;
    }
    const LayerUse* const use = find_use(layer);
    if (!albedo_ || use == nullptr || !use->albedo) continue;
    paints_.noises.push_back(make_tone(*use->albedo, find_stated_height(layer), scale));
    paints_.noises.back().layer = number;
  }
  for (LayerPaint& paint : paints_.images) paint.arrays = textures_.view();
  if (!albedo_) return;
  for (const LayerCraters& placed : field.craters()) {
    const auto& layer = std::get<CraterLayer>(recipe.layers[static_cast<std::size_t>(placed.layer)]);
    if (!layer.albedo) continue;
    paints_.craters.push_back(make_tone(layer, placed.craters));
    paints_.craters.back().layer =
        static_cast<std::uint32_t>(std::find(places.begin(), places.end(), placed.layer) - places.begin());
  }
  for (const LayerBoulders& placed : field.boulders()) {
    const auto& layer = std::get<BoulderLayer>(recipe.layers[static_cast<std::size_t>(placed.layer)]);
    for (const PlacedBoulder& boulder : placed.boulders)
      paints_.boulders.push_back(layer.albedo ? make_tone(*layer.albedo, boulder, scale) : BoulderTone{});
  }
}

SurfaceColors::~SurfaceColors() = default;

Vec3f SurfaceColors::light_at(const PaintedPoint& point, const Vec3f& normal) const {
  Vec3f tone = point.tone;
  const auto gain = [&](double factor, float share) {
    const float by = share * static_cast<float>(portable::log(factor));
    tone += Vec3f{by, by, by};
  };
  if (!point.on_boulder && albedo_->steep != 1.0 && squared_norm(normal) > 0.5f) {
    constexpr float kOf45Degrees = 0.29289322f;  // 1 - cos(45 degrees)
    gain(albedo_->steep, (1.0f - dot(normal, point.up)) / kOf45Degrees);
  }
  if (const auto& by = albedo_->elevation; by && !point.on_boulder) {
    const auto from = static_cast<float>(by->from);
    gain(by->factor, smooth_step(point.elevation, from, 1.0f / (static_cast<float>(by->to) - from)));
  }
  const auto exponential = [](double x) { return portable::exp(std::clamp(x, -20.0, 20.0)); };
  const Vec3f linear = each_channel(srgb_to_linear, point.color), by = each_channel(exponential, tone);
  return {linear.x * by.x, linear.y * by.y, linear.z * by.z};
}

template <class Use>
void SurfaceColors::for_each_point(const Vec3d& origin, std::span<const MeshVertex> vertices,
                                   const Use& use) const {
  const auto local = [&](std::size_t i) { return vertices[i].position; };
  for_each_chunk(field_, origin, vertices.size(), local, [&](const PointChunk& chunk) {
    std::array<PaintedPoint, PointChunk::kMost> points;
    points.fill({bare_, {}, {}});
    chunk.block.paint(paints_, chunk.origin, chunk.along(0), chunk.along(1), chunk.along(2),
                      {points.data(), chunk.count});
    for (std::size_t i = 0; i < chunk.count; ++i) use(chunk.first + i, points[i]);
  });
}

void SurfaceColors::find_albedo(const Vec3d& origin, std::span<const MeshVertex> vertices,
                                std::span<Vec3f> albedo) const {
  const auto scale = static_cast<float>(albedo_->normal / viewing_light(albedo_->normal));
  for_each_point(origin, vertices, [&](std::size_t i, const PaintedPoint& point) {
    albedo[i] = scale * light_at(point, vertices[i].normal);
  });
}

void SurfaceColors::paint(const Vec3d& origin, std::span<const MeshVertex> vertices,
                          std::span<VertexColor> colors) const {
  for_each_point(origin, vertices, [&](std::size_t i, const PaintedPoint& point) {
    colors[i] = color_bytes(albedo_ ? each_channel(linear_to_srgb, light_at(point, vertices[i].normal))
                                    : point.color);
  });
}

VertexColor SurfaceColors::for_viewing(const Vec3f& albedo) const {
  const auto scale = static_cast<float>(viewing_light(albedo_->normal) / albedo_->normal);
  return color_bytes(each_channel(linear_to_srgb, scale * albedo));
}

std::vector<VertexColor> SurfaceColors::evaluate_colors(const Vec3d& origin, const TriangleMesh& mesh) const {
  std::vector<MeshVertex> vertices(mesh.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].position = to_float(mesh.vertices[i]);
    if (!mesh.normals.empty()) vertices[i].normal = to_float(mesh.normals[i]);
  }
  std::vector<VertexColor> colors(vertices.size());
  paint(origin, vertices, colors);
  return colors;
}

}  // namespace astrolith
