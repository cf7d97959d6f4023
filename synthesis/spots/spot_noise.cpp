#include "synthesis/spots/spot_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>

#include "numerics/hash_random.h"
#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"
#include "synthesis/noise/points_in_domain.h"

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

// The lattice of a layer, scaled so that an edge of length 1 becomes `cell_size` length units long. An
// occupied cell holds `density` impulses on average. Appends the thresholds of the lattice to `thresholds`.
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

constexpr double kSpotClip = 2.0;  // limit of a sum of overlapping spots, in units of the greatest kernel
constexpr double kDegree = std::numbers::pi / 180.0;

ASTROLITH_SIMD_CLONES void add_spots(const SpotKernel& spot_kernel, const SpotImpulse* impulses,
                                     std::size_t num_impulses, int n, const float* __restrict x,
                                     const float* __restrict y, const float* __restrict z,
                                     float* __restrict height) {
  const SpotKernel kernel = spot_kernel;
  for (std::size_t j = 0; j < num_impulses; ++j) {
    const SpotImpulse impulse = impulses[j];
#pragma omp simd
    for (int i = 0; i < n; ++i) height[i] += spot_height(kernel, impulse, x[i], y[i], z[i]);
  }
}

std::vector<SpotImpulse> impulses_reaching(const std::vector<SpotImpulse>& impulses, const Vec3d& half,
                                           const Box& box) {
  const Box wide = spot_box(box);
  std::vector<SpotImpulse> found;
  std::copy_if(impulses.begin(), impulses.end(), std::back_inserter(found),
               [&](const SpotImpulse& impulse) { return spot_reaches(impulse, half, wide); });
  return found;
}

// A rotation by the angles of a part of a spot, in degrees about x, then y, then z.
using Rotation = std::array<Vec3d, 3>;  // columns

Rotation rotation(const Vec3d& degrees) {
  const auto turned = [](double angle, double& u, double& v) {
    const double c = portable::cos(angle * kDegree), s = portable::sin(angle * kDegree);
    std::tie(u, v) = std::pair{c * u - s * v, s * u + c * v};
  };
  Rotation columns{Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (Vec3d& p : columns) {
    if (degrees.x != 0.0) turned(degrees.x, p.y, p.z);
    if (degrees.y != 0.0) turned(degrees.y, p.z, p.x);
    if (degrees.z != 0.0) turned(degrees.z, p.x, p.y);
  }
  return columns;
}

SpotKernel make_kernel(const SpotLayer& layer, const SpotPart& part, const Rotation& r, double unit,
                       double amplitude) {
  const auto scaled = [&](double c, double axis) { return static_cast<float>(c / (axis * unit)); };
  const Vec3d &a = part.axes, &v = layer.variances;
  return {scaled(r[0].x, a.x),
          scaled(r[0].y, a.x),
          scaled(r[0].z, a.x),
          scaled(r[1].x, a.y),
          scaled(r[1].y, a.y),
          scaled(r[1].z, a.y),
          scaled(r[2].x, a.z),
          scaled(r[2].y, a.z),
          scaled(r[2].z, a.z),
          static_cast<float>(part.weight * amplitude * layer.gaussian),
          static_cast<float>(layer.alpha),
          static_cast<float>(part.weight * amplitude * layer.kappa),
          static_cast<float>(layer.beta),
          static_cast<float>(layer.gamma),
          static_cast<float>(1.0 / v.x),
          static_cast<float>(1.0 / v.y),
          static_cast<float>(1.0 / v.z),
          static_cast<float>(layer.sigma)};
}

// Half the sides, in length units, of the box around the ellipsoid q.V^-1 q = sigma of a part.
Vec3d spot_support(const SpotLayer& layer, const SpotPart& part, const Rotation& r, double unit) {
  const Vec3d &a = part.axes, &v = layer.variances;
  const auto side = [&](double x, double y, double z) {
    return std::sqrt(v.x * (a.x * x) * (a.x * x) + v.y * (a.y * y) * (a.y * y) + v.z * (a.z * z) * (a.z * z));
  };
  return unit * std::sqrt(layer.sigma) * (1.0 + kSpotSlack) *
         Vec3d{side(r[0].x, r[1].x, r[2].x), side(r[0].y, r[1].y, r[2].y), side(r[0].z, r[1].z, r[2].z)};
}

// One part of the spots of one size: `unit` length units long and `amplitude` high.
SpotKind make_kind(const SpotLayer& layer, const SpotPart& part, const SpotLattice& lattice, double unit,
                   double amplitude, double clip) {
  const Rotation turn = rotation(part.turn);
  return {make_kernel(layer, part, turn, unit, amplitude), lattice, unit * part.center,
          spot_support(layer, part, turn, unit), static_cast<float>(clip)};
}

double clip_level(const SpotLayer& layer, const SpotPart& part, double amplitude) {
  return kSpotClip * std::fabs(part.weight * amplitude) *
         (std::fabs(layer.gaussian) + std::fabs(layer.kappa));
}

// Counts the cells of a lattice from the one that holds the origin of a frame. Returns the vector from the
// origin to that cell, length units.
Vec3d count_cells_from(const Vec3d& origin, SpotLattice& lattice) {
  const Vec3d* per = lattice.cells_per;
  const OriginCell cell = origin_cell({dot(per[0], origin), dot(per[1], origin), dot(per[2], origin)});
  lattice.first_cell[0] = cell.x;
  lattice.first_cell[1] = cell.y;
  lattice.first_cell[2] = cell.z;
  const auto along = [&](const Vec3f& edge, double cells) {
    return Vec3d{cells * double{edge.x}, cells * double{edge.y}, cells * double{edge.z}};
  };
  return -1.0 *
         (along(lattice.a, cell.rest.x) + along(lattice.b, cell.rest.y) + along(lattice.c, cell.rest.z));
}

// The share of the variance of the sizes from number `kept` on. The variance of a size goes as the square of
// its amplitude and as its number of spots in a cell.
double share_left_out(const SpotLayer& layer, int kept) {
  double left = 0.0, total = 0.0;
  for (int j = 0; j < layer.layers; ++j) {
    const double density = portable::pow(layer.lacunarity, j * (layer.exponent - 2.0));
    const double power = portable::whole_power(layer.gain * layer.gain, j) * density;
    total += power;
    if (j >= kept) left += power;
  }
  return left / total;
}

// The narrowest cell or axis of a spot, length units.
double finest_length(const SpotLayer& layer, std::span<const SpotPart> parts) {
  const Vec3d& v = layer.variances;
  double finest = layer.cell_size * least_height(layer.lattice);
  for (const SpotPart& part : parts) {
    const Vec3d& a = part.axes;
    const double cut = std::sqrt(layer.sigma * std::min({v.x, v.y, v.z}));
    finest = std::min(finest, layer.size * std::min({a.x, a.y, a.z}) * std::min(cut, 1.0));
  }
  return finest / portable::whole_power(layer.lacunarity, layer.layers - 1);
}

Box bounding_box(int n, const float* x, const float* y, const float* z) {
  Box box;
  for (int i = 0; i < n; ++i) box.extend({x[i], y[i], z[i]});
  return box;
}

// So few points or impulses are not split any more.
constexpr int kFewPoints = 16;
constexpr std::size_t kFewImpulses = 64;

// Adds the sum of one kind's spots to the heights at n points. `impulses` hold all whose spots reach them.
// The points are split into halves while many impulses reach some of them only. An impulse that does not
// reach a point would add exactly 0 there.
void add_reaching(const SpotKind& kind, const std::vector<SpotImpulse>& impulses, int n, const float* x,
                  const float* y, const float* z, float* height) {
  if (n <= kFewPoints || impulses.size() <= kFewImpulses) {
    add_spots(kind.kernel, impulses.data(), impulses.size(), n, x, y, z, height);
    return;
  }
  const int half = n / 2;
  for (const auto& [first, count] : {std::pair{0, half}, {half, n - half}}) {
    const Box box = bounding_box(count, x + first, y + first, z + first);
    add_reaching(kind, impulses_reaching(impulses, kind.support, box), count, x + first, y + first, z + first,
                 height + first);
  }
}

// Draws the impulses and adds the sum of one kind's spots to the heights at n points. The points are split
// into halves while too many lie around them, or more cells than around each point by itself.
void draw_and_add(const SpotKind& kind, const std::uint32_t* thresholds, int n, const float* x,
                  const float* y, const float* z, float* height) {
  const Box box = bounding_box(n, x, y, z);
  const double cells = spot_cells_around(kind, box).count();
  if (n > 1 &&
      (too_many_spots(kind, box) || cells > n * spot_cells_around(kind, bounding_box(1, x, y, z)).count())) {
    const int half = n / 2;
    draw_and_add(kind, thresholds, half, x, y, z, height);
    draw_and_add(kind, thresholds, n - half, x + half, y + half, z + half, height + half);
    return;
  }
  add_reaching(kind, draw_spots(kind, thresholds, box), n, x, y, z, height);
}

}  // namespace

SpotNoise make_noise(const SpotLayer& layer, std::uint64_t seed, int layer_index, const NoiseFrame& frame,
                     ArrayStore& arrays) {
  SpotNoise noise;
  noise.low = to_float(frame.domain.min);
  noise.high = to_float(frame.domain.max);
  std::vector<SpotKind> kinds;
  std::vector<std::uint32_t> thresholds;
  const std::vector<SpotPart> parts = layer.parts.empty() ? std::vector<SpotPart>(1) : layer.parts;
  const std::uint32_t layer_seed = hash_seed(seed, static_cast<std::uint32_t>(layer_index));
  int sizes = 0;
  for (int j = 0; j < layer.layers; ++j) {
    const double shrink = portable::whole_power(layer.lacunarity, j);
    const double cell = layer.cell_size / shrink, unit = layer.size / shrink;
    if (!(frame.farthest() / (cell * least_height(layer.lattice)) <= kLargestCell)) break;
    SpotLattice lattice =
        make_spot_lattice(layer, cell, layer.density * portable::pow(shrink, layer.exponent - 2.0),
                          hash_append(layer_seed, static_cast<std::uint32_t>(j)), thresholds);
    const Vec3d first = count_cells_from(frame.origin, lattice);
    ++sizes;
    const double amplitude =
        (layer.inverted ? 1.0 : -1.0) * layer.amplitude * portable::whole_power(layer.gain, j);
    for (const SpotPart& part : parts) {
      const double clip = clip_level(layer, part, amplitude);
      kinds.push_back(make_kind(layer, part, lattice, unit, amplitude, clip));
      kinds.back().offset += first;
      noise.height_bound += clip * (1.0 + kSpotSlack);
    }
  }
  noise.detail = {finest_length(layer, parts), share_left_out(layer, sizes)};
  noise.kinds = arrays.add(kinds);
  noise.thresholds = arrays.add(thresholds);
  return noise;
}

std::vector<SpotImpulse> draw_spots(const SpotKind& kind, const std::uint32_t* thresholds, const Box& box) {
  std::vector<SpotImpulse> impulses;
  for_each_spot(kind, thresholds, box, [&](const SpotImpulse& impulse) { impulses.push_back(impulse); });
  return impulses;
}

double count_cells(const SpotNoise& noise, const ArrayView& arrays, double side) {
  double cells = 0.0;
  for (const SpotKind& kind : arrays.span(noise.kinds))
    cells += spot_cells_around(kind, {{}, {side, side, side}}).count();
  return cells;
}

double draws_at_a_point(const SpotNoise& noise, const ArrayView& arrays) {
  double draws = 0.0;
  for (const SpotKind& kind : arrays.span(noise.kinds)) {
    const Vec3d& half = kind.support;
    double cells = 1.0;
    for (const Vec3d& per : kind.lattice.cells_per) {
      const double reach = std::fabs(per.x) * half.x + std::fabs(per.y) * half.y + std::fabs(per.z) * half.z;
      cells *= 2.0 * (reach + double{kind.lattice.reach}) + 1.0;
    }
    draws += cells * (1.0 + kind.lattice.probability * kind.lattice.density);
  }
  return draws;
}

std::shared_ptr<const SpotImpulses> gather_spots(const SpotNoise& noise, const ArrayView& arrays,
                                                 const Box& box, const SpotImpulses* larger_box_impulses) {
  const Box moved = moved_into(box, noise.low, noise.high);
  const std::span<const SpotKind> kinds = arrays.span(noise.kinds);
  const auto too_many = [&](const SpotKind& kind) { return too_many_spots(kind, moved); };
  if (larger_box_impulses == nullptr && std::any_of(kinds.begin(), kinds.end(), too_many)) return nullptr;
  auto impulses = std::make_shared<SpotImpulses>();
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    impulses->push_back(larger_box_impulses != nullptr
                            ? impulses_reaching((*larger_box_impulses)[k], kinds[k].support, moved)
                            : draw_spots(kinds[k], arrays[noise.thresholds], moved));
  }
  return impulses;
}

void evaluate_heights(const SpotNoise& noise, const ArrayView& arrays, int n, const float* x, const float* y,
                      const float* z, float* height, const SpotImpulses* impulses) {
  const PointsInDomain p(noise.low, noise.high, n, x, y, z);
  const Box box = p.box();
  const std::span<const SpotKind> kinds = arrays.span(noise.kinds);
  std::vector<float> sum(static_cast<std::size_t>(n));
  std::fill(height, height + n, 0.0f);
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const SpotKind& kind = kinds[k];
    std::fill(sum.begin(), sum.end(), 0.0f);
    if (impulses == nullptr) {
      draw_and_add(kind, arrays[noise.thresholds], n, p.x(), p.y(), p.z(), sum.data());
    } else {
      add_reaching(kind, impulses_reaching((*impulses)[k], kind.support, box), n, p.x(), p.y(), p.z(),
                   sum.data());
    }
    for (int i = 0; i < n; ++i)
      height[i] += math::clamp(sum[static_cast<std::size_t>(i)], -kind.clip, kind.clip);
  }
}

Interval bound_heights(const SpotNoise& noise, const ArrayView& arrays, const Box& box,
                       const SpotImpulses* impulses) {
  if (impulses == nullptr) return bound_heights(noise, arrays, box);
  const Box moved = moved_into(box, noise.low, noise.high);
  const std::span<const SpotKind> kinds = arrays.span(noise.kinds);
  const double slack = 3.0 * kSpotSlack * noise.height_bound;
  Interval sum{-slack, slack};
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    SpotSumBound bound{kinds[k], moved};
    for (const SpotImpulse& impulse : (*impulses)[k]) bound.add(impulse);
    sum = plus(sum, bound.clipped());
  }
  return sum;
}

}  // namespace astrolith
