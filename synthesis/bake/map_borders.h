// The texels of maps around charts, which filters of a renderer read, too.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace astrolith {

struct BorderCopy {
  std::uint32_t to, from;  // texels, row-major
};

// The texels that are not covered and lie within `reach` rings of eight neighbours of a covered one, each
// with a covered one. Rings grow one after another; of several neighbours in the ring before, the first
// counts: left, right, above, below, then the corners. `covered` is 0 or another number. (side x side)
std::vector<BorderCopy> border_copies(std::span<const std::uint8_t> covered, int side, int reach);

// Copies values into the texels of the borders.
template <typename Value>
void fill_borders(std::span<const BorderCopy> copies, std::size_t channels, std::span<Value> values) {
  for (const BorderCopy& copy : copies) {
    for (std::size_t k = 0; k < channels; ++k)
      values[channels * copy.to + k] = values[channels * copy.from + k];
  }
}

}  // namespace astrolith
