// Rows of samples along x: their signs, the edges that the surface crosses, and the vertices and triangles
// there.
#pragma once

#include <array>
#include <cstdint>

#include "geometry/mesh_sink.h"
#include "synthesis/mesh/sample_grid.h"

namespace astrolith {

// Bit i of word w is set where sample 64 w + i is inside.
using SignWord = std::uint64_t;

// The edges that end at 64 samples of a row.
struct EdgeWord {
  std::array<SignWord, 3> crossed;  // along x, y and z
  std::uint32_t first;              // number of the first vertex on them
};

struct VolumeRow {
  const SignWord* signs;
  const EdgeWord* edges;
};

// The number of words that hold the signs of a row. Bits beyond the row are 0, which means outside.
inline int words_of(int samples) { return (samples + 63) / 64; }

// Sets the signs of a row of samples.
void take_signs(const float* values, int samples, SignWord* signs);

// Finds the crossed edges of a row from its signs and from the signs of the rows one step lower along y and
// z. `first` of each word counts from the start of the row. Returns how many vertices the row has.
std::uint32_t take_edges(const SignWord* signs, const SignWord* lower_y, const SignWord* lower_z, int words,
                         EdgeWord* edges);

// A bound on the number of triangles in the cells between four rows: (y - 1, z - 1), (y, z - 1), (y - 1, z),
// (y, z).
std::int64_t count_triangles_at_most(const std::array<VolumeRow, 4>& rows, int words);
// Makes the triangles in these cells and returns how many there are.
std::int64_t make_triangles(const std::array<VolumeRow, 4>& rows, int words, Triangle* triangles);

// Makes the vertices of row y, z, in the order of their numbers.
void make_vertices(const SampleGrid& grid, const float* values, const EdgeWord* edges, int y, int z,
                   MeshVertex* vertices);

}  // namespace astrolith
