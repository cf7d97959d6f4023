// A field's tables and the lists of blocks (synthesis/field/field_tables.h), copied into a backend's memory.
#pragma once

#include "cuda/backend.h"
#include "synthesis/field/block_lists.h"

namespace astrolith {

template <class Backend>
class FieldOnBackend {
 public:
  FieldOnBackend(Backend& backend, const FieldView& field)
      : arrays_(backend.upload(std::span(field.arrays.bytes, field.arrays.size))),
        layers_(backend.upload(std::span(field.layers, field.num_layers))),
        view_(field) {
    view_.arrays.bytes = arrays_.data();
    view_.layers = layers_.data();
  }

  // The tables in the backend's memory. The view is valid while this object lives.
  const FieldView& view() const { return view_; }

 private:
  template <typename T>
  using Array = typename Backend::template Array<T>;

  Array<unsigned char> arrays_;
  Array<FieldLayer> layers_;
  FieldView view_;
};

template <class Backend>
class BlocksOnBackend {
 public:
  BlocksOnBackend(Backend& backend, const BlockListStore& store)
      : view_(store.view()),
        metaballs_(upload(backend, store.metaballs, view_.metaballs)),
        first_metaball_(upload(backend, store.first_metaball, view_.first_metaball)),
        spots_(upload(backend, store.spots, view_.spots)),
        first_spot_(upload(backend, store.first_spot, view_.first_spot)),
        gabor_(upload(backend, store.gabor, view_.gabor)),
        first_gabor_(upload(backend, store.first_gabor, view_.first_gabor)),
        landforms_(upload(backend, store.landforms, view_.landforms)),
        first_landform_(upload(backend, store.first_landform, view_.first_landform)) {}

  // The lists in the backend's memory. The view is valid while this object lives.
  BlockListArrays view() const { return view_; }

 private:
  template <typename T>
  using Array = typename Backend::template Array<T>;

  // Uploads the values and sets a pointer of the view to them.
  template <typename T>
  static Array<T> upload(Backend& backend, const std::vector<T>& values, const T*& pointer) {
    Array<T> array = backend.upload(std::span<const T>(values));
    pointer = array.data();
    return array;
  }

  BlockListArrays view_;
  Array<MetaballSphere<float>> metaballs_;
  Array<std::uint32_t> first_metaball_;
  Array<SpotImpulse> spots_;
  Array<std::uint32_t> first_spot_;
  Array<GaborImpulse> gabor_;
  Array<std::uint32_t> first_gabor_;
  Array<std::uint32_t> landforms_;
  Array<std::uint32_t> first_landform_;
};

}  // namespace astrolith
