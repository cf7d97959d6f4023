// The plain arrays of a field (synthesis/field/flat_field.h) in a machine's memory.
#pragma once

#include "cuda/machine.h"
#include "synthesis/field/flat_blocks_data.h"

namespace astrolith {

template <class Machine>
class FieldOnMachine {
 public:
  FieldOnMachine(Machine& machine, const FlatFieldData& data)
      : view_(data.view()),
        layers_(upload(machine, data.layers, view_.layers)),
        leaves_(upload(machine, data.leaves, view_.leaves)),
        spheres_(upload(machine, data.spheres, view_.spheres)),
        steps_(upload(machine, data.steps, view_.steps)),
        octaves_(upload(machine, data.octaves, view_.octaves)),
        weight_spheres_(upload(machine, data.weight_spheres, view_.weight_spheres)),
        sparse_levels_(upload(machine, data.sparse_levels, view_.sparse_levels)),
        spots_(upload(machine, data.spots, view_.spots)),
        spot_thresholds_(upload(machine, data.spot_thresholds, view_.spot_thresholds)),
        waves_(upload(machine, data.waves, view_.waves)),
        bands_(upload(machine, data.bands, view_.bands)),
        lobes_(upload(machine, data.lobes, view_.lobes)),
        craters_(upload(machine, data.craters, view_.craters)),
        crater_layers_(upload(machine, data.crater_layers, view_.crater_layers)),
        boulders_(upload(machine, data.boulders, view_.boulders)) {}

  // With the machine's arrays.
  const FlatField& view() const { return view_; }

 private:
  template <typename T>
  using Array = typename Machine::template Array<T>;

  // And lets the view point there.
  template <typename T>
  static Array<T> upload(Machine& machine, const std::vector<T>& values, const T*& pointer) {
    Array<T> array = machine.upload(std::span<const T>(values));
    pointer = array.data();
    return array;
  }

  FlatField view_;
  Array<FlatLayer> layers_;
  Array<FlatLeaf> leaves_;
  Array<MetaballSphere<float>> spheres_;
  Array<FlatStep> steps_;
  Array<NoiseOctave> octaves_;
  Array<WeightSphere> weight_spheres_;
  Array<SparseLevel> sparse_levels_;
  Array<FlatSpots> spots_;
  Array<std::uint32_t> spot_thresholds_;
  Array<Wave> waves_;
  Array<FlatBand> bands_;
  Array<GaborLobeShare> lobes_;
  Array<CraterKernel> craters_;
  Array<std::uint32_t> crater_layers_;
  Array<FlatBoulder> boulders_;
};

template <class Machine>
class BlocksOnMachine {
 public:
  BlocksOnMachine(Machine& machine, const FlatBlocksData& data)
      : view_(data.view()),
        spheres_(machine.upload(std::span<const MetaballSphere<float>>(data.spheres))),
        first_sphere_(machine.upload(std::span<const std::uint32_t>(data.first_sphere))),
        impulses_(machine.upload(std::span<const SpotImpulse>(data.impulses))),
        first_impulse_(machine.upload(std::span<const std::uint32_t>(data.first_impulse))),
        gabor_(machine.upload(std::span<const GaborImpulse>(data.gabor))),
        first_gabor_(machine.upload(std::span<const std::uint32_t>(data.first_gabor))),
        features_(machine.upload(std::span<const std::uint32_t>(data.features))),
        first_feature_(machine.upload(std::span<const std::uint32_t>(data.first_feature))) {}

  FlatBlocks view() const {
    return {spheres_.data(), first_sphere_.data(), impulses_.data(), first_impulse_.data(),
            gabor_.data(),   first_gabor_.data(),  features_.data(), first_feature_.data(),
            view_.leaves,    view_.sizes,          view_.bands,      view_.lists};
  }

 private:
  template <typename T>
  using Array = typename Machine::template Array<T>;

  FlatBlocks view_;
  Array<MetaballSphere<float>> spheres_;
  Array<std::uint32_t> first_sphere_;
  Array<SpotImpulse> impulses_;
  Array<std::uint32_t> first_impulse_;
  Array<GaborImpulse> gabor_;
  Array<std::uint32_t> first_gabor_;
  Array<std::uint32_t> features_;
  Array<std::uint32_t> first_feature_;
};

}  // namespace astrolith
