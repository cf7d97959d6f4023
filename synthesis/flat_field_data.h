// Makes the plain arrays of flat_field.h from an ImplicitField and its blocks.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "synthesis/flat_value.h"
#include "synthesis/implicit_field.h"

namespace astrolith {

// What keeps a field from being flattened for blocks with sides so long, in a few words ("masks by ...");
// empty when nothing does.
std::string obstacle_to_flattening(const ImplicitField& field, double block_side);

struct FlatFieldData {
  // Expects a field without an obstacle.
  explicit FlatFieldData(const ImplicitField& field);

  // Of bare metaballs, without layers.
  explicit FlatFieldData(const MetaballParameters<float>& body);
  // A further layer that adds its heights.
  void add(const FractalNoise& noise);

  // With this object's own arrays, which it points to.
  FlatField view() const;

  std::vector<FlatLayer> layers;
  std::vector<FlatLeaf> leaves;
  std::vector<FlatStep> steps;
  std::vector<NoiseOctave> octaves;
  std::vector<FlatSphere> weight_spheres;
  std::vector<SparseLevel> sparse_levels;
  std::vector<FlatSpots> spots;
  std::vector<Wave> waves;
  std::vector<FlatBand> bands;
  std::vector<CraterKernel> craters;
  std::vector<FlatBoulder> boulders;
  std::size_t lists = 0;  // of craters and boulders that reach a block
  FlatField values;       // its pointers are not used
};

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
  std::vector<std::uint32_t> features;
  std::vector<std::uint32_t> first_feature{0};  // (blocks * lists + 1)

 private:
  void add(const PreparedBody& body);
  void add(const FieldBlock& block, const BlockLists& lists_of_block);
};

}  // namespace astrolith
