#include "synthesis/noise/lattice_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace astrolith {
namespace {

// chi^2 of the joint histogram of four bits at neighbouring lattice points, minus its mean, in its standard
// deviations.
template <typename Hash>
double neighbour_dependence(const Hash& hash, int dx, int dy, int dz, int shift) {
  std::array<double, 256> count{};
  constexpr std::uint32_t kSide = 32;
  const std::uint32_t step = static_cast<std::uint32_t>(dx) * kLatticeX +
                             static_cast<std::uint32_t>(dy) * kLatticeY +
                             static_cast<std::uint32_t>(dz) * kLatticeZ;
  for (std::uint32_t i = 0; i < kSide * kSide * kSide; ++i) {
    const std::uint32_t point =
        99u + (i % kSide) * kLatticeX + (i / kSide % kSide) * kLatticeY + i / (kSide * kSide) * kLatticeZ;
    ++count[(hash(point) >> shift & 15) * 16 + (hash(point + step) >> shift & 15)];
  }
  const double expected = kSide * kSide * kSide / 256.0;
  double chi_squared = 0.0;
  for (const double c : count) chi_squared += (c - expected) * (c - expected) / expected;
  return (chi_squared - 255.0) / std::sqrt(2.0 * 255.0);
}

template <typename Hash>
double worst_dependence(const Hash& hash, int shift) {
  double worst = 0.0;
  for (int d = 0; d < 125; ++d) {
    if (d == 62) continue;  // the point itself
    worst = std::max(worst, neighbour_dependence(hash, d % 5 - 2, d / 5 % 5 - 2, d / 25 - 2, shift));
  }
  return worst;
}

TEST(LatticeNoise, NeighboursHashesAreIndependent) {
  EXPECT_LT(worst_dependence(lattice_hash, 28), 5.0);
  EXPECT_LT(worst_dependence(short_lattice_hash, 28), 5.0);
  // The bit fields of the three coordinates of a feature point: bits 9 to 31, 0 to 22 and 0 to 12.
  const auto mixed = [](std::uint32_t point) {
    const std::uint32_t h = short_lattice_hash(point);
    return h ^ (h >> 15);
  };
  for (const int shift : {28, 19, 9}) EXPECT_LT(worst_dependence(mixed, shift), 5.0) << shift;
}

TEST(LatticeNoise, GradientsAreTheTwelveEdgesOfACube) {
  for (std::uint32_t g = 0; g < 16; ++g) {
    const Vec3f v = gradient_of(g << 28);
    EXPECT_EQ(dot(v, v), 2.0f);
    EXPECT_EQ(std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z), 2.0f);
    EXPECT_EQ(gradient_product(g << 28, 0.5f, -3.0f, 8.0f), 0.5f * v.x - 3.0f * v.y + 8.0f * v.z);
  }
}

}  // namespace
}  // namespace astrolith
