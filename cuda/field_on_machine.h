// The plain arrays of a field (synthesis/flat_field.h) in a machine's memory.
#pragma once

#include "cuda/machine.h"
#include "synthesis/flat_field_data.h"

namespace astrolith {

template <class Machine>
class FieldOnMachine {
 public:
  FieldOnMachine(Machine& machine, const FlatFieldData& data)
      : values_(data.values),
        layers_(machine.upload(std::span<const FlatLayer>(data.layers))),
        octaves_(machine.upload(std::span<const NoiseOctave>(data.octaves))),
        weight_spheres_(machine.upload(std::span<const FlatSphere>(data.weight_spheres))),
        sparse_levels_(machine.upload(std::span<const SparseLevel>(data.sparse_levels))),
        spots_(machine.upload(std::span<const FlatSpots>(data.spots))) {}

  FlatField view() const {
    FlatField flat = values_;
    flat.layers = layers_.data();
    flat.octaves = octaves_.data();
    flat.weight_spheres = weight_spheres_.data();
    flat.sparse_levels = sparse_levels_.data();
    flat.spots = spots_.data();
    return flat;
  }

 private:
  template <typename T>
  using Array = typename Machine::template Array<T>;

  FlatField values_;
  Array<FlatLayer> layers_;
  Array<NoiseOctave> octaves_;
  Array<FlatSphere> weight_spheres_;
  Array<SparseLevel> sparse_levels_;
  Array<FlatSpots> spots_;
};

template <class Machine>
class BlocksOnMachine {
 public:
  BlocksOnMachine(Machine& machine, const FlatBlocksData& data)
      : lists_(static_cast<std::uint32_t>(data.lists)),
        spheres_(machine.upload(std::span<const MetaballSphere<float>>(data.spheres))),
        first_sphere_(machine.upload(std::span<const std::uint32_t>(data.first_sphere))),
        impulses_(machine.upload(std::span<const SpotImpulse>(data.impulses))),
        first_impulse_(machine.upload(std::span<const std::uint32_t>(data.first_impulse))) {}

  FlatBlocks view() const {
    return {spheres_.data(), first_sphere_.data(), impulses_.data(), first_impulse_.data(), lists_};
  }

 private:
  template <typename T>
  using Array = typename Machine::template Array<T>;

  std::uint32_t lists_;
  Array<MetaballSphere<float>> spheres_;
  Array<std::uint32_t> first_sphere_;
  Array<SpotImpulse> impulses_;
  Array<std::uint32_t> first_impulse_;
};

}  // namespace astrolith
