#include "estimation/gabor/npy_file.h"

#include <fmt/format.h>

#include <bit>
#include <string>

#include "numerics/errors.h"
#include "numerics/output_file.h"

namespace astrolith {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

void write_npy(std::span<const double> values, std::span<const int> shape,
               const std::filesystem::path& file) {
  std::size_t count = 1;
  std::string sides;
  for (const int side : shape) {
    count *= static_cast<std::size_t>(side);
    sides += fmt::format("{}{}", sides.empty() ? "" : ", ", side);
  }
  if (values.size() != count) {
    throw WorkError(file.string() + ": the array does not have the stated shape");
  }
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}), }}", sides);
  // Magic, version and length take 10 bytes; the data start at a multiple of 64.
  header.append((64 - (10 + header.size() + 1) % 64) % 64, ' ');
  header += '\n';
  std::string start("\x93NUMPY\x01\x00", 8);
  start += static_cast<char>(header.size() & 0xff);
  start += static_cast<char>(header.size() >> 8);
  start += header;
  OutputFile out(file);
  out.write(start.data(), start.size());
  out.write(values.data(), values.size_bytes());
  out.commit();
}

}  // namespace astrolith
