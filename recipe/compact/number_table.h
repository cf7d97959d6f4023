// Tables of numbers, such as the rows [x, y, z, radius] of metaballs, in few bits.
//
// A column whose numbers lie on a lattice, such as 1.25 = 5 * 25e-2, is stored as integers. Rows in the order
// of spatial_order() are stored as a set of points: the box of all points is halved again and again, and only
// the number of points in each half is written (Devillers and Gandoin, "Geometric compression for interactive
// transmission", 2000). That saves log2(n!) bits against rows in any other order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "recipe/compact/range_coder.h"

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

inline constexpr std::size_t kMostTableColumns = 16;
// Further equal rows would cost no bits, so that a few bytes could declare millions of them. A table whose
// rows are all equal has at most so many rows, and no point of a set of points stands more often.
inline constexpr std::size_t kMostEqualRows = 64;

struct NumberTable {
  std::size_t columns = 1;     // 1 .. kMostTableColumns
  std::vector<double> values;  // row by row; a multiple of `columns`

  std::size_t rows() const { return values.size() / columns; }
};

// The coders of a sequence of tables. A table can share its lattices with the table before it.
class TableEncoder {
 public:
  explicit TableEncoder(RangeEncoder& encoder) : encoder_(encoder) {}
  void encode(const NumberTable& table);

 private:
  std::vector<std::optional<NumberLattice>> last_ =
      std::vector<std::optional<NumberLattice>>(kMostTableColumns);  // of each column
  RangeEncoder& encoder_;
};

class TableDecoder {
 public:
  explicit TableDecoder(RangeDecoder& decoder) : decoder_(decoder) {}
  // Throws DamagedStream, also for a table of more than `most_values`, before it allocates them.
  NumberTable decode(std::size_t most_values);

 private:
  std::vector<std::optional<NumberLattice>> last_ =
      std::vector<std::optional<NumberLattice>>(kMostTableColumns);
  RangeDecoder& decoder_;
};

// The order of rows in which a table takes the fewest bytes. Tables whose columns have no lattice keep
// theirs.
std::vector<std::size_t> spatial_order(const NumberTable& table);

}  // namespace astrolith
