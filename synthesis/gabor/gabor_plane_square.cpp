// The kernel is separable on a grid of pixels: with A = 2 pi f_x dx + phase and B = 2 pi f_y dy,
//
//   e(dx) e(dy) cos(A + B) = [e(dx) cos A] [e(dy) cos B] - [e(dx) sin A] [e(dy) sin B].
//
// An impulse therefore costs a few profile values for each column and row of a square, and two fma for each
// pixel. The positions of many impulses are drawn at once, one in each lane of a vector. The profiles of a
// kernel fill whole vectors: as many lanes for its columns as for its rows.
#include "synthesis/gabor/gabor_plane_square.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "numerics/hash_random.h"
#include "synthesis/gabor/gabor_kernel.h"

namespace astrolith {
namespace {

// The impulses that are drawn at once.
constexpr std::size_t kDrawnAtOnce = 256;

// Impulses by the hash of their cell, the cell and their number in the cell; and what follows from these.
struct PlaneImpulses {
  std::size_t count = 0;
  std::array<std::uint32_t, kDrawnAtOnce> cell_hash, number;
  std::array<int, kDrawnAtOnce> cell_x, cell_y;

  std::array<float, kDrawnAtOnce> offset_x, offset_y;  // of the centre of the square's first pixel, pixels
  std::array<int, kDrawnAtOnce> begin_x, end_x, begin_y, end_y;  // the pixels that the kernel reaches
  std::array<float, kDrawnAtOnce> phase, lobe;                   // uniform in [0, 1)
};

// A uniform number in [0, 1) as unit_float() gives it.
ASTROLITH_KERNEL float unit_of(std::uint32_t hash) {
  return static_cast<float>(static_cast<std::int32_t>(hash >> 8)) * 0x1p-24f;
}

// Places the impulses along one axis: the pixels of the square, counted from `first`, whose centres the
// kernels reach.
ASTROLITH_SIMD_CLONES void place_along(std::size_t n, std::uint32_t axis, double side, double reach,
                                       int first, const std::uint32_t* __restrict cell_hash,
                                       const std::uint32_t* __restrict number, const int* __restrict cell,
                                       float* __restrict offset, int* __restrict begin, int* __restrict end) {
  const double center = first + 0.5, last = kTextureSquare;
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t hash = hash_append(cell_hash[i], number[i]);
    const double at = (cell[i] + static_cast<double>(unit_of(hash_append(hash, axis)))) * side;
    const double low = __builtin_ceil(at - 0.5 - first - reach);
    const double high = __builtin_floor(at - 0.5 - first + reach) + 1.0;
    offset[i] = static_cast<float>(center - at);
    begin[i] = static_cast<int>(low < 0.0 ? 0.0 : low > last ? last : low);
    end[i] = static_cast<int>(high < 0.0 ? 0.0 : high > last ? last : high);
  }
}

ASTROLITH_SIMD_CLONES void draw_lobes(std::size_t n, const std::uint32_t* __restrict cell_hash,
                                      const std::uint32_t* __restrict number, float* __restrict phase,
                                      float* __restrict lobe) {
#pragma omp simd
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t hash = hash_append(cell_hash[i], number[i]);
    phase[i] = unit_of(hash_append(hash, 2));
    lobe[i] = unit_of(hash_append(hash, 3));
  }
}

// One impulse on a square.
struct PlaneImpulse {
  float a, amplitude;
  float offset_x, offset_y, frequency_x, frequency_y, phase;
  int begin_x, end_x, begin_y, end_y;
};

// Adds a kernel that reaches at most kWidth columns and rows: the real part of the product of the column and
// row profiles. The profile is exactly 0 beyond its reach, so that the lanes around the kernel add nothing.
// Wide kernels go in blocks of sixteen lanes, without the blocks that the kernel does not reach.
template <int kWidth>
ASTROLITH_KERNEL void add_kernel(const PlaneImpulse& k, float* __restrict height) {
  constexpr int kBlock = std::min(kWidth, 16), kProfileBlock = std::min(2 * kWidth, 16);
  const int first_x = k.begin_x < kTextureSquare - kWidth ? k.begin_x : kTextureSquare - kWidth;
  const int first_y = k.begin_y < kTextureSquare - kWidth ? k.begin_y : kTextureSquare - kWidth;
  const int begin_x = k.begin_x - first_x, end_x = k.end_x - first_x;
  const int begin_y = kWidth + k.begin_y - first_y, end_y = kWidth + k.end_y - first_y;
  std::array<float, std::size_t{2 * kWidth}> cosine, sine;
  for (int block = 0; block < 2 * kWidth; block += kProfileBlock) {
    const bool of_columns = block < end_x && begin_x < block + kProfileBlock;
    if (!of_columns && !(block < end_y && begin_y < block + kProfileBlock)) continue;
#pragma omp simd
    for (int i = block; i < block + kProfileBlock; ++i) {
      const bool is_column = i < kWidth;
      const int pixel = i + (is_column ? first_x : first_y - kWidth);
      const float u = k.a * (static_cast<float>(pixel) + (is_column ? k.offset_x : k.offset_y));
      const float envelope = (is_column ? 1.0f : k.amplitude) * gabor_profile(u);
      const float turns = math::fma(is_column ? k.frequency_x : k.frequency_y, u, is_column ? k.phase : 0.0f);
      cosine[static_cast<std::size_t>(i)] = envelope * math::cos_turns(turns);
      sine[static_cast<std::size_t>(i)] = envelope * math::sin_turns(turns);
    }
  }
  const int first_block = begin_x / kBlock * kBlock;
  for (int y = begin_y; y < end_y; ++y) {
    const float c = cosine[static_cast<std::size_t>(y)], s = -sine[static_cast<std::size_t>(y)];
    float* row = height + (first_y + y - kWidth) * kTextureSquare + first_x;
    for (int block = first_block; block < end_x; block += kBlock) {
#pragma omp simd
      for (int x = block; x < block + kBlock; ++x) {
        const auto column = static_cast<std::size_t>(x);
        row[x] = math::fma(s, sine[column], math::fma(c, cosine[column], row[x]));
      }
    }
  }
}

// Adds the kernels of impulses that reach the square.
ASTROLITH_SIMD_CLONES void add_kernels(const PlaneImpulse* impulses, std::size_t n,
                                       float* __restrict height) {
  for (std::size_t i = 0; i < n; ++i) {
    const PlaneImpulse& k = impulses[i];
    const int width = k.end_x - k.begin_x, rows = k.end_y - k.begin_y, most = width > rows ? width : rows;
    if (most <= 4) {
      add_kernel<4>(k, height);
    } else if (most <= 8) {
      add_kernel<8>(k, height);
    } else if (most <= 16) {
      add_kernel<16>(k, height);
    } else if (most <= 32) {
      add_kernel<32>(k, height);
    } else {
      add_kernel<64>(k, height);
    }
  }
}

void add_impulses(const PlaneBand& band, PlaneImpulses& drawn, TextureSquare& square) {
  PlaneImpulses& d = drawn;
  const std::size_t n = d.count;
  place_along(n, 0, band.cell_x, band.reach, square.x, d.cell_hash.data(), d.number.data(), d.cell_x.data(),
              d.offset_x.data(), d.begin_x.data(), d.end_x.data());
  place_along(n, 1, band.cell_y, band.reach, square.y, d.cell_hash.data(), d.number.data(), d.cell_y.data(),
              d.offset_y.data(), d.begin_y.data(), d.end_y.data());
  draw_lobes(n, d.cell_hash.data(), d.number.data(), d.phase.data(), d.lobe.data());
  std::array<PlaneImpulse, kDrawnAtOnce> reaching;
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (d.begin_x[i] >= d.end_x[i] || d.begin_y[i] >= d.end_y[i]) continue;
    const GaborBand::Lobe& lobe = band.band.draw(d.lobe[i]);
    reaching[count++] = {static_cast<float>(band.band.a),
                         band.amplitude,
                         d.offset_x[i],
                         d.offset_y[i],
                         lobe.frequency_x,
                         lobe.frequency_y,
                         d.phase[i],
                         d.begin_x[i],
                         d.end_x[i],
                         d.begin_y[i],
                         d.end_y[i]};
  }
  add_kernels(reaching.data(), count, square.height.data());
  d.count = 0;
}

int wrapped(int cell, int wrap) { return wrap == 0 ? cell : ((cell % wrap) + wrap) % wrap; }

}  // namespace

void add_band(const PlaneBand& band, TextureSquare& square) {
  const auto cell_of = [](double pixel, double side) { return static_cast<int>(std::floor(pixel / side)); };
  const int last_x = cell_of(square.x + kTextureSquare + band.reach, band.cell_x);
  const int last_y = cell_of(square.y + kTextureSquare + band.reach, band.cell_y);
  PlaneImpulses drawn;
  for (int cy = cell_of(square.y - band.reach, band.cell_y); cy <= last_y; ++cy) {
    for (int cx = cell_of(square.x - band.reach, band.cell_x); cx <= last_x; ++cx) {
      const std::uint32_t cell = hash_cell(band.seed, wrapped(cx, band.wrap_x), wrapped(cy, band.wrap_y), 0);
      for (int j = 0; j < band.impulses_per_cell; ++j) {
        const std::size_t i = drawn.count++;
        drawn.cell_hash[i] = cell;
        drawn.number[i] = static_cast<std::uint32_t>(j);
        drawn.cell_x[i] = cx;
        drawn.cell_y[i] = cy;
        if (drawn.count == kDrawnAtOnce) add_impulses(band, drawn, square);
      }
    }
  }
  add_impulses(band, drawn, square);
}

}  // namespace astrolith
