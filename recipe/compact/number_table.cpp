#include "recipe/compact/number_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <span>

namespace astrolith {
namespace {

constexpr std::uint64_t kMostRows = std::uint64_t{1} << 32;
constexpr int kRangeSteps = 32;  // a range of integers is written with an error of at most two of so many

// What is written of a column's numbers.
enum ColumnKind : std::uint8_t { kLikeColumnBefore, kLikeTableBefore, kOwnLattice, kBits, kColumnKinds };

// Integers from low up to, not including, high.
struct IntegerRange {
  std::int64_t low = 0, high = 1;

  std::uint64_t width() const { return static_cast<std::uint64_t>(high - low); }
};

using Ranges = std::array<IntegerRange, kMostTableColumns>;

std::uint64_t zigzag(std::int64_t value) {
  return value < 0 ? 2 * static_cast<std::uint64_t>(-(value + 1)) + 1 : 2 * static_cast<std::uint64_t>(value);
}
std::int64_t unzigzag(std::uint64_t value) {
  const auto half = static_cast<std::int64_t>(value / 2);
  return value % 2 == 1 ? -half - 1 : half;
}

// A range in coarse steps of 2^shift.
struct CoarseRange {
  int shift = 0;              // 0 .. 53
  std::int64_t first = 0;     // step of the least integer
  std::uint64_t further = 0;  // steps after it, below kRangeSteps

  explicit CoarseRange(int s, std::int64_t f, std::uint64_t n) : shift(s), first(f), further(n) {}
  explicit CoarseRange(std::span<const std::int64_t> integers) {
    if (integers.empty()) return;
    const auto [low, high] = std::minmax_element(integers.begin(), integers.end());
    while ((*high >> shift) - (*low >> shift) >= kRangeSteps) ++shift;
    first = *low >> shift;
    further = static_cast<std::uint64_t>((*high >> shift) - first);
  }
  IntegerRange range() const {
    return {first * (std::int64_t{1} << shift),
            (first + static_cast<std::int64_t>(further) + 1) * (std::int64_t{1} << shift)};
  }
};

// Cumulative shares of the counts 0 .. n of points in the left half of a box that holds n, for the Polya urn
// that starts with kUrn balls, as many of them left as the half's share of the box. Of n points that lie
// evenly the count would be binomial; points of a surface keep together more than that.
//
// Only sums, products and quotients of doubles: the same on every machine.
std::array<std::uint32_t, 258> count_shares(std::size_t n, double left_share) {
  constexpr double kUrn = 8.0;
  const double left = kUrn * left_share, right = kUrn - left;
  std::array<double, 257> weights{};
  const std::size_t middle = n / 2;
  const auto ratio = [&](std::size_t k) {  // of the weights of k + 1 and k
    const auto here = static_cast<double>(k), after = static_cast<double>(n - k);
    return (here + left) * after / ((here + 1.0) * (after - 1.0 + right));
  };
  weights[middle] = 1.0;
  for (std::size_t k = middle; k < n; ++k) weights[k + 1] = weights[k] * ratio(k);
  for (std::size_t k = middle; k > 0; --k) weights[k - 1] = weights[k] / ratio(k - 1);
  double total = 0.0;
  for (std::size_t k = 0; k <= n; ++k) total += weights[k];
  std::array<std::uint32_t, 258> shares{};
  const auto spread = static_cast<double>(kProbabilityScale - (n + 1));
  double sum = 0.0;
  for (std::size_t k = 1; k <= n; ++k) {
    sum += weights[k - 1];
    shares[k] = static_cast<std::uint32_t>(k) + static_cast<std::uint32_t>(sum / total * spread);
  }
  shares[n + 1] = kProbabilityScale;
  return shares;
}
constexpr std::size_t kMostModelled = 256;  // a count of more points is written without a model

// The boxes of a set of points, halved along their widest side. The last column, a radius beside a position,
// counts eight times its width: few bits of it tell most about the rest.
class Boxes {
 public:
  Boxes(std::size_t columns, const Ranges& ranges) : columns_(columns), ranges_(ranges) {}

  // The column along which the box is halved next, or `columns` if it holds only one point.
  std::size_t widest() const {
    std::size_t best = columns_;
    std::uint64_t most = 1;
    for (std::size_t c = 0; c < columns_; ++c) {
      const std::uint64_t width = ranges_[c].width();
      if (width < 2) continue;
      const std::uint64_t weighed = c + 1 == columns_ && columns_ > 1 ? 8 * width : width;
      if (weighed > most) {
        most = weighed;
        best = c;
      }
    }
    return best;
  }
  std::int64_t middle(std::size_t column) const {
    return ranges_[column].low + static_cast<std::int64_t>(ranges_[column].width() / 2);
  }
  double left_share(std::size_t column) const {
    const std::uint64_t width = ranges_[column].width(), left = width / 2;
    return static_cast<double>(left) / static_cast<double>(width);
  }
  // Calls visit() in the half of the box.
  template <class Visit>
  void in_half(std::size_t column, bool left, const Visit& visit) {
    const IntegerRange whole = ranges_[column];
    (left ? ranges_[column].high : ranges_[column].low) = middle(column);
    visit();
    ranges_[column] = whole;
  }
  const IntegerRange& operator[](std::size_t column) const { return ranges_[column]; }
  std::size_t columns() const { return columns_; }

 private:
  std::size_t columns_;
  Ranges ranges_;
};

// Rows of integers, of which some columns are stored as a set of points.
struct IntegerRows {
  std::size_t columns = 0;
  std::vector<std::int64_t> values;

  std::int64_t at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
  std::size_t rows() const { return values.size() / columns; }
};

// Orders rows[begin, end) by the boxes that they lie in. The order within a box that is not halved stays.
void order_in_boxes(const IntegerRows& points, Boxes& boxes, std::span<std::size_t> rows) {
  if (rows.size() < 2) return;
  const std::size_t column = boxes.widest();
  if (column == boxes.columns()) return;
  const std::int64_t middle = boxes.middle(column);
  const auto right = std::stable_partition(rows.begin(), rows.end(),
                                           [&](std::size_t row) { return points.at(row, column) < middle; });
  const auto left = static_cast<std::size_t>(right - rows.begin());
  boxes.in_half(column, true, [&] { order_in_boxes(points, boxes, rows.first(left)); });
  boxes.in_half(column, false, [&] { order_in_boxes(points, boxes, rows.subspan(left)); });
}

class PointSetEncoder {
 public:
  PointSetEncoder(const IntegerRows& points, const Ranges& ranges, RangeEncoder& encoder)
      : points_(points), boxes_(points.columns, ranges), encoder_(encoder) {}

  void encode(std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin;
    if (n == 0) return;
    if (n == 1) return encode_point(begin);
    const std::size_t column = boxes_.widest();
    if (column == boxes_.columns()) return;
    std::size_t middle = begin;
    while (middle < end && points_.at(middle, column) < boxes_.middle(column)) ++middle;
    encode_count(middle - begin, n, boxes_.left_share(column));
    boxes_.in_half(column, true, [&] { encode(begin, middle); });
    boxes_.in_half(column, false, [&] { encode(middle, end); });
  }

 private:
  void encode_point(std::size_t row) {
    for (std::size_t c = 0; c < boxes_.columns(); ++c) {
      encoder_.encode_uniform(static_cast<std::uint64_t>(points_.at(row, c) - boxes_[c].low),
                              boxes_[c].width());
    }
  }
  void encode_count(std::size_t left, std::size_t n, double left_share) {
    if (n > kMostModelled) return encoder_.encode_uniform(left, n + 1);
    const auto shares = count_shares(n, left_share);
    encoder_.encode(shares[left], shares[left + 1] - shares[left], kProbabilityScale);
  }

  const IntegerRows& points_;
  Boxes boxes_;
  RangeEncoder& encoder_;
};

class PointSetDecoder {
 public:
  PointSetDecoder(std::size_t columns, const Ranges& ranges, RangeDecoder& decoder)
      : boxes_(columns, ranges), decoder_(decoder) {}

  IntegerRows decode(std::size_t rows) {
    decode_box(rows);
    return std::move(points_);
  }

 private:
  void decode_box(std::size_t n) {
    points_.columns = boxes_.columns();
    if (n == 0) return;
    if (n == 1) return decode_point();
    const std::size_t column = boxes_.widest();
    if (column == boxes_.columns()) {
      if (n > kMostEqualRows) throw DamagedStream();
      for (std::size_t i = 0; i < n; ++i) decode_point();
      return;
    }
    const std::size_t left = decode_count(n, boxes_.left_share(column));
    boxes_.in_half(column, true, [&] { decode_box(left); });
    boxes_.in_half(column, false, [&] { decode_box(n - left); });
  }
  void decode_point() {
    for (std::size_t c = 0; c < boxes_.columns(); ++c) {
      points_.values.push_back(boxes_[c].low +
                               static_cast<std::int64_t>(decoder_.decode_uniform(boxes_[c].width())));
    }
  }
  std::size_t decode_count(std::size_t n, double left_share) {
    if (n > kMostModelled) return static_cast<std::size_t>(decoder_.decode_uniform(n + 1));
    const auto shares = count_shares(n, left_share);
    const std::uint32_t share = decoder_.share(kProbabilityScale);
    const auto after =
        std::upper_bound(shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(n) + 2, share);
    const auto left = static_cast<std::size_t>(after - shares.begin()) - 1;
    decoder_.take(shares[left], shares[left + 1] - shares[left]);
    return left;
  }

  Boxes boxes_;
  RangeDecoder& decoder_;
  IntegerRows points_;
};

// The length of the longest run of equal rows.
std::size_t longest_run(const IntegerRows& rows) {
  const auto row = [&](std::size_t i) {
    return std::span(rows.values).subspan(i * rows.columns, rows.columns);
  };
  std::size_t longest = 0, run = 0;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const bool same = i > 0 && std::equal(row(i).begin(), row(i).end(), row(i - 1).begin());
    run = same ? run + 1 : 1;
    longest = std::max(longest, run);
  }
  return longest;
}

std::vector<double> copy_column(const NumberTable& table, std::size_t column) {
  std::vector<double> numbers;
  for (std::size_t row = 0; row < table.rows(); ++row)
    numbers.push_back(table.values[row * table.columns + column]);
  return numbers;
}

// The integers of a table's columns: on their lattices, or the bits of its numbers.
struct TableIntegers {
  std::vector<std::optional<NumberLattice>> lattices;  // of each column; none: the bits
  IntegerRows rows;
  std::vector<CoarseRange> coarse;  // of each column

  explicit TableIntegers(const NumberTable& table) {
    rows.columns = table.columns;
    rows.values.resize(table.values.size());
    for (std::size_t c = 0; c < table.columns; ++c) add_column(c, copy_column(table, c));
  }
  bool on_lattices() const {
    return std::all_of(lattices.begin(), lattices.end(),
                       [](const auto& lattice) { return lattice.has_value(); });
  }
  Ranges ranges() const {
    Ranges all{};
    for (std::size_t c = 0; c < coarse.size(); ++c) all[c] = coarse[c].range();
    return all;
  }
  std::vector<std::size_t> order() const {
    std::vector<std::size_t> rows_in_order(rows.rows());
    std::iota(rows_in_order.begin(), rows_in_order.end(), std::size_t{0});
    Boxes boxes(rows.columns, ranges());
    if (on_lattices()) order_in_boxes(rows, boxes, rows_in_order);
    return rows_in_order;
  }

 private:
  void add_column(std::size_t column, const std::vector<double>& numbers) {
    std::optional<LatticeNumbers> found = find_lattice(numbers);
    lattices.emplace_back(found ? std::optional(found->lattice) : std::nullopt);
    coarse.emplace_back(std::span<const std::int64_t>(found ? found->integers : std::vector<std::int64_t>()));
    for (std::size_t row = 0; row < numbers.size(); ++row) {
      rows.values[row * rows.columns + column] =
          found ? found->integers[row] : std::bit_cast<std::int64_t>(numbers[row]);
    }
  }
};

void encode_lattice(const NumberLattice& lattice, RangeEncoder& encoder) {
  encoder.encode_uniform(static_cast<std::uint64_t>(lattice.decimals + kMostDecimals), 2 * kMostDecimals + 1);
  encoder.encode_number(static_cast<std::uint64_t>(lattice.multiple));
}

NumberLattice decode_lattice(RangeDecoder& decoder) {
  NumberLattice lattice;
  lattice.decimals = static_cast<int>(decoder.decode_uniform(2 * kMostDecimals + 1)) - kMostDecimals;
  const std::uint64_t multiple = decoder.decode_number();
  if (multiple < 1 || multiple > std::uint64_t{kMostLatticeInteger}) throw DamagedStream();
  lattice.multiple = static_cast<std::int64_t>(multiple);
  return lattice;
}

constexpr int kShifts = 54;

void encode_range(const CoarseRange& coarse, RangeEncoder& encoder) {
  encoder.encode_uniform(static_cast<std::uint64_t>(coarse.shift), kShifts);
  encoder.encode_uniform(coarse.further, kRangeSteps);
  const bool near_zero = coarse.first >= -kRangeSteps && coarse.first < kRangeSteps;
  encoder.encode_uniform(near_zero ? 1 : 0, 2);
  if (near_zero) {
    encoder.encode_uniform(static_cast<std::uint64_t>(coarse.first + kRangeSteps), 2 * kRangeSteps);
  } else {
    encoder.encode_number(zigzag(coarse.first));
  }
}

CoarseRange decode_range(RangeDecoder& decoder) {
  const auto shift = static_cast<int>(decoder.decode_uniform(kShifts));
  const std::uint64_t further = decoder.decode_uniform(kRangeSteps);
  const bool near_zero = decoder.decode_uniform(2) == 1;
  const std::int64_t first =
      near_zero ? static_cast<std::int64_t>(decoder.decode_uniform(2 * kRangeSteps)) - kRangeSteps
                : unzigzag(decoder.decode_number());
  constexpr std::int64_t kFarthest = kMostLatticeInteger + kRangeSteps;
  if (first < -(kFarthest >> shift) - kRangeSteps || first > (kFarthest >> shift)) throw DamagedStream();
  return CoarseRange(shift, first, further);
}

std::int64_t join_bits(std::uint64_t high, std::uint64_t low) {
  return std::bit_cast<std::int64_t>(high << 32 | low);
}

}  // namespace

void TableEncoder::encode(const NumberTable& table) {
  const TableIntegers integers(table);
  encoder_.encode_number(table.rows());
  encoder_.encode_uniform(table.columns - 1, kMostTableColumns);
  for (std::size_t c = 0; c < table.columns; ++c) {
    const std::optional<NumberLattice>& lattice = integers.lattices[c];
    const ColumnKind kind = !lattice                           ? kBits
                            : c > 0 && lattice == last_[c - 1] ? kLikeColumnBefore
                            : lattice == last_[c]              ? kLikeTableBefore
                                                               : kOwnLattice;
    encoder_.encode_uniform(kind, kColumnKinds);
    if (kind == kOwnLattice) encode_lattice(*lattice, encoder_);
    if (lattice) encode_range(integers.coarse[c], encoder_);
    last_[c] = lattice;
  }
  const std::vector<std::size_t> order = integers.order();
  const bool ordered = integers.on_lattices() && std::is_sorted(order.begin(), order.end()) &&
                       longest_run(integers.rows) <= kMostEqualRows;
  encoder_.encode_uniform(ordered ? 1 : 0, 2);
  const Ranges ranges = integers.ranges();
  if (ordered) {
    PointSetEncoder(integers.rows, ranges, encoder_).encode(0, table.rows());
    return;
  }
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t c = 0; c < table.columns; ++c) {
      const std::int64_t value = integers.rows.at(row, c);
      if (integers.lattices[c]) {
        encoder_.encode_uniform(static_cast<std::uint64_t>(value - ranges[c].low), ranges[c].width());
      } else {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        encoder_.encode_uniform(bits >> 32, std::uint64_t{1} << 32);
        encoder_.encode_uniform(bits & 0xffffffffu, std::uint64_t{1} << 32);
      }
    }
  }
}

NumberTable TableDecoder::decode(std::size_t most_values) {
  const std::uint64_t rows = decoder_.decode_number();
  NumberTable table;
  table.columns = static_cast<std::size_t>(decoder_.decode_uniform(kMostTableColumns)) + 1;
  if (rows >= kMostRows || rows * table.columns > most_values) throw DamagedStream();
  std::vector<std::optional<NumberLattice>> lattices;
  Ranges ranges{};
  for (std::size_t c = 0; c < table.columns; ++c) {
    const auto kind = static_cast<ColumnKind>(decoder_.decode_uniform(kColumnKinds));
    std::optional<NumberLattice> lattice;
    if (kind == kOwnLattice) lattice = decode_lattice(decoder_);
    if (kind == kLikeTableBefore) lattice = last_[c];
    if (kind == kLikeColumnBefore && c > 0) lattice = last_[c - 1];
    if (kind != kBits && !lattice) throw DamagedStream();
    if (lattice) ranges[c] = decode_range(decoder_).range();
    lattices.push_back(last_[c] = lattice);
  }
  const bool ordered = decoder_.decode_uniform(2) == 1;
  if (ordered && std::any_of(lattices.begin(), lattices.end(), [](const auto& l) { return !l; }))
    throw DamagedStream();
  const bool all_equal =
      std::all_of(lattices.begin(), lattices.end(), [](const auto& l) { return l.has_value(); }) &&
      std::all_of(ranges.begin(), ranges.end(), [](const IntegerRange& r) { return r.width() == 1; });
  if (all_equal && rows > kMostEqualRows) throw DamagedStream();
  IntegerRows integers;
  if (ordered)
    integers = PointSetDecoder(table.columns, ranges, decoder_).decode(static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < rows * table.columns; ++i) {
    const std::size_t c = i % table.columns;
    if (!lattices[c]) {
      const std::uint64_t high = decoder_.decode_uniform(std::uint64_t{1} << 32);
      table.values.push_back(
          std::bit_cast<double>(join_bits(high, decoder_.decode_uniform(std::uint64_t{1} << 32))));
      continue;
    }
    const std::int64_t k =
        ordered ? integers.values[i]
                : ranges[c].low + static_cast<std::int64_t>(decoder_.decode_uniform(ranges[c].width()));
    const std::optional<double> number = lattice_number(*lattices[c], k);
    if (!number) throw DamagedStream();
    table.values.push_back(*number);
  }
  return table;
}

std::vector<std::size_t> spatial_order(const NumberTable& table) { return TableIntegers(table).order(); }

}  // namespace astrolith
