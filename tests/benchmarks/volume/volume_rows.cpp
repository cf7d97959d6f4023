#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "numerics/scalar_math.h"
#include "synthesis/mesh/block_polygons.h"
#include "synthesis/mesh/marching_cubes_table.h"
#include "tests/benchmarks/volume/volume_rows_internal.h"

namespace astrolith {
namespace {

inline std::uint32_t count(SignWord bits) { return static_cast<std::uint32_t>(std::popcount(bits)); }

// The word shifted by one sample: bit i holds what bit i - 1 was. The carry passes a bit from word to word.
inline SignWord lower_neighbours(SignWord word, SignWord& carry) {
  const SignWord shifted = word << 1 | carry;
  carry = word >> 63;
  return shifted;
}

// The signs of four rows at the lower and at the upper corners of 64 cells.
struct CellWord {
  std::array<SignWord, 4> lower, upper;

  SignWord crossed() const {
    SignWord any = 0, all = ~SignWord{0};
    for (std::size_t r = 0; r < 4; ++r) {
      any |= lower[r] | upper[r];
      all &= lower[r] & upper[r];
    }
    return any & ~all;
  }
  unsigned signs_of_cell(int x) const {
    unsigned signs = 0;
    for (unsigned r = 0; r < 4; ++r) {
      signs |= static_cast<unsigned>((lower[r] >> x & 1) | (upper[r] >> x & 1) << 1) << (2 * r);
    }
    return signs;
  }
};

// Reads the words of four rows in ascending order.
class CellWords {
 public:
  explicit CellWords(const std::array<VolumeRow, 4>& rows) : rows_(rows) {}
  CellWord at(int w) {
    CellWord word;
    for (std::size_t r = 0; r < 4; ++r) {
      word.upper[r] = rows_[r].signs[w];
      word.lower[r] = lower_neighbours(word.upper[r], carry_[r]);
    }
    return word;
  }

 private:
  const std::array<VolumeRow, 4>& rows_;
  std::array<SignWord, 4> carry_{};
};

// The marching cubes table, in which each edge is replaced by its place in CellNumbers.
std::array<CellTriangles, 256> table_by_place() {
  std::array<CellTriangles, 256> table = marching_cubes_table();
  for (CellTriangles& cell : table) {
    for (std::uint8_t& edge : cell.edges) {
      const CellEdge e = cell_edge(edge);
      edge = static_cast<std::uint8_t>(3 * e.upper + e.axis);
    }
  }
  return table;
}

// The numbers of the vertices on the edges of a cell, by 3 * (corner where the edge ends) + axis. An edge
// without a vertex has any number.
struct CellNumbers {
  std::array<std::uint32_t, 24> at;

  // x is the upper corner of the cell in word w. The vertices at x - 1 are numbered just before those at x.
  CellNumbers(const std::array<VolumeRow, 4>& rows, int w, int x) {
    const SignWord below = (SignWord{1} << x) - 1;
    std::array<std::uint32_t, 4> here, along_x, along_y;
    for (std::size_t r = 0; r < 4; ++r) {
      const EdgeWord& e = rows[r].edges[w];
      here[r] =
          e.first + count(e.crossed[0] & below) + count(e.crossed[1] & below) + count(e.crossed[2] & below);
      along_x[r] = static_cast<std::uint32_t>(e.crossed[0] >> x & 1);
      along_y[r] = static_cast<std::uint32_t>(e.crossed[1] >> x & 1);
    }
    for (std::size_t r = 0; r < 4; ++r) at[3 * (2 * r + 1)] = here[r];
    at[3 * 2 + 1] = here[1] - 1 - along_z_before(rows[1].edges, w, x);
    at[3 * 3 + 1] = here[1] + along_x[1];
    at[3 * 4 + 2] = here[2] - 1;
    at[3 * 5 + 2] = here[2] + along_x[2] + along_y[2];
    at[3 * 6 + 1] = here[3] - 1 - along_z_before(rows[3].edges, w, x);
    at[3 * 7 + 1] = here[3] + along_x[3];
    at[3 * 6 + 2] = here[3] - 1;
    at[3 * 7 + 2] = here[3] + along_x[3] + along_y[3];
  }

 private:
  // 1 where the edge along z that ends at x - 1 is crossed.
  static std::uint32_t along_z_before(const EdgeWord* edges, int w, int x) {
    const SignWord bit = x > 0 ? edges[w].crossed[2] >> (x - 1) : w > 0 ? edges[w - 1].crossed[2] >> 63 : 0;
    return static_cast<std::uint32_t>(bit & 1);
  }
};

}  // namespace

ASTROLITH_SIMD_CLONES void take_signs(const float* __restrict values, int samples,
                                      SignWord* __restrict signs) {
  for (int first = 0; first < samples; first += 64) {
    std::array<std::uint8_t, 64> inside{};
    const int n = std::min(64, samples - first);
#pragma omp simd
    for (int i = 0; i < n; ++i) inside[static_cast<std::size_t>(i)] = values[first + i] > 0.0f ? 1 : 0;
    SignWord word = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      std::uint64_t eight;
      std::memcpy(&eight, inside.data() + 8 * k, 8);
      word |= (eight * 0x0102040810204080u >> 56) << (8 * k);  // packs the lowest bits of eight bytes
    }
    *signs++ = word;
  }
}

ASTROLITH_SIMD_CLONES std::uint32_t take_edges(const SignWord* signs, const SignWord* lower_y,
                                               const SignWord* lower_z, int words, EdgeWord* edges) {
  std::uint32_t vertices = 0;
  SignWord carry = 0;
  for (int w = 0; w < words; ++w) {
    const SignWord s = signs[w], x = s ^ lower_neighbours(s, carry), y = s ^ lower_y[w], z = s ^ lower_z[w];
    edges[w] = {{x, y, z}, vertices};
    if ((x | y | z) != 0) vertices += count(x) + count(y) + count(z);
  }
  return vertices;
}

ASTROLITH_SIMD_CLONES std::int64_t count_triangles_at_most(const std::array<VolumeRow, 4>& rows, int words) {
  CellWords cells(rows);
  std::int64_t crossed = 0;
  for (int w = 0; w < words; ++w) crossed += count(cells.at(w).crossed());
  return kMaxCellTriangles * crossed;
}

ASTROLITH_SIMD_CLONES std::int64_t make_triangles(const std::array<VolumeRow, 4>& rows, int words,
                                                  Triangle* triangles) {
  static const std::array<CellTriangles, 256> kTable = table_by_place();
  const Triangle* const first = triangles;
  CellWords cells(rows);
  for (int w = 0; w < words; ++w) {
    const CellWord word = cells.at(w);
    for (SignWord crossed = word.crossed(); crossed != 0; crossed &= crossed - 1) {
      const int x = std::countr_zero(crossed);
      const CellTriangles& cell = kTable[word.signs_of_cell(x)];
      const CellNumbers numbers(rows, w, x);
      for (unsigned t = 0; t < cell.count; ++t) {
        Triangle& triangle = *triangles++;
        for (unsigned k = 0; k < 3; ++k) triangle[k] = numbers.at[cell.edges[3 * t + k]];
      }
    }
  }
  return triangles - first;
}

namespace {

// Differences of the samples on both sides of a sample: twice the slope per step.
class VolumeSlopes {
 public:
  VolumeSlopes(const SampleGrid& grid, const float* values)
      : values_(values), last_(grid.cells), row_(last_[0] + 1), slice_(row_ * (last_[1] + 1)) {}

  const float* sample(int x, int y, int z) const { return values_ + z * slice_ + y * row_ + x; }
  // The differences at sample x, y, z; on the border they are one-sided.
  Vec3f at(int x, int y, int z) const {
    const float* here = sample(x, y, z);
    const auto along = [&](int c, int last, std::ptrdiff_t step) {
      return (c < last ? here[step] : *here) - (c > 0 ? here[-step] : *here);
    };
    return {along(x, last_[0], 1), along(y, last_[1], row_), along(z, last_[2], slice_)};
  }
  std::ptrdiff_t step(int axis) const { return axis == 0 ? 1 : axis == 1 ? row_ : slice_; }

 private:
  const float* values_;
  std::array<int, 3> last_;
  std::ptrdiff_t row_, slice_;
};

}  // namespace

void make_vertices(const SampleGrid& grid, const float* values, const EdgeWord* edges, int y, int z,
                   MeshVertex* vertices) {
  const VolumeSlopes slopes(grid, values);
  const auto place = [&](int x, int axis) {
    const float* to = slopes.sample(x, y, z);
    const float t = crossing_fraction(to[-slopes.step(axis)], *to);
    MeshVertex vertex = vertex_on_edge(grid, x, y, z, axis, t, *to > 0.0f);
    const Vec3f from_slope = slopes.at(x - (axis == 0), y - (axis == 1), z - (axis == 2));
    const Vec3f slope = from_slope + (slopes.at(x, y, z) - from_slope) * t;
    const float length = norm(slope);
    if (length > 0.0f && length <= std::numeric_limits<float>::max())
      vertex.normal = slope * (-1.0f / length);
    *vertices++ = vertex;
  };
  const int words = words_of(grid.cells[0] + 1);
  for (int w = 0; w < words; ++w) {
    const auto& [along_x, along_y, along_z] = edges[w].crossed;
    for (SignWord any = along_x | along_y | along_z; any != 0; any &= any - 1) {
      const int i = std::countr_zero(any), x = 64 * w + i;
      if ((along_x >> i & 1) != 0) place(x, 0);
      if ((along_y >> i & 1) != 0) place(x, 1);
      if ((along_z >> i & 1) != 0) place(x, 2);
    }
  }
}

}  // namespace astrolith
