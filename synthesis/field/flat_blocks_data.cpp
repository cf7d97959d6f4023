#include "synthesis/field/flat_blocks_data.h"

#include "numerics/parallel_for.h"

namespace astrolith {

void FlatBlocksData::add(std::span<const MetaballSphere<float>> of_leaf) {
  spheres.insert(spheres.end(), of_leaf.begin(), of_leaf.end());
  first_sphere.push_back(static_cast<std::uint32_t>(spheres.size()));
}

void FlatBlocksData::add(const PreparedBody& body) {
  add(std::span<const MetaballSphere<float>>(body.metaballs.spheres));
  for (const PreparedOperation& operation : body.operations) add(operation.operand);
}

void FlatBlocksData::add(const FieldBlock& block, const BlockLists& of_block) {
  add(block.body());
  const auto append_all = [](const auto& parts, auto& array, std::vector<std::uint32_t>& first) {
    for (const auto& list : parts) {
      array.insert(array.end(), list.begin(), list.end());
      first.push_back(static_cast<std::uint32_t>(array.size()));
    }
  };
  append_all(of_block.spots, impulses, first_impulse);
  append_all(of_block.gabor, gabor, first_gabor);
  append_all(of_block.landforms, landforms, first_landform);
}

void FlatBlocksData::add(std::span<const FieldBlock* const> blocks) {
  std::vector<BlockLists> of_blocks(blocks.size());
  parallel_for(0, static_cast<std::int64_t>(blocks.size()), [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    of_blocks[k] = blocks[k]->lists();
  });
  for (std::size_t i = 0; i < blocks.size(); ++i) add(*blocks[i], of_blocks[i]);
}

FlatBlocks FlatBlocksData::view() const {
  const auto number = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  return {spheres.data(), first_sphere.data(), impulses.data(),  first_impulse.data(),
          gabor.data(),   first_gabor.data(),  landforms.data(), first_landform.data(),
          number(leaves), number(sizes),       number(bands),    number(lists)};
}

}  // namespace astrolith
