#include "synthesis/exemplar/phase_tile.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "numerics/hash_random.h"
#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"
#include "synthesis/exemplar/plane_waves.h"

namespace astrolith {
namespace {

// The highest frequency of a tile, in cycles per pixel of the tile. The spline adds images of its waves
// beyond 1 - 0.3 cycles per pixel, whose power is at most 0.6 % of theirs.
constexpr double kHighestFrequency = 0.3;

// The bandwidth a of a lobe's kernel, and the standard deviation of the lobe, in cycles per pixel.
double kernel_width(int bandwidth) {
  return std::ldexp(std::sqrt(std::numbers::pi / (2.0 * portable::log(2.0))), -bandwidth);
}
double deviation_of(int bandwidth) { return kernel_width(bandwidth) / (2.0 * std::sqrt(std::numbers::pi)); }

// A lobe and the pixels of a tile, in pixels of the layer, that suit it.
struct LobeOnTile {
  GaborLobe lobe;
  double finest;    // with the largest tile: finer pixels make the lobe narrow
  double coarsest;  // coarser pixels cannot hold its frequencies
};

double finest_pixel(const GaborLobe& lobe, int side) {
  return kLeastTileWidth / (kernel_width(lobe.bandwidth) * kPhaseTileSpacing * side);
}
double coarsest_pixel(const GaborLobe& lobe) {
  const double frequency = std::max(std::fabs(lobe.frequency_x), std::fabs(lobe.frequency_y));
  return kHighestFrequency / (frequency + 2.0 * deviation_of(lobe.bandwidth));
}

// A lobe of 1.5 times the least width is blurred little. Wider anchors than that, or than kPreferredSpacing,
// only make a tile less fit for small bodies.
constexpr double kPreferredWidth = 1.5 * kLeastTileWidth;
constexpr double kPreferredSpacing = 128.0;  // pixels of the layer

// The smallest tile that has the preferred spacing where its pixels are half as coarse as they may be.
PhaseTile tile_of(std::vector<GaborLobe> lobes) {
  double coarsest = coarsest_pixel(lobes.front());
  int narrowest = lobes.front().bandwidth;
  for (const GaborLobe& lobe : lobes) {
    coarsest = std::min(coarsest, coarsest_pixel(lobe));
    narrowest = std::max(narrowest, lobe.bandwidth);
  }
  const double preferred = std::max(kPreferredWidth / kernel_width(narrowest), kPreferredSpacing);
  const auto pixel_for = [&](double spacing, int side) { return spacing / (kPhaseTileSpacing * side); };
  PhaseTile tile;
  tile.side = kLeastPhaseTile;
  while (tile.side < kMostPhaseTile && pixel_for(preferred, tile.side) > 0.5 * coarsest) tile.side *= 2;
  const double least = finest_pixel({narrowest, 0, 0, 1}, tile.side);
  tile.pixel = std::max(least, std::min(pixel_for(preferred, tile.side), 0.5 * coarsest));
  tile.lobes = std::move(lobes);
  return tile;
}

// sin(pi t) / (pi t) to the third power: what the spline makes of a wave of t cycles per pixel.
double spline_response(double t) {
  if (t == 0.0) return 1.0;
  const double angle = std::numbers::pi * t, sinc = portable::sin(angle) / angle;
  return sinc * sinc * sinc;
}

// A frequency of a side, in cycles per side, as a signed number.
int signed_frequency(int k, int side) { return k < (side + 1) / 2 ? k : k - side; }

// A line of a tile's spectrum along one axis of one lobe: shares of the lobe's power at the frequencies
// 0, 1 .. side - 1 in cycles per side (the upper half is negative). `frequency` is in cycles per pixel of the
// layer. The shares sum to 1.
std::vector<double> tile_line(const PhaseTile& tile, int bandwidth, double frequency) {
  const double length = tile.side * tile.pixel, own = deviation_of(bandwidth),
               blur = kPhaseTileBlur / tile.spacing();
  const double deviation = length * std::sqrt(own * own - blur * blur), middle = length * frequency;
  std::vector<double> line(static_cast<std::size_t>(tile.side));
  double sum = 0.0;
  for (int k = 0; k < tile.side; ++k) {
    const double d = (signed_frequency(k, tile.side) - middle) / deviation;
    const double share = std::fabs(d) < 8.0 ? portable::exp(-0.5 * d * d) : 0.0;
    line[static_cast<std::size_t>(k)] = share;
    sum += share;
  }
  for (double& share : line) share /= sum;
  return line;
}

}  // namespace

double PhaseTile::variance() const {
  double sum = 0.0;
  for (const GaborLobe& lobe : lobes) sum += lobe.variance;
  return sum;
}

PhaseTilePlan plan_phase_tiles(const std::vector<GaborLobe>& lobes) {
  PhaseTilePlan plan;
  std::vector<LobeOnTile> wide;
  for (const GaborLobe& lobe : lobes) {
    if (!(lobe.variance > 0.0)) continue;
    const LobeOnTile on_tile{lobe, finest_pixel(lobe, kMostPhaseTile), coarsest_pixel(lobe)};
    if (on_tile.finest <= on_tile.coarsest) {
      wide.push_back(on_tile);
    } else {
      plan.narrow.push_back(lobe);
    }
  }
  std::stable_sort(wide.begin(), wide.end(),
                   [](const LobeOnTile& a, const LobeOnTile& b) { return a.coarsest < b.coarsest; });
  // The coarsest pixel of the first lobe left serves as many lobes as any pixel that serves this lobe.
  while (!wide.empty()) {
    const double pixel = wide.front().coarsest;
    std::vector<GaborLobe> together;
    std::vector<LobeOnTile> left;
    for (const LobeOnTile& l : wide) {
      if (l.finest <= pixel) {
        together.push_back(l.lobe);
      } else {
        left.push_back(l);
      }
    }
    plan.tiles.push_back(tile_of(std::move(together)));
    wide = std::move(left);
  }
  std::stable_sort(plan.tiles.begin(), plan.tiles.end(),
                   [](const PhaseTile& a, const PhaseTile& b) { return a.variance() > b.variance(); });
  while (plan.tiles.size() > kMostPhaseTiles) {
    const std::vector<GaborLobe>& last = plan.tiles.back().lobes;
    plan.narrow.insert(plan.narrow.end(), last.begin(), last.end());
    plan.tiles.pop_back();
  }
  return plan;
}

std::vector<double> tile_power(const PhaseTile& tile) {
  const auto side = static_cast<std::size_t>(tile.side);
  const double total = tile.variance();
  std::vector<double> power(side * side);
  for (const GaborLobe& lobe : tile.lobes) {
    for (const double sign : {1.0, -1.0}) {
      const std::vector<double> x = tile_line(tile, lobe.bandwidth, sign * lobe.frequency_x),
                                y = tile_line(tile, lobe.bandwidth, sign * lobe.frequency_y);
      const double half = 0.5 * lobe.variance / total;
      for (std::size_t row = 0; row < side; ++row) {
        if (y[row] == 0.0) continue;
        for (std::size_t column = 0; column < side; ++column) {
          power[row * side + column] += half * y[row] * x[column];
        }
      }
    }
  }
  const double quarter = 0.25 * power[0];
  for (const std::size_t i : {std::size_t{1}, side - 1, side, side * (side - 1)}) power[i] += quarter;
  power[0] = 0.0;
  return power;
}

std::vector<double> random_phase_tile(const PhaseTile& tile, std::uint32_t seed) {
  const auto side = static_cast<std::size_t>(tile.side);
  const std::vector<double> power = tile_power(tile);
  std::vector<double> response(side);
  for (int k = 0; k < tile.side; ++k) {
    response[static_cast<std::size_t>(k)] =
        spline_response(static_cast<double>(signed_frequency(k, tile.side)) / tile.side);
  }
  // A frequency of one half of the plane stands for its opposite too. The real part of its wave is a cosine
  // of twice its power. Frequencies at half a cycle per pixel are beyond those of the lobes.
  std::vector<std::complex<double>> waves(side * side);
  for (std::size_t row = 0; row < side / 2; ++row) {
    for (std::size_t column = 0; column < side; ++column) {
      const bool opposite = row == 0 && column >= side / 2;
      const double p = power[row * side + column];
      if (opposite || column == side / 2 || p == 0.0) continue;
      const double amplitude = 2.0 * std::sqrt(p) / (response[row] * response[column]);
      const std::uint32_t hash =
          hash_append(hash_append(seed, static_cast<std::uint32_t>(row)), static_cast<std::uint32_t>(column));
      const portable::SineCosine phase =
          portable::sine_and_cosine(2.0 * std::numbers::pi * static_cast<double>(unit_float(hash)));
      waves[row * side + column] = {amplitude * phase.cosine, amplitude * phase.sine};
    }
  }
  sum_plane_waves(tile.side, waves);
  std::vector<double> coefficients;
  coefficients.reserve(waves.size());
  for (const std::complex<double>& wave : waves) coefficients.push_back(wave.real());
  return coefficients;
}

}  // namespace astrolith
