// The steps in which a GPU meshes a batch of blocks, each over many threads. For one sample, row or vertex a
// step calls the function that LayeredMesher (synthesis/mesh/mesher.h) calls in its loops.
#pragma once

#include "cuda/backend.h"
#include "cuda/mesher/mesh_batch.h"
#include "synthesis/field/field_at_point.h"

namespace astrolith {

// A batch in a backend's memory.
struct MeshBatch {
  static constexpr std::size_t kRows = std::size_t{kBlockCells} * kBlockCells;

  MeshGrid grid;
  FieldView field;
  BlockListArrays lists;  // the elements of the field that reach each block
  const BlockPlace* places;
  MeshBlock* blocks;
  const MeshBlock* below;  // blocks of the last layer of the batch before
  const CellTriangles* cells;
  std::uint32_t* failure;  // a MeshFailure

  ASTROLITH_HD Owners<kBlockCells> owners(std::size_t block) const {
    Owners<kBlockCells> found;
    for (unsigned i = 0; i < 8; ++i) {
      const std::int32_t number = places[block].owner[i];
      found[i] = number == BlockPlace::kNone ? nullptr
                 : number >= 0               ? blocks + number
                                             : below + (-1 - number);
    }
    return found;
  }
  ASTROLITH_HD BlockWindow<kBlockCells> window(std::size_t block) const {
    return grid.block_window(places[block].x, places[block].y, places[block].z);
  }
  ASTROLITH_HD void fail(MeshFailure why) const { *failure = static_cast<std::uint32_t>(why); }
};

// The block and the local coordinates of the sample of a thread, or of the row of owned samples of a thread.
struct SampleThread {
  std::size_t block;
  int x, y, z;

  ASTROLITH_HD explicit SampleThread(std::size_t thread) : block(thread / MeshBlock::kSamples) {
    const int sample = static_cast<int>(thread % MeshBlock::kSamples);
    x = sample % MeshBlock::kSide;
    y = sample / MeshBlock::kSide % MeshBlock::kSide;
    z = sample / (MeshBlock::kSide * MeshBlock::kSide);
  }
};
// The block and the local coordinates of the sample of a thread, one for each sample of the halo: those whose
// z is 0, then those of the others whose y is 0, then those of the others whose x is 0.
struct HaloThread {
  static constexpr std::size_t kSide = MeshBlock::kSide, kCells = kBlockCells;
  static constexpr std::size_t kSamples = kSide * kSide + kSide * kCells + kCells * kCells;
  std::size_t block;
  int x, y, z;

  ASTROLITH_HD explicit HaloThread(std::size_t thread) : block(thread / kSamples) {
    std::size_t at = thread % kSamples;
    const bool below = at < kSide * kSide;
    at -= below ? 0 : kSide * kSide;
    const bool in_front = !below && at < kSide * kCells;
    at -= below || in_front ? 0 : kSide * kCells;
    const std::size_t row = at / (below || in_front ? kSide : kCells),
                      along = at % (below || in_front ? kSide : kCells);
    x = below || in_front ? static_cast<int>(along) : 0;
    y = below ? static_cast<int>(row) : in_front ? 0 : static_cast<int>(along) + 1;
    z = below ? 0 : static_cast<int>(row) + 1;
  }
};
struct RowThread {
  std::size_t block;
  int y, z;

  ASTROLITH_HD explicit RowThread(std::size_t thread)
      : block(thread / MeshBatch::kRows),
        y(static_cast<int>(thread % MeshBatch::kRows) % kBlockCells + 1),
        z(static_cast<int>(thread % MeshBatch::kRows) / kBlockCells + 1) {}
};

// Each thread starts one block and adds the number of samples that the block will evaluate.
struct StartBlocks {
  MeshBatch batch;
  std::uint64_t* evaluations;

  ASTROLITH_HD void operator()(std::size_t i) const {
    MeshBlock& block = batch.blocks[i];
    block.x = batch.places[i].x;
    block.y = batch.places[i].y;
    const Owners<kBlockCells> owners = batch.owners(i);
    std::uint64_t count = 0;
    for (int z = 0; z <= kBlockCells; ++z) {
      for (int y = 0; y <= kBlockCells; ++y) {
        const SampleRow row = row_to_evaluate(batch.grid, batch.places[i].z, owners, block, y, z);
        count += row.last >= row.first ? static_cast<std::uint64_t>(row.last - row.first + 1) : 0;
      }
    }
    add_atomically(evaluations, count);
  }
};

// Each thread copies one sample of the halo from the block that owns it.
struct FillSampleHalo {
  MeshBatch batch;

  ASTROLITH_HD void operator()(std::size_t thread) const {
    const HaloThread t(thread);
    fill_halo_sample(batch.owners(t.block), t.x, t.y, t.z, batch.blocks[t.block]);
  }
};

// Each thread finds the signs of one row of samples, the halo included.
struct TakeSigns {
  static constexpr std::size_t kRows = std::size_t{MeshBlock::kSide} * MeshBlock::kSide;
  MeshBatch batch;

  ASTROLITH_HD void operator()(std::size_t thread) const {
    MeshBlock& block = batch.blocks[thread / kRows];
    block.signs[thread % kRows] = row_signs(block, thread % kRows);
  }
};

// Each thread checks one of the six sides of a block: the surface must not cross a side that no active block
// lies beyond. `lacking`, unless null, replaces BlockPlace::lacking.
struct CheckSides {
  MeshBatch batch;
  const MeshBlock* blocks;
  const std::uint32_t* lacking;
  int layer_z;  // layer of the blocks; read only if `lacking` is not null

  ASTROLITH_HD void operator()(std::size_t thread) const {
    const std::size_t i = thread / 6;
    const int side = static_cast<int>(thread % 6);
    const std::uint32_t sides = lacking != nullptr ? lacking[i] : batch.places[i].lacking;
    if ((sides >> side & 1u) == 0) return;
    const int z = lacking != nullptr ? layer_z : batch.places[i].z;
    if (is_side_crossed(blocks[i], side, last_samples(batch.grid, blocks[i], z))) {
      batch.fail(MeshFailure::kOpenSide);
    }
  }
};

// Each thread counts the vertices and triangles of one row of owned samples.
struct CountRows {
  MeshBatch batch;
  std::uint32_t *vertices, *triangles;  // (rows of the batch)
  std::uint64_t* cut_vertices;

  ASTROLITH_HD void operator()(std::size_t thread) const {
    const RowThread t(thread);
    const RowCounts counts = count_row(batch.cells, batch.window(t.block), batch.blocks[t.block], t.y, t.z);
    const std::uint32_t row = batch.places[t.block].row(static_cast<std::uint32_t>(t.block), t.y, t.z);
    vertices[row] = counts.vertices;
    triangles[row] = counts.triangles;
    if (counts.cut_vertices != 0) add_atomically(cut_vertices, std::uint64_t{counts.cut_vertices});
  }
};

// Each thread places the vertices of one row of owned samples.
struct PlaceVertices {
  MeshBatch batch;
  const std::uint32_t* first;  // number of the first vertex of each row of the batch
  std::uint32_t first_number;  // number of the batch's first vertex in the mesh
  MeshVertex* vertices;

  ASTROLITH_HD void operator()(std::size_t thread) const {
    const RowThread t(thread);
    MeshBlock& block = batch.blocks[t.block];
    const BlockPlace& place = batch.places[t.block];
    std::uint32_t next = first[place.row(static_cast<std::uint32_t>(t.block), t.y, t.z)];
    for_each_meshed_row_edge(block, batch.window(t.block), t.y, t.z, [&](int x, int y, int z, int axis) {
      block.vertices[3 * MeshBlock::sample(x, y, z) + static_cast<unsigned>(axis)] = first_number + next;
      vertices[next++] = place_vertex(batch.grid, place.z, block, x, y, z, axis);
    });
  }
};

// Each thread copies the vertex numbers at one sample of the halo from the block that owns it.
struct FillVertexHalo {
  MeshBatch batch;

  ASTROLITH_HD void operator()(std::size_t thread) const {
    const HaloThread t(thread);
    const bool found = fill_halo_vertices(batch.owners(t.block), batch.window(t.block), t.x, t.y, t.z,
                                          batch.blocks[t.block]);
    if (!found) batch.fail(MeshFailure::kMissingBlock);
  }
};

// Each thread makes the triangles of one row of owned samples.
struct MakeTriangles {
  MeshBatch batch;
  const std::uint32_t* first;  // number of the first triangle of each row of the batch
  Triangle* triangles;
  std::array<std::ptrdiff_t, 12> offsets = edge_offsets<kBlockCells>();

  ASTROLITH_HD void operator()(std::size_t thread) const {
    const RowThread t(thread);
    const std::uint32_t row = batch.places[t.block].row(static_cast<std::uint32_t>(t.block), t.y, t.z);
    make_row_triangles(batch.cells, offsets, batch.blocks[t.block], batch.window(t.block), t.y, t.z,
                       triangles + first[row]);
  }
};

// Each thread finds the first vertex and triangle of one layer. `vertices` and `triangles` are running sums
// over the rows of the batch, `rows` holds the first row of each layer.
struct PickStarts {
  const std::uint32_t *vertices, *triangles, *rows;
  std::uint32_t *first_vertex, *first_triangle;

  ASTROLITH_HD void operator()(std::size_t i) const {
    first_vertex[i] = vertices[rows[i]];
    first_triangle[i] = triangles[rows[i]];
  }
};

}  // namespace astrolith
