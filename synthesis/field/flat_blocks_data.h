// Makes the lists of flat_field.h's blocks from those of an ImplicitField.
#pragma once

#include <array>

#include "synthesis/field/flat_field_data.h"

namespace astrolith {

// Of some blocks, one after the other.
struct FlatBlocksData {
  // Of one leaf, without layers.
  FlatBlocksData() = default;
  // Of this field.
  explicit FlatBlocksData(const FlatFieldData& field)
      : leaves(field.leaves.size()),
        sizes(field.spots.size()),
        bands(field.bands.size()),
        lists(field.lists) {}

  // Gathers in parallel.
  void add(std::span<const FieldBlock* const> blocks);
  void add(const FieldBlock& block) { add(std::array{&block}); }
  void add(std::span<const MetaballSphere<float>> of_leaf);
  // With this object's own arrays.
  FlatBlocks view() const;
  std::size_t size() const { return (first_sphere.size() - 1) / leaves; }

  std::size_t leaves = 1, sizes = 0, bands = 0, lists = 0;  // a block
  std::vector<MetaballSphere<float>> spheres;
  std::vector<std::uint32_t> first_sphere{0};  // (blocks * leaves + 1)
  std::vector<SpotImpulse> impulses;
  std::vector<std::uint32_t> first_impulse{0};  // (blocks * sizes + 1)
  std::vector<GaborImpulse> gabor;
  std::vector<std::uint32_t> first_gabor{0};  // (blocks * bands + 1)
  std::vector<std::uint32_t> landforms;
  std::vector<std::uint32_t> first_landform{0};  // (blocks * lists + 1)

 private:
  void add(const PreparedBody& body);
  void add(const FieldBlock& block, const BlockLists& lists_of_block);
};

}  // namespace astrolith
