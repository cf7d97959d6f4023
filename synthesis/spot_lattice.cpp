#include "synthesis/spot_lattice.h"

#include <algorithm>
#include <cmath>

namespace astrolith {
namespace {

// For l = 0, 1, ..: the share of hashes below P(count <= l), as an integer threshold; up to where 2^-32 ends.
std::vector<std::uint32_t> poisson_thresholds(double mean) {
  std::vector<std::uint32_t> thresholds;
  double probability = std::exp(-mean), sum = probability;
  for (int l = 1; sum < 1.0 - 0x1p-32 && l < 1000; ++l) {
    thresholds.push_back(static_cast<std::uint32_t>(std::min(sum * 0x1p32, 0x1p32 - 1.0)));
    probability *= mean / l;
    if (l > mean && probability < 0x1p-33) break;
    sum += probability;
  }
  return thresholds;
}

// As many in each cell; of a fraction one more by chance.
std::vector<std::uint32_t> even_thresholds(double mean) {
  std::vector<std::uint32_t> thresholds(static_cast<std::size_t>(mean), 0);
  const double more = (mean - std::floor(mean)) * 0x1p32;
  if (more >= 1.0) thresholds.push_back(static_cast<std::uint32_t>(0x1p32 - more));
  return thresholds;
}

Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// The row of an inverse: zero along the other two edges, 1 along this.
Vec3d across(const Vec3d& edge, const Vec3d& other, const Vec3d& another) {
  const Vec3d normal = cross(other, another);
  return normal * (1.0 / dot(edge, normal));
}

}  // namespace

SpotLattice::SpotLattice(const SpotLayer& layer, double cell_size, double density, std::uint32_t seed)
    : a_(to_float(cell_size * layer.lattice.a)),
      b_(to_float(cell_size * layer.lattice.b)),
      c_(to_float(cell_size * layer.lattice.c)),
      seed_(seed),
      probability_(layer.probability),
      reach_(layer.reach + 1e-3),
      width_(1.0f + 2.0f * static_cast<float>(layer.reach)),
      least_weight_(static_cast<float>(layer.least_weight)),
      least_(layer.even ? even_thresholds(density) : poisson_thresholds(density)) {
  const Vec3d a = cell_size * layer.lattice.a, b = cell_size * layer.lattice.b,
              c = cell_size * layer.lattice.c;
  cells_per_ = {across(a, b, c), across(b, c, a), across(c, a, b)};
}

double SpotLattice::Cells::count() const {
  double product = 1.0;
  for (std::size_t i = 0; i < 3; ++i) product *= double(last[i]) - first[i] + 1;
  return product;
}

SpotLattice::Cells SpotLattice::around(const Box& box) const {
  Cells cells;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d& per = cells_per_[i];
    const auto lower = [](double k, double low, double high) { return k * (k > 0.0 ? low : high); };
    const double low = lower(per.x, box.min.x, box.max.x) + lower(per.y, box.min.y, box.max.y) +
                       lower(per.z, box.min.z, box.max.z);
    const double high = lower(per.x, box.max.x, box.min.x) + lower(per.y, box.max.y, box.min.y) +
                        lower(per.z, box.max.z, box.min.z);
    cells.first[i] = static_cast<int>(std::floor(low - reach_));
    cells.last[i] = static_cast<int>(std::floor(high + reach_));
  }
  return cells;
}

}  // namespace astrolith
