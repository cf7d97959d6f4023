#include "synthesis/exemplar/plane_waves.h"

#include <cstddef>
#include <numbers>
#include <utility>

#include "numerics/portable_angles.h"

namespace astrolith {
namespace {

using Complex = std::complex<double>;

// exp(2 pi i k / side) for k below side / 2.
std::vector<Complex> roots_of_unity(std::size_t side) {
  std::vector<Complex> roots;
  for (std::size_t k = 0; k < side / 2; ++k) {
    const portable::SineCosine turn = portable::sine_and_cosine(
        2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(side));
    roots.emplace_back(turn.cosine, turn.sine);
  }
  return roots;
}

// A product without the checks for infinities of operator*.
Complex times(const Complex& a, const Complex& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

// Moves each value to the place whose number has the bits in reverse order.
void reverse_bits(std::vector<Complex>& line) {
  const std::size_t n = line.size();
  std::size_t to = 0;
  for (std::size_t from = 0; from + 1 < n; ++from) {
    if (from < to) std::swap(line[from], line[to]);
    std::size_t bit = n / 2;
    while ((to & bit) != 0) to ^= bit, bit /= 2;
    to |= bit;
  }
}

// The series along one line (Cooley and Tukey).
void sum_waves(const std::vector<Complex>& roots, std::vector<Complex>& line) {
  reverse_bits(line);
  const std::size_t n = line.size();
  for (std::size_t half = 1; half < n; half *= 2) {
    const std::size_t stride = n / (2 * half);
    for (std::size_t begin = 0; begin < n; begin += 2 * half) {
      for (std::size_t k = 0; k < half; ++k) {
        const Complex even = line[begin + k], odd = times(roots[k * stride], line[begin + half + k]);
        line[begin + k] = even + odd;
        line[begin + half + k] = even - odd;
      }
    }
  }
}

}  // namespace

void sum_plane_waves(int side, std::vector<Complex>& values) {
  const auto n = static_cast<std::size_t>(side);
  const std::vector<Complex> roots = roots_of_unity(n);
  std::vector<Complex> line(n);
  for (std::size_t y = 0; y < n; ++y) {
    for (std::size_t x = 0; x < n; ++x) line[x] = values[y * n + x];
    sum_waves(roots, line);
    for (std::size_t x = 0; x < n; ++x) values[y * n + x] = line[x];
  }
  for (std::size_t x = 0; x < n; ++x) {
    for (std::size_t y = 0; y < n; ++y) line[y] = values[y * n + x];
    sum_waves(roots, line);
    for (std::size_t y = 0; y < n; ++y) values[y * n + x] = line[y];
  }
}

}  // namespace astrolith
