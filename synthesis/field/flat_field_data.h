// Makes the plain arrays of flat_field.h from an ImplicitField.
#pragma once

#include <string>
#include <vector>

#include "synthesis/field/flat_value.h"
#include "synthesis/field/implicit_field.h"

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

  std::uint32_t next_layer() const { return static_cast<std::uint32_t>(layers.size()); }

  std::vector<FlatLayer> layers;
  std::vector<FlatLeaf> leaves;
  std::vector<MetaballSphere<float>> spheres;  // of all leaves
  std::vector<FlatStep> steps;
  std::vector<NoiseOctave> octaves;
  std::vector<WeightSphere> weight_spheres;
  std::vector<SparseLevel> sparse_levels;
  std::vector<FlatSpots> spots;
  std::vector<std::uint32_t> spot_thresholds;
  std::vector<Wave> waves;
  std::vector<FlatBand> bands;
  std::vector<GaborLobeShare> lobes;
  std::vector<CraterKernel> craters;
  std::vector<std::uint32_t> crater_layers;  // by list of craters
  std::vector<FlatBoulder> boulders;
  std::size_t lists = 0;  // of craters and boulders that reach a block
  FlatField values;       // its pointers are not used
};

}  // namespace astrolith
