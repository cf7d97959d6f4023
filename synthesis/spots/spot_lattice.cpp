#include "synthesis/spots/spot_lattice.h"

#include <algorithm>
#include <cmath>

#include "numerics/portable_double.h"

namespace astrolith {
namespace {

// The thresholds of Poisson counts: a share P(count <= l) of the hashes is below the l-th threshold. The list
// ends where a share of 2^-32 is left.
std::vector<std::uint32_t> poisson_thresholds(double mean) {
  std::vector<std::uint32_t> thresholds;
  double probability = portable::exp(-mean), sum = probability;
  for (int l = 1; sum < 1.0 - 0x1p-32 && l < 1000; ++l) {
    thresholds.push_back(static_cast<std::uint32_t>(std::min(sum * 0x1p32, 0x1p32 - 1.0)));
    probability *= mean / l;
    if (l > mean && probability < 0x1p-33) break;
    sum += probability;
  }
  return thresholds;
}

// The thresholds of equal counts: each cell has floor(mean) impulses, and one more with the probability mean
// - floor(mean).
std::vector<std::uint32_t> even_thresholds(double mean) {
  std::vector<std::uint32_t> thresholds(static_cast<std::size_t>(mean), 0);
  const double more = (mean - std::floor(mean)) * 0x1p32;
  if (more >= 1.0) thresholds.push_back(static_cast<std::uint32_t>(0x1p32 - more));
  return thresholds;
}

// One row of the inverse matrix of the edges: its product is 1 with `edge`, and 0 with the other two.
Vec3d across(const Vec3d& edge, const Vec3d& other, const Vec3d& another) {
  const Vec3d normal = cross(other, another);
  return normal * (1.0 / dot(edge, normal));
}

}  // namespace

SpotLattice make_spot_lattice(const SpotLayer& layer, double cell_size, double density, std::uint32_t seed,
                              std::vector<std::uint32_t>& thresholds) {
  const Vec3d a = cell_size * layer.lattice.a, b = cell_size * layer.lattice.b,
              c = cell_size * layer.lattice.c;
  const std::vector<std::uint32_t> least =
      layer.even ? even_thresholds(density) : poisson_thresholds(density);
  const auto first = static_cast<std::uint32_t>(thresholds.size());
  thresholds.insert(thresholds.end(), least.begin(), least.end());
  return {to_float(a),
          to_float(b),
          to_float(c),
          {across(a, b, c), across(b, c, a), across(c, a, b)},
          seed,
          layer.probability,
          density,
          layer.reach + 1e-3,
          1.0f + 2.0f * static_cast<float>(layer.reach),
          static_cast<float>(layer.least_weight),
          first,
          static_cast<std::uint32_t>(least.size())};
}

}  // namespace astrolith
