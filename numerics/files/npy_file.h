// Writes arrays that numpy.load reads.
#pragma once

#include <bit>
#include <filesystem>
#include <span>
#include <string>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"

namespace astrolith {

// The start of a .npy file of format 1.0, up to its data. `type` is numpy's word for the little-endian type
// of a value, such as "<f8".
inline std::string npy_header(const std::string& type, std::span<const int> shape) {
  static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");
  std::string lengths;  // "5, 5, "; a shape of one length keeps its last comma, as Python's tuples do
  for (const int length : shape) lengths += std::to_string(length) + ", ";
  if (shape.size() > 1) lengths.erase(lengths.size() - 2);
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + lengths + "), }";
  // Magic, version and length take 10 bytes; the data start at a multiple of 64.
  header.append((64 - (10 + header.size() + 1) % 64) % 64, ' ');
  header += '\n';
  std::string start("\x93NUMPY\x01\x00", 8);
  start += static_cast<char>(header.size() & 0xff);
  start += static_cast<char>(header.size() >> 8);
  return start + header;
}

// The number of values of an array.
inline std::size_t npy_size(std::span<const int> shape) {
  std::size_t size = 1;
  for (const int length : shape) size *= static_cast<std::size_t>(length);
  return size;
}

// Writes `values` as an array of the given shape, its last index running fastest, into a .npy file of format
// 1.0 (little-endian float64). The file appears whole or not at all. Throws InputError where the target
// cannot be written, and WorkError when the number of values is not the product of the shape.
inline void write_npy(std::span<const double> values, std::span<const int> shape,
                      const std::filesystem::path& file) {
  if (values.size() != npy_size(shape))
    throw WorkError(file.string() + ": the array does not have the stated shape");
  const std::string start = npy_header("<f8", shape);
  OutputFile out(file);
  out.write(start.data(), start.size());
  out.write(values.data(), values.size_bytes());
  out.commit();
}

}  // namespace astrolith
