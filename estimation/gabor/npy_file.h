// Arrays for NumPy.
#pragma once

#include <filesystem>
#include <span>

namespace astrolith {

// Writes (rows x columns) doubles, row-major, as a .npy file of format 1.0 (little-endian float64), whole or
// not at all. Throws InputError where the target cannot be written.
void write_npy(std::span<const double> values, int rows, int columns, const std::filesystem::path& file);

}  // namespace astrolith
