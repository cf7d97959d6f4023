#include "estimation/shape/relief/relief_blend.h"

#include <cmath>
#include <limits>

#include "numerics/host_device.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::int64_t kGrain = 2048;

// The weights of the four places next to a point along an axis, which lies t in [0, 1] beyond the second.
ASTROLITH_KERNEL void spline_weights(float t, float* w) {
  const float s = 1.0f - t;
  w[0] = s * s * s * (1.0f / 6.0f);
  w[1] = 2.0f / 3.0f + t * t * (0.5f * t - 1.0f);
  w[2] = 2.0f / 3.0f + s * s * (0.5f * s - 1.0f);
  w[3] = t * t * t * (1.0f / 6.0f);
}

// The weights of a point along all axes, and the corner of its square.
struct PointWeights {
  int corner[3];
  float along[3][4];
};
ASTROLITH_KERNEL void find_weights(const std::array<float, 3>& at, PointWeights& p) {
  for (std::size_t a = 0; a < 3; ++a) {
    p.corner[a] = std::min(static_cast<int>(at[a]), kReliefCell - 1);
    spline_weights(at[a] - static_cast<float>(p.corner[a]), p.along[a]);
  }
}

// The sixteen values around a point in the tile of an axis.
struct Square {
  float of[4][4];
};
ASTROLITH_KERNEL std::int64_t square_corner(const PointWeights& p, int axis, std::int32_t tile) {
  return std::int64_t{kReliefTileSize} * tile + p.corner[(axis + 2) % 3] * kReliefTileSide +
         p.corner[(axis + 1) % 3];
}
ASTROLITH_KERNEL void load(const float* values, Square& square) {
  for (int j = 0; j < 4; ++j) {
#pragma omp simd
    for (int i = 0; i < 4; ++i) square.of[j][i] = values[j * kReliefTileSide + i];
  }
}
ASTROLITH_KERNEL void add_to(const Square& square, float* sums) {
  for (int j = 0; j < 4; ++j) {
#pragma omp simd
    for (int i = 0; i < 4; ++i) sums[j * kReliefTileSide + i] += square.of[j][i];
  }
}
ASTROLITH_KERNEL float weighted_sum(const Square& square, const float* u, const float* v) {
  float row[4] = {0.0f, 0.0f, 0.0f, 0.0f};
  for (int j = 0; j < 4; ++j) {
#pragma omp simd
    for (int i = 0; i < 4; ++i) row[i] += v[j] * square.of[j][i];
  }
  return (u[0] * row[0] + u[1] * row[1]) + (u[2] * row[2] + u[3] * row[3]);
}
ASTROLITH_KERNEL void add_weighted(float amount, const float* u, const float* v, Square& square) {
  float row[4];
#pragma omp simd
  for (int i = 0; i < 4; ++i) row[i] = amount * u[i];
  for (int j = 0; j < 4; ++j) {
#pragma omp simd
    for (int i = 0; i < 4; ++i) square.of[j][i] += v[j] * row[i];
  }
}
ASTROLITH_KERNEL void add_squares(float amount, const float* u, const float* v, Square& square) {
  const float u2[4] = {u[0] * u[0], u[1] * u[1], u[2] * u[2], u[3] * u[3]},
              v2[4] = {v[0] * v[0], v[1] * v[1], v[2] * v[2], v[3] * v[3]};
  add_weighted(amount, u2, v2, square);
}

ASTROLITH_KERNEL float term(SampleSum of, const ReliefSample& s, float blend) {
  switch (of) {
    case SampleSum::kOne:
    case SampleSum::kShare:
      return 1.0f;
    case SampleSum::kHeight:
      return s.height;
    case SampleSum::kBlend:
      return blend;
    case SampleSum::kError:
      break;
  }
  return s.height - blend;
}

// Adds the samples of a run to the sums of their tiles, all but the weights of the places. `values` are the
// weights times the heights. Returns the sum of |height - blend|.
ASTROLITH_SIMD_CLONES double read_run(SampleSum of, const SampleRun& run, const ReliefSample* samples,
                                      const float* values, float* sums) {
  int axes[3], count = 0;
  for (int a = 0; a < 3; ++a) {
    if (run.tiles[static_cast<std::size_t>(a)] != 0) axes[count++] = a;
  }
  double errors = 0.0;
  for (std::uint32_t i = run.first; i < run.end;) {
    const int square = square_index(samples[i].at);
    PointWeights p;
    find_weights(samples[i].at, p);
    std::int64_t corner[3];
    Square in[3], out[3];
    for (int n = 0; n < count; ++n) {
      corner[n] = square_corner(p, axes[n], run.tiles[static_cast<std::size_t>(axes[n])]);
      load(values + corner[n], in[n]);
      out[n] = {};
    }
    for (; i < run.end && square_index(samples[i].at) == square; ++i) {
      const ReliefSample& s = samples[i];
      find_weights(s.at, p);
      float blend = 0.0f;
      for (int n = 0; n < count; ++n)
        blend += weighted_sum(in[n], p.along[(axes[n] + 1) % 3], p.along[(axes[n] + 2) % 3]);
      blend *= s.scale;
      errors += std::fabs(double{s.height} - double{blend});
      const float amount = s.scale * term(of, s, blend);
      for (int n = 0; n < count; ++n) {
        const float *u = p.along[(axes[n] + 1) % 3], *v = p.along[(axes[n] + 2) % 3];
        if (of == SampleSum::kShare) {
          add_squares(s.scale * amount, u, v, out[n]);
        } else {
          add_weighted(amount, u, v, out[n]);
        }
      }
    }
    for (int n = 0; n < count; ++n) add_to(out[n], sums + corner[n]);
  }
  return errors;
}

constexpr HeightRange kNoHeights{std::numeric_limits<float>::infinity(),
                                 -std::numeric_limits<float>::infinity()};
void extend(HeightRange& range, const HeightRange& by) {
  range = {std::min(range.least, by.least), std::max(range.greatest, by.greatest)};
}

// Extends the ranges of the slots of tiles by the samples of a run, which are sorted by their squares.
void extend_ranges(const SampleRun& run, const std::vector<ReliefSample>& samples,
                   std::vector<HeightRange>& slot_ranges) {
  for (std::uint32_t i = run.first; i < run.end;) {
    PointWeights p;
    find_weights(samples[i].at, p);
    const int square = square_index(samples[i].at);
    HeightRange square_range = kNoHeights;
    for (; i < run.end && square_index(samples[i].at) == square; ++i)
      extend(square_range, {samples[i].height, samples[i].height});
    for (int a = 0; a < 3; ++a) {
      const std::int32_t tile = run.tiles[static_cast<std::size_t>(a)];
      if (tile == 0) continue;
      const auto corner = static_cast<std::size_t>(square_corner(p, a, tile));
      for (std::size_t j = 0; j < 4; ++j) {
        for (std::size_t k = 0; k < 4; ++k)
          extend(slot_ranges[corner + j * kReliefTileSide + k], square_range);
      }
    }
  }
}

}  // namespace

float weight_around(const float* weights, const std::array<std::int32_t, 3>& tiles,
                    const std::array<float, 3>& at) {
  PointWeights p;
  find_weights(at, p);
  float total = 0.0f;
  for (int a = 0; a < 3; ++a) {
    const std::int32_t tile = tiles[static_cast<std::size_t>(a)];
    if (tile == 0) continue;
    Square square;
    load(weights + square_corner(p, a, tile), square);
    total += weighted_sum(square, p.along[(a + 1) % 3], p.along[(a + 2) % 3]);
  }
  return total;
}

ReliefBlend::ReliefBlend(const ReliefSamples& samples)
    : samples_(samples), first_(samples.places.size() + 1, 0) {
  const std::vector<std::uint32_t>& places = samples.tiles.places;
  for (const std::uint32_t place : places) {
    if (place != kNoPlace) ++first_[place + 1];
  }
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) first_[i + 1] += first_[i];
  slots_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t slot = 0; slot < places.size(); ++slot) {
    if (places[slot] != kNoPlace) slots_[next[places[slot]]++] = static_cast<std::uint32_t>(slot);
  }
}

// Returns the sum of |height - blend| of each cell.
std::vector<double> ReliefBlend::read_cells(SampleSum of, const std::vector<double>& heights,
                                            std::vector<float>& sums) const {
  const std::vector<std::uint32_t>& places = samples_.tiles.places;
  std::vector<float> values(places.size(), 0.0f);
  parallel_for(
      0, heights.empty() ? 0 : static_cast<std::int64_t>(values.size()),
      [&](std::int64_t number) {
        const auto i = static_cast<std::size_t>(number);
        values[i] =
            places[i] == kNoPlace ? 0.0f : samples_.weights[i] * static_cast<float>(heights[places[i]]);
      },
      kGrain);
  sums.assign(places.size(), 0.0f);
  std::vector<double> errors(samples_.cells(), 0.0);
  parallel_for(
      0, static_cast<std::int64_t>(errors.size()),
      [&](std::int64_t number) {
        const auto cell = static_cast<std::size_t>(number);
        for (std::uint32_t r = samples_.cell_first_run[cell]; r < samples_.cell_first_run[cell + 1]; ++r)
          errors[cell] += read_run(of, samples_.runs[r], samples_.samples.data(), values.data(), sums.data());
      },
      16);
  return errors;
}

std::vector<double> ReliefBlend::sums(SampleSum of, const std::vector<double>& heights) const {
  std::vector<float> tile_heights;
  read_cells(of, heights, tile_heights);
  std::vector<double> sums(samples_.places.size());
  parallel_for(
      0, static_cast<std::int64_t>(sums.size()),
      [&](std::int64_t number) {
        const auto i = static_cast<std::size_t>(number);
        double sum = 0.0;
        for (std::uint32_t k = first_[i]; k < first_[i + 1]; ++k) sum += double{tile_heights[slots_[k]]};
        const double weight = samples_.places[i].weight;
        sums[i] = (of == SampleSum::kShare ? weight * weight : weight) * sum;
      },
      kGrain);
  return sums;
}

std::vector<HeightRange> ReliefBlend::ranges() const {
  std::vector<HeightRange> slot_ranges(samples_.tiles.places.size(), kNoHeights);
  parallel_for(
      0, static_cast<std::int64_t>(samples_.cells()),
      [&](std::int64_t number) {
        const auto cell = static_cast<std::size_t>(number);
        for (std::uint32_t r = samples_.cell_first_run[cell]; r < samples_.cell_first_run[cell + 1]; ++r)
          extend_ranges(samples_.runs[r], samples_.samples, slot_ranges);
      },
      16);
  std::vector<HeightRange> ranges(samples_.places.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    HeightRange range = kNoHeights;
    for (std::uint32_t k = first_[i]; k < first_[i + 1]; ++k) extend(range, slot_ranges[slots_[k]]);
    ranges[i] = range.least <= range.greatest ? range : HeightRange{0.0f, 0.0f};
  }
  return ranges;
}

double ReliefBlend::mean_residual(const std::vector<double>& heights) const {
  std::vector<float> unused;
  double sum = 0.0;
  for (const double cell_error : read_cells(SampleSum::kError, heights, unused)) sum += cell_error;
  return sum / static_cast<double>(samples_.samples.size());
}

}  // namespace astrolith
