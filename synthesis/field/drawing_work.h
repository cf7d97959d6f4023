// How many random numbers a point takes at most.
#pragma once

#include <string>

#include "synthesis/field/field_tables.h"

namespace astrolith {

// Adds up the draws of layer after layer.
class DrawingWork {
 public:
  // Adds a layer's noise with all its sizes. Throws InputError, which begins with `place`, where a point far
  // from all others would take too long with the layers so far.
  void add(const LayerNoise& noise, const ArrayView& arrays, const std::string& place);

 private:
  double spot_draws_ = 0.0, gabor_draws_ = 0.0;
};

}  // namespace astrolith
