#include "estimation/gabor/exemplar/tiled_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "synthesis/exemplar/exemplar_noise.h"
#include "synthesis/exemplar/phase_tile.h"

namespace astrolith {
namespace {

constexpr double kFarthestShared = 1.8;  // spacings; points farther apart share next to nothing
constexpr int kDistances = 72;           // intervals of the table of correlations

// The four anchors of a point, and their weights.
struct BlendedAnchors {
  float weight[4];
  Vec3d at[4];
};

BlendedAnchors blended_anchors(const ExemplarLattice& lattice, const Vec3d& p) {
  const Vec3f q = to_float(p);
  ExemplarPlace place = exemplar_place(lattice, q.x, q.y, q.z);
  sharpen_weights(kPhaseTileExponent, place.weight);
  const Vec3d first = p - Vec3d{double{place.x}, double{place.y}, double{place.z}};
  BlendedAnchors anchors{};
  for (int c = 0; c < 4; ++c) {
    const ExemplarCorner corner = exemplar_corner(c, place.order);
    anchors.weight[c] = place.weight[c];
    anchors.at[c] = first + 0.5 * Vec3d{1.0 * corner.x, 1.0 * corner.y, 1.0 * corner.z};
  }
  return anchors;
}

double shared_weights(const BlendedAnchors& a, const BlendedAnchors& b) {
  double shared = 0.0;
  for (int j = 0; j < 4; ++j) {
    for (int k = 0; k < 4; ++k) {
      if (norm(a.at[j] - b.at[k]) < 0.01) shared += double{a.weight[j]} * double{b.weight[k]};
    }
  }
  return shared;
}

// Between the values at i and beside it; 0 from the last value on.
double interpolated(std::span<const double> values, double i) {
  if (!(i < static_cast<double>(values.size() - 1))) return 0.0;
  const auto below = static_cast<std::size_t>(i);
  const double part = i - static_cast<double>(below);
  return (1.0 - part) * values[below] + part * values[below + 1];
}

// The Bessel function J0 by the mean of a cosine over half a turn.
double bessel_j0(double x) {
  constexpr int kSteps = 32;  // exact to 1e-9 for |x| below 35
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    sum += portable::cos(x * portable::sin(std::numbers::pi * (i + 0.5) / kSteps));
  }
  return sum / kSteps;
}

// The blur of spectra by the anchors, by the distance of frequencies: the Fourier transform of the
// correlation. Its integral over the plane is 1.
class AnchorBlur {
 public:
  static constexpr double kReach = 2.5;  // cycles per spacing

  explicit AnchorBlur(const AnchorCorrelation& correlation) {
    constexpr int kSteps = 180;
    constexpr double kStep = kFarthestShared / kSteps;
    for (int i = 0; i <= kValues; ++i) {
      const double q = kReach * i / kValues;
      double sum = 0.0;
      for (int s = 0; s < kSteps; ++s) {
        const double r = (s + 0.5) * kStep;
        sum += correlation.at(r) * bessel_j0(2.0 * std::numbers::pi * q * r) * r * kStep;
      }
      values_.push_back(std::max(0.0, 2.0 * std::numbers::pi * sum));
    }
  }
  // At q cycles per spacing from a line.
  double at(double q) const { return interpolated(values_, q * (kValues / kReach)); }

 private:
  static constexpr int kValues = 100;
  std::vector<double> values_;
};

// The power of the lines of a tile and of their images by interpolation. Frequencies are in cycles per side.
class TileLines {
 public:
  explicit TileLines(const PhaseTile& tile) : side_(tile.side), power_(tile_power(tile)) {
    for (int k = -side_; k < side_; ++k) images_.push_back(image(k));
    for (int l = 0; l < side_; ++l) {
      for (int k = 0; k < side_; ++k) {
        if (power_[static_cast<std::size_t>(l) * static_cast<std::size_t>(side_) +
                   static_cast<std::size_t>(k)] < kLeastPower) {
          continue;
        }
        highest_ = std::max({highest_, std::min(k, side_ - k), std::min(l, side_ - l)});
      }
    }
  }
  static constexpr double kLeastPower = 1e-14;  // weaker lines are left out

  // Whether lines may lie within `reach` of a frequency along one axis: at up to highest_, or as an image of
  // these.
  bool may_reach(double frequency, double reach) const {
    const double f = std::fabs(frequency);
    return f <= highest_ + reach || (f >= side_ - highest_ - reach && f <= side_ + reach);
  }
  double at(int k, int l) const {
    if (k < -side_ || k >= side_ || l < -side_ || l >= side_) return 0.0;
    const auto wrapped = [this](int i) { return static_cast<std::size_t>((i + side_) % side_); };
    return power_[wrapped(l) * static_cast<std::size_t>(side_) + wrapped(k)] *
           images_[static_cast<std::size_t>(k + side_)] * images_[static_cast<std::size_t>(l + side_)];
  }

 private:
  // The power at a frequency over that of the wave below half a cycle per pixel, of which it is an image. The
  // spline's response is the third power of sin(pi t) / (pi t), so that the ratio is that of 1 / t.
  double image(int k) const {
    const int base = k < -side_ / 2 ? k + side_ : k >= side_ / 2 ? k - side_ : k;
    if (base == k) return 1.0;
    const double ratio = static_cast<double>(base) / k;
    return portable::whole_power(ratio * ratio, 3);
  }

  int side_, highest_ = 0;
  std::vector<double> power_;
  std::vector<double> images_;
};

// Calls add(fx, fy) for a frequency and for those that a grid of whole pixels cannot tell from it.
template <class Add>
void for_each_alias(double fx, double fy, const Add& add) {
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) add(fx + x, fy + y);
  }
}

// The sum of density(fx, fy) over aliases, on a grid of frequencies. The density is even.
template <class Density>
void add_density(const Density& density, PowerSpectrum& spectrum) {
  const int w = spectrum.width, h = spectrum.height;
  parallel_for(0, h / 2 + 1, [&](std::int64_t row) {
    const int y = static_cast<int>(row), opposite_y = (h - y) % h;
    for (int x = 0; x < w; ++x) {
      const double fx = static_cast<double>(x <= w / 2 ? x : x - w) / w, fy = static_cast<double>(y) / h;
      double sum = 0.0;
      for_each_alias(fx, fy, [&](double ax, double ay) { sum += density(ax, ay); });
      spectrum.power[static_cast<std::size_t>(y * w + x)] += sum;
      if (opposite_y != y) spectrum.power[static_cast<std::size_t>(opposite_y * w + (w - x) % w)] += sum;
    }
  });
}

double lobe_density(const GaborLobe& lobe, double fx, double fy) {
  const double full_width = std::ldexp(1.0, -lobe.bandwidth);
  const double variance = full_width * full_width / (8.0 * portable::log(2.0));
  const auto gaussian = [&](double x, double y) {
    const double exponent = (x * x + y * y) / (2.0 * variance);
    return exponent < 40.0 ? portable::exp(-exponent) : 0.0;
  };
  return 0.5 * lobe.variance / (2.0 * std::numbers::pi * variance) *
         (gaussian(fx - lobe.frequency_x, fy - lobe.frequency_y) +
          gaussian(fx + lobe.frequency_x, fy + lobe.frequency_y));
}

void add_lobes(const std::vector<GaborLobe>& lobes, PowerSpectrum& spectrum) {
  add_density(
      [&](double fx, double fy) {
        double sum = 0.0;
        for (const GaborLobe& lobe : lobes) sum += lobe_density(lobe, fx, fy);
        return sum;
      },
      spectrum);
}

void add_tile(const PhaseTile& tile, const AnchorBlur& blur, PowerSpectrum& spectrum) {
  const TileLines lines(tile);
  const double length = tile.side * tile.pixel, spacing = tile.spacing();
  const double scale = tile.variance() * spacing * spacing;
  const double reach = AnchorBlur::kReach * length / spacing;  // cycles per side
  add_density(
      [&](double fx, double fy) {
        const double u = fx * length, v = fy * length;
        if (!lines.may_reach(u, reach) || !lines.may_reach(v, reach)) return 0.0;
        double sum = 0.0;
        for (int l = static_cast<int>(std::ceil(v - reach)); l <= v + reach; ++l) {
          for (int k = static_cast<int>(std::ceil(u - reach)); k <= u + reach; ++k) {
            const double power = lines.at(k, l);
            if (power < TileLines::kLeastPower) continue;
            sum += power * blur.at(spacing / length * std::sqrt((k - u) * (k - u) + (l - v) * (l - v)));
          }
        }
        return scale * sum;
      },
      spectrum);
}

PowerSpectrum empty_spectrum(int width, int height) {
  return {width, height,
          std::vector<double>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0)};
}

}  // namespace

AnchorCorrelation::AnchorCorrelation() : values_(kDistances + 1) {
  // Places within one cell by an additive sequence, and directions by another.
  constexpr int kPlaces = 4096;
  const ExemplarLattice lattice = exemplar_cells(Box{{-4, -4, -4}, {5, 5, 5}}, {1, 1, 1}).lattice;
  const double spacing = 1.0 / exemplar_edge(1.0);
  const auto part = [](double v) { return v - std::floor(v); };
  std::vector<double> sums(values_.size(), 0.0);
  parallel_for(0, kDistances + 1, [&](std::int64_t d) {
    const double distance = spacing * kFarthestShared * static_cast<double>(d) / kDistances;
    for (int i = 0; i < kPlaces; ++i) {
      // Steps of the additive sequence of five dimensions (Roberts 2018): powers of the root of x^6 = x + 1.
      const double n = i + 1.0;
      const Vec3d p{part(0.5 + n * 0.8812714616335696), part(0.5 + n * 0.7766393890897682),
                    part(0.5 + n * 0.6844301295853426)};
      const double z = 2.0 * part(0.5 + n * 0.6031687406857282) - 1.0,
                   turn = 2.0 * std::numbers::pi * part(0.5 + n * 0.5315553977157913),
                   ring = std::sqrt(std::max(0.0, 1.0 - z * z));
      const Vec3d direction{ring * portable::cos(turn), ring * portable::sin(turn), z};
      sums[static_cast<std::size_t>(d)] +=
          shared_weights(blended_anchors(lattice, p), blended_anchors(lattice, p + distance * direction));
    }
  });
  for (std::size_t d = 0; d < sums.size(); ++d) values_[d] = sums[d] / kPlaces;
}

double AnchorCorrelation::at(double distance) const {
  return interpolated(values_, distance * (kDistances / kFarthestShared));
}

PowerSpectrum lobe_spectrum(const std::vector<GaborLobe>& lobes, int width, int height) {
  PowerSpectrum spectrum = empty_spectrum(width, height);
  add_lobes(lobes, spectrum);
  return spectrum;
}

PowerSpectrum tiled_spectrum(const std::vector<GaborLobe>& lobes, int width, int height) {
  PowerSpectrum spectrum = empty_spectrum(width, height);
  const PhaseTilePlan plan = plan_phase_tiles(lobes);
  add_lobes(plan.narrow, spectrum);
  if (plan.tiles.empty()) return spectrum;
  const AnchorBlur blur{AnchorCorrelation()};
  for (const PhaseTile& tile : plan.tiles) add_tile(tile, blur, spectrum);
  return spectrum;
}

double tiles_distance(const std::vector<GaborLobe>& lobes, int width, int height) {
  return optimal_transport_distance(tiled_spectrum(lobes, width, height),
                                    lobe_spectrum(lobes, width, height));
}

}  // namespace astrolith
