// Vectors in the JSON of summaries and of files.
#pragma once

#include <nlohmann/json.hpp>

#include "numerics/vec3.h"

namespace astrolith {

// The coordinates as an array [x, y, z].
inline nlohmann::ordered_json to_json(const Vec3d& v) { return {v.x, v.y, v.z}; }

}  // namespace astrolith
