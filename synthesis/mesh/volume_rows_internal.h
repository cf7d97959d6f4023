// Rows of a volume along x: their signs, the edges that the surface crosses, vertices and triangles.
#pragma once

#include <array>
#include <cstdint>

#include "geometry/mesh_sink.h"
#include "synthesis/mesh/sample_grid.h"

namespace astrolith {

// Bit i of word w: sample 64 w + i.
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

// Samples in whole words; those beyond the row are outside.
inline int words_of(int samples) { return (samples + 63) / 64; }

void take_signs(const float* values, int samples, SignWord* signs);

// From the signs of a row and of those one step lower along y and z. `first` of each word counts from 0;
// returns how many vertices the row has.
std::uint32_t take_edges(const SignWord* signs, const SignWord* lower_y, const SignWord* lower_z, int words,
                         EdgeWord* edges);

// At most so many triangles have the cells between four rows: (y - 1, z - 1), (y, z - 1), (y - 1, z), (y, z).
std::int64_t count_triangles_at_most(const std::array<VolumeRow, 4>& rows, int words);
// Makes them; returns how many.
std::int64_t make_triangles(const std::array<VolumeRow, 4>& rows, int words, Triangle* triangles);

// The vertices of row y, z, in the order of their numbers.
void make_vertices(const SampleGrid& grid, const float* values, const EdgeWord* edges, int y, int z,
                   MeshVertex* vertices);

}  // namespace astrolith
