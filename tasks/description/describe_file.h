// The description of a shape that came from a file.
#pragma once

#include <string>

#include "descriptor/shape_description.h"
#include "numerics/errors.h"

namespace astrolith {

// Calls describe_shape() and puts the file's name before an error message.
template <typename... Arguments>
ShapeDescription describe_file(const std::string& file, const Arguments&... arguments) {
  try {
    return describe_shape(arguments...);
  } catch (const InputError& e) {
    throw InputError(file + ": " + e.what());
  }
}

}  // namespace astrolith
