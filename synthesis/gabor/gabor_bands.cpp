#include "synthesis/gabor/gabor_bands.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "numerics/hash_random.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

double kernel_bandwidth(int bandwidth) {
  return std::ldexp(std::sqrt(3.14159265358979324 / (2.0 * portable::log(2.0))), -bandwidth);
}

GaborBand make_band(int bandwidth, const std::vector<GaborLobe>& lobes, double total_variance) {
  GaborBand band;
  band.bandwidth = bandwidth;
  band.a = kernel_bandwidth(bandwidth);
  double variance = 0.0;
  for (const GaborLobe& lobe : lobes) variance += lobe.variance;
  double sum = 0.0;
  for (const GaborLobe& lobe : lobes) {
    sum += lobe.variance;
    band.lobes.push_back({static_cast<float>(sum / variance), static_cast<float>(lobe.frequency_x / band.a),
                          static_cast<float>(lobe.frequency_y / band.a)});
  }
  band.lobes.back().cumulative = 1.0f;
  band.variance_share = variance / total_variance;
  return band;
}

}  // namespace

const GaborBand::Lobe& GaborBand::draw(float uniform) const {
  return drawn_lobe(lobes.data(), static_cast<std::uint32_t>(lobes.size()), uniform);
}

std::vector<GaborBand> gabor_bands(const GaborLayer& layer) {
  std::map<int, std::vector<GaborLobe>> by_bandwidth;
  double total_variance = 0.0;
  for (const GaborLobe& lobe : layer.lobes) {
    if (!(lobe.variance > 0.0)) continue;
    by_bandwidth[lobe.bandwidth].push_back(lobe);
    total_variance += lobe.variance;
  }
  std::vector<GaborBand> bands;
  for (const auto& [bandwidth, lobes] : by_bandwidth) {
    bands.push_back(make_band(bandwidth, lobes, total_variance));
  }
  return bands;
}

std::uint32_t gabor_band_seed(std::uint64_t seed, int layer_index, int bandwidth) {
  return hash_append(hash_seed(seed, static_cast<std::uint32_t>(layer_index)),
                     static_cast<std::uint32_t>(bandwidth));
}

}  // namespace astrolith
