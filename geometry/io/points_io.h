// Reads lists of points from text files.
#pragma once

#include <filesystem>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// One point a line: x, y and z, separated by commas or blanks; what follows them is ignored. Empty lines,
// lines that begin with # and one line of column names at the start are skipped. Throws InputError ("FILE:
// line 7: what is wrong; what to do") for a file without points and for numbers that are missing or not
// finite. The size of the file bounds the memory used.
std::vector<Vec3d> read_points(const std::filesystem::path& file);

}  // namespace astrolith
