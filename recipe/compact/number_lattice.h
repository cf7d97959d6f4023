// Numbers as integers times a decimal step, such as 1.25 = 5 * 25e-2.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace astrolith {

// The numbers k * multiple / 10^decimals for integers k.
struct NumberLattice {
  int decimals = 0;           // -kMostDecimals .. kMostDecimals
  std::int64_t multiple = 1;  // 1 .. kMostLatticeInteger

  bool operator==(const NumberLattice&) const = default;
};

// Up to these limits a division or a product rounds like the decimal text of the number.
inline constexpr int kMostDecimals = 22;
inline constexpr std::int64_t kMostLatticeInteger = std::int64_t{1} << 53;

struct LatticeNumbers {
  NumberLattice lattice;
  std::vector<std::int64_t> integers;  // k of every number
};

// The coarsest lattice that holds every number to its last bit, or nothing if there is none: for a number
// with more than some 16 digits, numbers of very different sizes, -0, or one that is not finite.
std::optional<LatticeNumbers> find_lattice(std::span<const double> numbers);

// The lattice's number k, or nothing if it is beyond the limits.
std::optional<double> lattice_number(const NumberLattice& lattice, std::int64_t k);

}  // namespace astrolith
