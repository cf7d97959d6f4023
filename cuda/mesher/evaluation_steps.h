// The two steps of meshing a batch that evaluate the field. Each block has a group of threads, which read the
// block's lists from the memory that the group shares, since all points of the block read them. Lists that do
// not fit there stay where they are.
#pragma once

#include "cuda/backend.h"
#include "cuda/mesher/mesh_steps.h"
#include "synthesis/field/field_at_point.h"

namespace astrolith {

// The lists of one kind of a block, and their place in the shared memory.
template <typename T>
class StagedLists {
 public:
  static_assert(alignof(T) <= alignof(std::uint32_t));

  // `left` is the number of free bytes, which end at byte `end` of the shared memory. If the lists fit, the
  // constructor takes their bytes from it.
  ASTROLITH_HD StagedLists(const T* items, const std::uint32_t* first, std::uint32_t lists, std::size_t end,
                           std::size_t& left)
      : items_(items), first_(first), lists_(lists), count_(lists == 0 ? 0 : first[lists] - first[0]) {
    const std::size_t bytes = (lists_ + 1) * sizeof(std::uint32_t) + count_ * sizeof(T);
    is_staged_ = lists_ != 0 && bytes <= left;
    begin_ = end - left;
    if (is_staged_) left -= bytes;
  }

  // Copies the share of one thread.
  ASTROLITH_HD void copy(char* shared, unsigned thread, unsigned threads) const {
    if (!is_staged_) return;
    for (std::uint32_t k = thread; k <= lists_; k += threads) offsets(shared)[k] = first_[k] - first_[0];
    for (std::uint32_t k = thread; k < count_; k += threads) copies(shared)[k] = items_[first_[0] + k];
  }
  // Sets the pointers to the copies, if the lists were copied.
  ASTROLITH_HD void point_to(char* shared, const T*& items, const std::uint32_t*& first) const {
    if (!is_staged_) return;
    items = copies(shared);
    first = offsets(shared);
  }

 private:
  ASTROLITH_HD std::uint32_t* offsets(char* shared) const {
    return reinterpret_cast<std::uint32_t*>(shared + begin_);
  }
  ASTROLITH_HD T* copies(char* shared) const { return reinterpret_cast<T*>(offsets(shared) + lists_ + 1); }

  const T* items_;
  const std::uint32_t* first_;
  std::uint32_t lists_, count_;
  std::size_t begin_;
  bool is_staged_;
};

class BlockStage {
 public:
  // Half of kSharedBytes, so that more groups run on a multiprocessor at a time.
  static constexpr std::size_t kBytes = 24 * 1024;

  ASTROLITH_HD BlockStage(const BlockListArrays& blocks, std::size_t block)
      : from_(blocks.block(block)),
        left_(kBytes),
        metaballs_(from_.metaballs.spheres, from_.metaballs.first, blocks.leaves, kBytes, left_),
        spots_(from_.spots, from_.first_spot, blocks.spot_lists, kBytes, left_),
        landforms_(from_.landforms, from_.first_landform, blocks.landform_lists, kBytes, left_),
        gabor_(from_.gabor, from_.first_gabor, blocks.gabor_lists, kBytes, left_) {}

  // Every thread of the group copies its share; `shared` is aligned to four bytes.
  ASTROLITH_HD void copy(char* shared, unsigned thread, unsigned threads) const {
    metaballs_.copy(shared, thread, threads);
    spots_.copy(shared, thread, threads);
    landforms_.copy(shared, thread, threads);
    gabor_.copy(shared, thread, threads);
  }
  // The lists of the block, once all threads have copied their shares.
  ASTROLITH_HD BlockLists block(char* shared) const {
    BlockLists staged = from_;
    metaballs_.point_to(shared, staged.metaballs.spheres, staged.metaballs.first);
    spots_.point_to(shared, staged.spots, staged.first_spot);
    landforms_.point_to(shared, staged.landforms, staged.first_landform);
    gabor_.point_to(shared, staged.gabor, staged.first_gabor);
    return staged;
  }

 private:
  BlockLists from_;
  std::size_t left_;
  StagedLists<MetaballSphere<float>> metaballs_;
  StagedLists<SpotImpulse> spots_;
  StagedLists<std::uint32_t> landforms_;
  StagedLists<GaborImpulse> gabor_;
};

// A point of the grid along the body's axes, as the functions of synthesis/field/field_at_point.h take it in
// the frame.
template <Frame frame>
ASTROLITH_HD Vec3f along_body(const MeshGrid& grid, const Vec3f& p) {
  return frame == Frame::kPatch ? grid.place.along_body(p) : p;
}

// Each group of threads evaluates the samples of one block.
template <Frame frame>
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
      value = field_at<frame>(batch.field, lists, along_body<frame>(batch.grid, p), band);
      if (batch.grid.closed && value > 0.0f && on_border(batch.grid, gx, gy, gz)) {
        batch.fail(MeshFailure::kBorder);
      }
    }
    block.values[MeshBlock::sample(t.x, t.y, t.z)] = value;
  }
};

// Each group of threads finds the normals at the vertices of one block.
template <Frame frame>
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
    for (int k = 0; k < 4; ++k) {
      corners[k] = along_body<frame>(batch.grid, normal_probe(vertex.position, h, k));
    }
    float values[4];
    field_at_tetrahedron<frame>(batch.field, lists, corners, values);
    take_normal(values, vertex);
  }
};

}  // namespace astrolith
