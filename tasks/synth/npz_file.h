// Writes several named arrays into one file that numpy.load reads: a zip archive of .npy files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace astrolith {

// An array, its last index running fastest. It does not own its values.
struct NpzArray {
  std::string name;
  std::string type;        // numpy's word, such as "<f4"
  std::vector<int> shape;  // empty for a single number
  std::span<const std::byte> values;
};

NpzArray npz_array(std::string name, std::vector<int> shape, std::span<const float> values);
NpzArray npz_array(std::string name, std::vector<int> shape, std::span<const double> values);
NpzArray npz_array(std::string name, std::vector<int> shape, std::span<const std::int8_t> values);
NpzArray npz_array(std::string name, std::vector<int> shape, std::span<const std::int32_t> values);

// Writes the arrays, compressed, in their order. The file has no time stamps: equal arrays give equal bytes.
// It appears whole or not at all. Throws InputError where the target cannot be written, and WorkError where
// the number of values of an array is not the product of its shape, or where memory or the disk is full.
void write_npz(std::span<const NpzArray> arrays, const std::filesystem::path& file);

}  // namespace astrolith
