// Copies the lists of a block into the memory that a group of threads shares, since all points of the block
// read them. Lists that do not fit stay where they are.
#pragma once

#include "cuda/backend.h"
#include "synthesis/field/field_tables.h"

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

}  // namespace astrolith
