// The lists of the elements that reach blocks (field_tables.h), gathered on the host block by block.
#pragma once

#include <vector>

#include "synthesis/field/field_tables.h"

namespace astrolith {

class BlockListStore {
 public:
  // A store for blocks of a body of one leaf, without layers.
  BlockListStore() = default;
  // A store for blocks of this field.
  explicit BlockListStore(const FieldView& field)
      : leaves_(field.body.leaves.count),
        spot_lists_(field.spot_lists.count),
        gabor_lists_(field.gabor_lists.count),
        landform_lists_(field.num_landform_lists()) {}

  // Appends the lists of a block of the field that the store was made for.
  void add(const FieldView& field, const Box& box);
  // Appends a block that only these metaballs reach. Expects a store without layers.
  void add(std::span<const MetaballSphere<float>> of_leaf);

  // A view of this object's arrays, valid until a block is added.
  BlockListArrays view() const;
  std::size_t size() const { return (first_metaball.size() - 1) / leaves_; }

  std::vector<MetaballSphere<float>> metaballs;
  std::vector<std::uint32_t> first_metaball{0};  // (blocks * leaves + 1)
  std::vector<SpotImpulse> spots;
  std::vector<std::uint32_t> first_spot{0};  // (blocks * spot lists + 1)
  std::vector<GaborImpulse> gabor;
  std::vector<std::uint32_t> first_gabor{0};     // (blocks * Gabor lists + 1)
  std::vector<std::uint32_t> landforms;          // numbers of craters and boulders
  std::vector<std::uint32_t> first_landform{0};  // (blocks * landform lists + 1)

 private:
  void add_metaballs(const FieldView& field, const Box& box);
  void add_landforms(const FieldView& field, const Box& box);

  std::uint32_t leaves_ = 1, spot_lists_ = 0, gabor_lists_ = 0, landform_lists_ = 0;  // lists of one block
};

}  // namespace astrolith
