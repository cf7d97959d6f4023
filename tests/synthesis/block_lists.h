// The lists of the elements that reach blocks (synthesis/field/field_tables.h), gathered on the host block by
// block.
#pragma once

#include <vector>

#include "synthesis/field/field_tables.h"
#include "synthesis/field/gathering.h"

namespace astrolith {

class BlockListStore {
 public:
  // A store for blocks of this field.
  explicit BlockListStore(const FieldView& field)
      : leaves_(field.body.leaves.count),
        spot_lists_(field.spot_lists.count),
        gabor_lists_(field.gabor_lists.count),
        landform_lists_(field.num_landform_lists()) {}

  // Appends the lists of a block of the field that the store was made for.
  void add(const FieldView& field, const Box& box);

  // A view of this object's arrays, valid until a block is added.
  BlockListArrays view() const;

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

  std::uint32_t leaves_, spot_lists_, gabor_lists_, landform_lists_;  // lists of one block
};

template <class T>
void end_list(const std::vector<T>& items, std::vector<std::uint32_t>& first) {
  first.push_back(static_cast<std::uint32_t>(items.size()));
}

inline void BlockListStore::add_metaballs(const FieldView& field, const Box& box) {
  const Box at = body_box(field.body, field.arrays, box);
  for (std::uint32_t l = 0; l < leaves_; ++l) {
    const BodyLeaf& leaf = field.leaf(l);
    const Box reached_box = leaf_box(field.body, field.arrays, l, at);
    for (const MetaballSphere<float>& sphere : field.arrays.span(leaf.spheres)) {
      if (metaball_reaches(leaf, sphere, reached_box)) metaballs.push_back(sphere);
    }
    end_list(metaballs, first_metaball);
  }
}

inline void BlockListStore::add_landforms(const FieldView& field, const Box& box) {
  const Box projected = projected_block(field, box);
  for (std::uint32_t list = 0; list < field.crater_layers.count; ++list) {
    for (std::uint32_t i = 0; i < field.craters(list).craters.count; ++i) {
      if (crater_reaches(field, list, i, projected)) landforms.push_back(i);
    }
    end_list(landforms, first_landform);
  }
  for (std::uint32_t i = 0; i < field.boulders.count; ++i) {
    if (boulder_reaches(field, i, box)) landforms.push_back(i);
  }
  end_list(landforms, first_landform);
}

inline void BlockListStore::add(const FieldView& field, const Box& box) {
  add_metaballs(field, box);
  add_landforms(field, box);
  for (std::uint32_t list = 0; list < spot_lists_; ++list) {
    gather_spots(field, list, box, [&](const SpotImpulse& impulse) { spots.push_back(impulse); });
    end_list(spots, first_spot);
  }
  const ReachingMetaballs all = all_metaballs(field.body, field.arrays);
  for (std::uint32_t list = 0; list < gabor_lists_; ++list) {
    gather_gabor<Frame::kPatch>(field, list, all.lists(), box,
                                [&](const GaborImpulse& impulse) { gabor.push_back(impulse); });
    end_list(gabor, first_gabor);
  }
}

inline BlockListArrays BlockListStore::view() const {
  return {metaballs.data(), first_metaball.data(), spots.data(),     first_spot.data(),
          gabor.data(),     first_gabor.data(),    landforms.data(), first_landform.data(),
          leaves_,          spot_lists_,           gabor_lists_,     landform_lists_};
}

}  // namespace astrolith
