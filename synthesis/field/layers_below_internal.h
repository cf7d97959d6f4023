// The surface that the first layers of a model make, for layers that are placed on it.
#pragma once

#include "synthesis/body/layer_site.h"
#include "synthesis/field/field_model_internal.h"

namespace astrolith {

// F of the body with the first `layers` layers of the model and without boulders, at points in the
// coordinates of `frame`. If the body is plain, these are displaced by its warp. The result is empty if none
// of the layers changes an elevation. It is valid until the model changes; `model.tables` must be up to date.
FieldBelow field_below(const FieldModel& model, std::size_t layers, const NoiseFrame& frame);

}  // namespace astrolith
