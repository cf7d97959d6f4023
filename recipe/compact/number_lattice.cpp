#include "recipe/compact/number_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string_view>

namespace astrolith {
namespace {

constexpr double kPowersOfTen[kMostDecimals + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                    1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                    1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

// integer / 10^decimals
struct Decimal {
  std::int64_t integer = 0;
  int decimals = 0;
};

// The shortest decimal of a number other than 0. It has at most 17 digits.
Decimal shortest_decimal(double number) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, number, std::chars_format::scientific);
  const std::string_view all(text, static_cast<std::size_t>(end.ptr - text));
  const std::size_t exponent_at = all.find('e');
  Decimal decimal;
  bool fraction = false;
  for (const char c : all.substr(0, exponent_at)) {
    if (c == '.') fraction = true;
    if (c < '0' || c > '9') continue;
    decimal.integer = 10 * decimal.integer + (c - '0');
    if (fraction) ++decimal.decimals;
  }
  if (all.front() == '-') decimal.integer = -decimal.integer;
  const std::size_t digits_at = exponent_at + (all[exponent_at + 1] == '+' ? 2 : 1);
  int exponent = 0;
  std::from_chars(all.data() + digits_at, end.ptr, exponent);
  decimal.decimals -= exponent;
  return decimal;
}

std::optional<double> decimal_number(std::int64_t integer, int decimals) {
  if (integer > kMostLatticeInteger || integer < -kMostLatticeInteger) return std::nullopt;
  const auto exact = static_cast<double>(integer);
  return decimals >= 0 ? exact / kPowersOfTen[decimals] : exact * kPowersOfTen[-decimals];
}

// The decimal's integer with so many decimals, or nothing if it is beyond the limits.
std::optional<std::int64_t> with_decimals(Decimal decimal, int decimals) {
  for (; decimal.decimals < decimals && decimal.integer != 0; ++decimal.decimals) {
    if (std::abs(decimal.integer) > kMostLatticeInteger) return std::nullopt;
    decimal.integer *= 10;
  }
  if (std::abs(decimal.integer) > kMostLatticeInteger) return std::nullopt;
  return decimal.integer;
}

}  // namespace

std::optional<LatticeNumbers> find_lattice(std::span<const double> numbers) {
  std::vector<Decimal> written;
  int decimals = -kMostDecimals;
  bool all_zero = true;
  for (const double number : numbers) {
    if (!std::isfinite(number) || (number == 0.0 && std::signbit(number))) return std::nullopt;
    written.push_back(number == 0.0 ? Decimal{} : shortest_decimal(number));
    if (number == 0.0) continue;
    decimals = std::max(decimals, written.back().decimals);
    all_zero = false;
  }
  if (all_zero) decimals = 0;
  if (decimals > kMostDecimals) return std::nullopt;
  LatticeNumbers found{{decimals, 0}, {}};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::optional<std::int64_t> integer = with_decimals(written[i], decimals);
    if (!integer || decimal_number(*integer, decimals) != numbers[i]) return std::nullopt;
    found.integers.push_back(*integer);
    found.lattice.multiple = std::gcd(found.lattice.multiple, *integer);
  }
  found.lattice.multiple = std::max<std::int64_t>(found.lattice.multiple, 1);
  for (std::int64_t& k : found.integers) k /= found.lattice.multiple;
  return found;
}

std::optional<double> lattice_number(const NumberLattice& lattice, std::int64_t k) {
  if (k != 0 && std::abs(k) > kMostLatticeInteger / lattice.multiple) return std::nullopt;
  return decimal_number(k * lattice.multiple, lattice.decimals);
}

}  // namespace astrolith
