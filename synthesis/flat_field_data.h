// Makes the plain arrays of flat_field.h from an ImplicitField and its blocks.
#pragma once

#include <string>
#include <vector>

#include "synthesis/flat_field.h"
#include "synthesis/implicit_field.h"

namespace astrolith {

// What keeps a field from being flattened, in a few words ("layers of craters"); empty when nothing does.
std::string obstacle_to_flattening(const ImplicitField& field);

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
  std::vector<NoiseOctave> octaves;
  std::vector<FlatSphere> weight_spheres;
  std::vector<SparseLevel> sparse_levels;
  std::vector<FlatSpots> spots;
  FlatField values;  // its pointers are not used
};

// Of some blocks, one after the other.
struct FlatBlocksData {
  // As many lists as FlatFieldData::spots.
  explicit FlatBlocksData(std::size_t num_lists) : lists(num_lists) {}

  void add(const FieldBlock& block);
  // Without impulses.
  void add(std::span<const MetaballSphere<float>> of_block);
  // With this object's own arrays.
  FlatBlocks view() const;
  std::size_t size() const { return first_sphere.size() - 1; }

  std::size_t lists;  // of impulses, a block
  std::vector<MetaballSphere<float>> spheres;
  std::vector<std::uint32_t> first_sphere{0};  // (blocks + 1)
  std::vector<SpotImpulse> impulses;
  std::vector<std::uint32_t> first_impulse{0};  // (blocks * lists + 1)
};

}  // namespace astrolith
