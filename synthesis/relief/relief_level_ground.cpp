#include "synthesis/relief/relief_level_ground.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "synthesis/exemplar/exemplar_ground.h"
#include "synthesis/relief/relief_texture.h"

namespace astrolith {
namespace {

// An exemplar whose heights are those of the texture.
ExemplarLayer exemplar_of(const ReliefTexture& texture) {
  const auto [least, most] = std::minmax_element(texture.heights.begin(), texture.heights.end());
  ExemplarLayer layer;
  layer.pixel_size = texture.pixel;
  layer.height_range = *most - *least;
  layer.exponent = 8;  // narrow seams: stones stay whole
  layer.rotation = ExemplarRotation::kAny;
  auto image = std::make_shared<ExemplarImage>();
  image->width = image->height = texture.side;
  for (const double height : texture.heights) {
    const double share = layer.height_range > 0.0 ? (height - *least) / layer.height_range : 0.0;
    image->values.push_back(static_cast<std::uint16_t>(share * 65535.0 + 0.5));
  }
  layer.pixels = std::move(image);
  return layer;
}

std::vector<double> roughness_of(const ReliefPoints& points, const std::vector<double>& heights,
                                 double edge) {
  constexpr double kAround = 4.0;  // edges
  std::vector<double> squares = wide_heights(points, heights, edge);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const double narrow = heights[i] - squares[i];
    squares[i] = narrow * narrow;
  }
  squares = smoothed_heights(points, squares, kAround * edge);
  for (double& of_place : squares) of_place = std::sqrt(of_place);
  return squares;
}

}  // namespace

LevelGround level_ground(const ReliefPatches& patches, const ReliefPoints& points,
                         const std::vector<double>& heights, std::uint32_t hash) {
  const ReliefTexture texture = relief_texture(patches, hash);
  LevelGround ground{exemplar_of(texture), texture.exponent, {}, 0.0f};
  const std::vector<double> roughness = roughness_of(points, heights, patches.anchor_spacing().edge);
  const double most = roughness.empty() ? 0.0 : *std::max_element(roughness.begin(), roughness.end());
  ground.step = static_cast<float>(most / 65535.0);
  for (const double of_place : roughness) {
    const double code = ground.step > 0.0f ? of_place / double{ground.step} : 0.0;
    ground.codes.push_back(static_cast<std::uint16_t>(std::clamp(std::floor(code + 0.5), 0.0, 65535.0)));
  }
  return ground;
}

ReliefLevels place_levels(const LevelGround& ground, int count, const std::string& place, std::uint32_t hash,
                          const LayerSite& site, ArrayStore& arrays, NoiseDetail& detail) {
  ReliefLevels placed;
  if (!(ground.texture.height_range > 0.0) || !(ground.step > 0.0f)) return placed;
  const ExemplarNoise made = make_exemplar(ground.texture, place, arrays);
  ExemplarLayer layer = ground.texture;
  std::vector<ReliefLevel> levels;
  double total = 0.0, left_out = 0.0, gains = 0.0;
  for (int k = 1; k <= count; ++k) {
    layer.pixel_size *= 0.25;
    const double gain = portable::exp(-k * ground.exponent * portable::log(4.0));
    const ExemplarNoise noise = placed_exemplar(made, layer, hash_append(hash, static_cast<std::uint32_t>(k)),
                                                0, site, false, arrays);
    total += gain * gain;
    if (noise.lattice.anchors.count == 0) {
      left_out += gain * gain;
      continue;
    }
    gains += gain;
    levels.push_back({noise, static_cast<float>(gain)});
  }
  detail.finest = std::min(detail.finest, layer.pixel_size);
  detail.left_out = left_out / total;
  const double most = 65535.0 * double{ground.step} * gains * (1.0 + 1e-5);
  placed.levels = arrays.add(levels);
  placed.step = ground.step;
  placed.least = most * std::min(made.texture.least, 0.0);
  placed.greatest = most * std::max(made.texture.greatest, 0.0);
  return placed;
}

}  // namespace astrolith
