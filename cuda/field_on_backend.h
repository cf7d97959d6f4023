// The plain arrays of a field (synthesis/field/flat_field.h) in a backend's memory.
#pragma once

#include "cuda/backend.h"
#include "synthesis/field/flat_blocks_data.h"

namespace astrolith {

template <class Backend>
class FieldOnBackend {
 public:
  FieldOnBackend(Backend& backend, const FlatFieldData& data)
      : view_(data.view()),
        layers_(upload(backend, data.layers, view_.layers)),
        leaves_(upload(backend, data.leaves, view_.leaves)),
        spheres_(upload(backend, data.spheres, view_.spheres)),
        steps_(upload(backend, data.steps, view_.steps)),
        octaves_(upload(backend, data.octaves, view_.octaves)),
        weight_spheres_(upload(backend, data.weight_spheres, view_.weight_spheres)),
        sparse_levels_(upload(backend, data.sparse_levels, view_.sparse_levels)),
        spots_(upload(backend, data.spots, view_.spots)),
        spot_thresholds_(upload(backend, data.spot_thresholds, view_.spot_thresholds)),
        waves_(upload(backend, data.waves, view_.waves)),
        bands_(upload(backend, data.bands, view_.bands)),
        lobes_(upload(backend, data.lobes, view_.lobes)),
        craters_(upload(backend, data.craters, view_.craters)),
        crater_layers_(upload(backend, data.crater_layers, view_.crater_layers)),
        boulders_(upload(backend, data.boulders, view_.boulders)) {}

  // With the backend's arrays.
  const FlatField& view() const { return view_; }

 private:
  template <typename T>
  using Array = typename Backend::template Array<T>;

  // And lets the view point there.
  template <typename T>
  static Array<T> upload(Backend& backend, const std::vector<T>& values, const T*& pointer) {
    Array<T> array = backend.upload(std::span<const T>(values));
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

template <class Backend>
class BlocksOnBackend {
 public:
  BlocksOnBackend(Backend& backend, const FlatBlocksData& data)
      : view_(data.view()),
        spheres_(backend.upload(std::span<const MetaballSphere<float>>(data.spheres))),
        first_sphere_(backend.upload(std::span<const std::uint32_t>(data.first_sphere))),
        impulses_(backend.upload(std::span<const SpotImpulse>(data.impulses))),
        first_impulse_(backend.upload(std::span<const std::uint32_t>(data.first_impulse))),
        gabor_(backend.upload(std::span<const GaborImpulse>(data.gabor))),
        first_gabor_(backend.upload(std::span<const std::uint32_t>(data.first_gabor))),
        landforms_(backend.upload(std::span<const std::uint32_t>(data.landforms))),
        first_landform_(backend.upload(std::span<const std::uint32_t>(data.first_landform))) {}

  FlatBlocks view() const {
    return {spheres_.data(), first_sphere_.data(), impulses_.data(),  first_impulse_.data(),
            gabor_.data(),   first_gabor_.data(),  landforms_.data(), first_landform_.data(),
            view_.leaves,    view_.sizes,          view_.bands,       view_.lists};
  }

 private:
  template <typename T>
  using Array = typename Backend::template Array<T>;

  FlatBlocks view_;
  Array<MetaballSphere<float>> spheres_;
  Array<std::uint32_t> first_sphere_;
  Array<SpotImpulse> impulses_;
  Array<std::uint32_t> first_impulse_;
  Array<GaborImpulse> gabor_;
  Array<std::uint32_t> first_gabor_;
  Array<std::uint32_t> landforms_;
  Array<std::uint32_t> first_landform_;
};

}  // namespace astrolith
