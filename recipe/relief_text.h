// The pixels of a relief as text, for recipes that hold them instead of naming a file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "recipe/exemplar_image.h"
#include "recipe/relief_layer.h"

namespace astrolith {

// The heights of the layer's pixels, coded in few bits (recipe/compact/height_picture.h), as base64. Expects
// pixels.
std::string relief_text(const ReliefLayer& layer);

// The pixels whose text this is, for a layer with these levels; null where the text is damaged.
std::shared_ptr<const ExemplarImage> relief_pixels(const ReliefLayer& layer, std::string_view text);

}  // namespace astrolith
