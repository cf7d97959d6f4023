// The two steps of meshing a batch that evaluate the field. Each block has a group of threads, which read the
// block's lists from the memory that the group shares.
#pragma once

#include "cuda/mesher/block_stage.h"
#include "cuda/mesher/mesh_steps.h"

namespace astrolith {

// Each group of threads evaluates the samples of one block.
struct EvaluateSamples {
  static constexpr unsigned kThreads = 256;
  static constexpr std::size_t kGroupBytes = BlockStage::kBytes;
  MeshBatch batch;
  float band;

  template <class Group>
  ASTROLITH_HD void operator()(const Group& group) const {
    const BlockStage stage(batch.lists, group.index());
    char* shared = static_cast<char*>(group.shared());
    group.each_thread([&](unsigned thread) { stage.copy(shared, thread, kThreads); });
    const BlockLists lists = stage.block(shared);
    group.each_thread([&](unsigned thread) {
      for (std::size_t i = thread; i < MeshBlock::kSamples; i += kThreads) {
        evaluate(SampleThread(group.index() * MeshBlock::kSamples + i), lists);
      }
    });
  }

 private:
  ASTROLITH_HD void evaluate(const SampleThread& t, const BlockLists& lists) const {
    MeshBlock& block = batch.blocks[t.block];
    const int layer_z = batch.places[t.block].z;
    const SampleRow row = row_to_evaluate(batch.grid, layer_z, batch.owners(t.block), block, t.y, t.z);
    float value = kOutsideGrid;
    if (t.x >= row.first && t.x <= row.last) {
      const SampleGrid& samples = batch.grid.samples;
      const int gx = block.x * kBlockCells + t.x, gy = block.y * kBlockCells + t.y,
                gz = layer_z * kBlockCells + t.z;
      const Vec3f p{samples.x(gx), samples.y(gy), samples.z(gz)};
      value = field_at(batch.field, lists, p, band);
      if (batch.grid.closed && value > 0.0f && on_border(batch.grid, gx, gy, gz)) {
        batch.fail(MeshFailure::kBorder);
      }
    }
    block.values[MeshBlock::sample(t.x, t.y, t.z)] = value;
  }
};

// Each group of threads finds the normals at the vertices of one block.
struct TakeNormals {
  static constexpr unsigned kThreads = 128;
  static constexpr std::uint32_t kRows = MeshBatch::kRows;
  static constexpr std::size_t kGroupBytes = BlockStage::kBytes + (2 * kRows + 1) * sizeof(std::uint32_t) + 4;
  MeshBatch batch;
  float h;                     // size of the tetrahedra whose differences give a normal, length units
  const std::uint32_t* first;  // number of the first vertex of each row of the batch (rows + 1)
  MeshVertex* vertices;

  template <class Group>
  ASTROLITH_HD void operator()(const Group& group) const {
    const BlockStage stage(batch.lists, group.index());
    char* shared = static_cast<char*>(group.shared());
    // For each row of the block: the number of its first vertex in the batch, and the number of vertices in
    // the block's earlier rows.
    auto* begin = reinterpret_cast<std::uint32_t*>(shared + BlockStage::kBytes);
    std::uint32_t* before = begin + kRows;
    group.each_thread([&](unsigned thread) {
      stage.copy(shared, thread, kThreads);
      for (std::uint32_t r = thread; r < kRows; r += kThreads) {
        const RowThread row(group.index() * kRows + r);
        const std::uint32_t number =
            batch.places[row.block].row(static_cast<std::uint32_t>(row.block), row.y, row.z);
        begin[r] = first[number];
        before[r + 1] = first[number + 1] - first[number];
      }
    });
    group.each_thread([&](unsigned thread) {
      if (thread != 0) return;
      before[0] = 0;
      for (std::uint32_t r = 0; r < kRows; ++r) before[r + 1] += before[r];
    });
    const BlockLists lists = stage.block(shared);
    group.each_thread([&](unsigned thread) {
      std::uint32_t r = 0;
      for (std::uint32_t k = thread; k < before[kRows]; k += kThreads) {
        while (before[r + 1] <= k) ++r;
        take(lists, vertices[begin[r] + (k - before[r])]);
      }
    });
  }

 private:
  ASTROLITH_HD void take(const BlockLists& lists, MeshVertex& vertex) const {
    Vec3f corners[4];
    for (int k = 0; k < 4; ++k) corners[k] = normal_probe(vertex.position, h, k);
    float values[4];
    field_at_tetrahedron(batch.field, lists, corners, values);
    take_normal(values, vertex);
  }
};

}  // namespace astrolith
