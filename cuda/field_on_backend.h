// A field's tables (synthesis/field/field_tables.h), copied into a backend's memory.
#pragma once

#include "cuda/backend.h"
#include "synthesis/field/field_tables.h"

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

}  // namespace astrolith
