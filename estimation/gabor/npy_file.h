// Arrays for NumPy.
#pragma once

#include <filesystem>
#include <span>

namespace astrolith {

// Writes doubles, the last index of `shape` running fastest, as a .npy file of format 1.0 (little-endian
// float64), whole or not at all. Throws InputError where the target cannot be written.
void write_npy(std::span<const double> values, std::span<const int> shape, const std::filesystem::path& file);

}  // namespace astrolith
