#include "synthesis/gabor_surface_noise.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

constexpr double kLargestCell =
    1048576.0;  // 2^20 cells from the origin: floats hold three bits within a cell

// From an impulse to the corner of its support, in units of 1/a.
const double kCornerReach = std::sqrt(2.0 * double{kGaborReach} * double{kGaborReach} +
                                      double{kGaborSlabReach} * double{kGaborSlabReach});

// Sizes of groups of points, in kernel reaches. Impulses and their frames are drawn for a large group, of
// bounded size so that memory is, and handed down to halves of it, each keeping what reaches it: small groups
// waste fewer kernel evaluations on points out of reach.
constexpr double kDrawingReaches = 4.0;
constexpr double kSmallestReaches = 0.4;
constexpr int kSmallestGroup = 16;  // points: a vector of the widest machine

ASTROLITH_SIMD_CLONES void add_impulses(const GaborImpulse* impulses, std::size_t num_impulses,
                                        float amplitude, int n, const float* __restrict x,
                                        const float* __restrict y, const float* __restrict z,
                                        float* __restrict height) {
  for (std::size_t j = 0; j < num_impulses; ++j) {
    const GaborImpulse impulse = impulses[j];
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      height[i] = math::fma(amplitude, gabor_kernel(impulse, x[i], y[i], z[i]), height[i]);
    }
  }
}

// Impulses before their frames are known.
struct Candidates {
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> hash;

  void add(const Vec3f& p, std::uint32_t h) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
    hash.push_back(h);
  }
};

Vec3f point_in_cell(std::uint32_t hash, int cx, int cy, int cz, float cell) {
  return {(static_cast<float>(cx) + unit_float(hash_append(hash, 0))) * cell,
          (static_cast<float>(cy) + unit_float(hash_append(hash, 1))) * cell,
          (static_cast<float>(cz) + unit_float(hash_append(hash, 2))) * cell};
}

struct Frame {
  Vec3f u, v, n;
};

// East, south and outward for a body whose field grows along `inward`; where the normal is within a degree of
// the z axis, x takes the place of east. Any unit vectors do where there is no gradient.
Frame tangent_frame(const Vec3f& inward) {
  const float length = math::sqrt(dot(inward, inward));
  const Vec3f n = length > 1e-18f ? inward * (-1.0f / length) : Vec3f{0.0f, 0.0f, 1.0f};
  const bool polar = n.x * n.x + n.y * n.y < 3e-4f;
  const Vec3f east = polar ? Vec3f{1.0f - n.x * n.x, -n.x * n.y, -n.x * n.z} : Vec3f{-n.y, n.x, 0.0f};
  const Vec3f u = east * (1.0f / math::sqrt(dot(east, east)));
  return {u, cross(u, n), n};
}

// Whether a kernel reaches the box, by the box's extents along the kernel's axes; never wrongly says no.
bool reaches(const GaborImpulse& k, const Vec3d& center, const Vec3d& half) {
  constexpr double kSlack = 1.0 + 1e-3;
  const double dx = center.x - double{k.x}, dy = center.y - double{k.y}, dz = center.z - double{k.z};
  const auto far = [&](double ax, double ay, double az, double reach) {
    const double spread = std::fabs(ax) * half.x + std::fabs(ay) * half.y + std::fabs(az) * half.z;
    return std::fabs(ax * dx + ay * dy + az * dz) > reach * kSlack + spread;
  };
  return !far(double{k.ux}, double{k.uy}, double{k.uz}, double{kGaborReach}) &&
         !far(double{k.vx}, double{k.vy}, double{k.vz}, double{kGaborReach}) &&
         !far(double{k.nx}, double{k.ny}, double{k.nz}, double{kGaborSlabReach});
}

double squared_distance(const Box& box, const Vec3f& p) {
  const auto gap = [](double lo, double hi, double c) { return std::max({lo - c, c - hi, 0.0}); };
  return squared_norm(Vec3d{gap(box.min.x, box.max.x, double{p.x}), gap(box.min.y, box.max.y, double{p.y}),
                            gap(box.min.z, box.max.z, double{p.z})});
}

double longest_side(const Box& box) {
  const Vec3d e = box.extent();
  return std::max({e.x, e.y, e.z});
}

Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

// A copy of the caller's points that may be reordered.
struct GaborSurfaceNoise::Points {
  std::vector<float> x, y, z, height;
  std::vector<int> index;

  double coordinate(int axis, int i) const {
    const std::vector<float>& c = axis == 0 ? x : axis == 1 ? y : z;
    return static_cast<double>(c[static_cast<std::size_t>(i)]);
  }
  void swap(int i, int j) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    for (std::vector<float>* c : {&x, &y, &z, &height}) std::swap((*c)[a], (*c)[b]);
    std::swap(index[a], index[b]);
  }
  Box bounds(int begin, int end) const {
    Box box;
    for (int i = begin; i < end; ++i) box.extend({coordinate(0, i), coordinate(1, i), coordinate(2, i)});
    return box;
  }
  // Moves the points of one half of their box to the front; returns where the others begin, or `begin` when
  // all points are in one place.
  int halve(int begin, int end, const Box& box) {
    const Vec3d e = box.extent(), c = box.center();
    const int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
    const double border = axis == 0 ? c.x : axis == 1 ? c.y : c.z;
    int middle = begin;
    for (int i = begin; i < end; ++i) {
      if (coordinate(axis, i) < border) swap(i, middle++);
    }
    return middle == end ? begin : middle;
  }
};

GaborSurfaceNoise::GaborSurfaceNoise(const GaborLayer& layer, std::uint64_t seed, int layer_index,
                                     const Box& domain)
    : domain_min_(to_float(domain.min)),
      domain_max_(to_float(domain.max)),
      clip_(static_cast<float>(kGaborClip * layer.height_rms)) {
  const double farthest =
      std::max({std::fabs(domain.min.x), std::fabs(domain.min.y), std::fabs(domain.min.z),
                std::fabs(domain.max.x), std::fabs(domain.max.y), std::fabs(domain.max.z)});
  for (GaborBand& band : gabor_bands(layer)) {
    const double a = band.a / layer.pixel_size;
    const double cell = kGaborSpaceCell / a;
    if (!(farthest / cell <= kLargestCell)) continue;
    const double cells_under_kernel = kGaborKernelArea * kGaborSlabThickness / std::pow(kGaborSpaceCell, 3);
    const int count =
        std::max(1, static_cast<int>(std::lround(layer.impulses_per_kernel / cells_under_kernel)));
    // Variance = density K^2/2 (integral of e^2)^2 (integral of W^2): a uniform phase contributes the 1/2.
    const double energy = kGaborProfileEnergy * kGaborProfileEnergy * kGaborSlabEnergy;
    const double density = count / std::pow(kGaborSpaceCell, 3);
    const double amplitude = layer.height_rms * std::sqrt(2.0 * band.variance_share / (density * energy));
    const std::uint32_t band_seed = gabor_band_seed(seed, layer_index, band.bandwidth);
    bands_.push_back({std::move(band), band_seed, static_cast<float>(a), static_cast<float>(cell),
                      static_cast<float>(kCornerReach / a), count, static_cast<float>(amplitude)});
  }
}

void GaborSurfaceNoise::evaluate(const PreparedMetaballs& body, int n, const float* x, const float* y,
                                 const float* z, float* height) const {
  Points points;
  const auto clamped = [n](const float* c, float low, float high) {
    std::vector<float> copy(c, c + n);
    for (float& v : copy) v = math::clamp(v, low, high);
    return copy;
  };
  points.x = clamped(x, domain_min_.x, domain_max_.x);
  points.y = clamped(y, domain_min_.y, domain_max_.y);
  points.z = clamped(z, domain_min_.z, domain_max_.z);
  points.height.assign(static_cast<std::size_t>(n), 0.0f);
  for (int i = 0; i < n; ++i) points.index.push_back(i);
  for (const Band& band : bands_) add_band(band, body, points, 0, n);
  for (std::size_t i = 0; i < points.index.size(); ++i) {
    height[points.index[i]] = math::clamp(points.height[i], -clip_, clip_);
  }
}

namespace {

// Impulses of the cells around the box, in the order of the cells, whose supports may touch it.
template <typename Band>
Candidates draw_candidates(const Band& band, const Box& box) {
  Candidates found;
  const double reach = double{band.reach} * (1.0 + 1e-3), cell = band.cell;
  const auto cell_of = [cell](double c) { return static_cast<int>(std::floor(c / cell)); };
  for (int cz = cell_of(box.min.z - reach); cz <= cell_of(box.max.z + reach); ++cz) {
    for (int cy = cell_of(box.min.y - reach); cy <= cell_of(box.max.y + reach); ++cy) {
      for (int cx = cell_of(box.min.x - reach); cx <= cell_of(box.max.x + reach); ++cx) {
        const std::uint32_t cell_hash = hash_cell(band.seed, cx, cy, cz);
        for (int j = 0; j < band.impulses_per_cell; ++j) {
          const std::uint32_t hash = hash_append(cell_hash, static_cast<std::uint32_t>(j));
          const Vec3f p = point_in_cell(hash, cx, cy, cz, band.cell);
          if (squared_distance(box, p) <= reach * reach) found.add(p, hash);
        }
      }
    }
  }
  return found;
}

template <typename Band>
GaborImpulse make_impulse(const Band& band, const Vec3f& p, const Vec3f& inward, std::uint32_t hash) {
  const Frame f = tangent_frame(inward);
  const GaborBand::Lobe& lobe = band.band.draw(unit_float(hash_append(hash, 4)));
  const float a = band.a;
  return {p.x,
          p.y,
          p.z,
          a * f.u.x,
          a * f.u.y,
          a * f.u.z,
          a * f.v.x,
          a * f.v.y,
          a * f.v.z,
          a * f.n.x,
          a * f.n.y,
          a * f.n.z,
          lobe.frequency_x,
          lobe.frequency_y,
          unit_float(hash_append(hash, 3))};
}

// All impulses that reach the box, in the order of their cells.
template <typename Band>
std::vector<GaborImpulse> draw_impulses(const Band& band, const PreparedMetaballs& body, const Box& box) {
  const Candidates found = draw_candidates(band, box);
  const auto n = found.x.size();
  Box around;
  for (std::size_t i = 0; i < n; ++i) {
    around.extend({double{found.x[i]}, double{found.y[i]}, double{found.z[i]}});
  }
  std::vector<float> distance(n), gx(n), gy(n), gz(n);
  evaluate_metaballs(metaballs_reaching(body, around), static_cast<int>(n), found.x.data(), found.y.data(),
                     found.z.data(), distance.data(), gx.data(), gy.data(), gz.data());
  std::vector<GaborImpulse> impulses;
  impulses.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    impulses.push_back(
        make_impulse(band, {found.x[i], found.y[i], found.z[i]}, {gx[i], gy[i], gz[i]}, found.hash[i]));
  }
  return impulses;
}

std::vector<GaborImpulse> reaching(const std::vector<GaborImpulse>& impulses, const Box& box) {
  const Vec3d center = box.center(), half = 0.5 * box.extent();
  std::vector<GaborImpulse> kept;
  for (const GaborImpulse& impulse : impulses) {
    if (reaches(impulse, center, half)) kept.push_back(impulse);
  }
  return kept;
}

}  // namespace

void GaborSurfaceNoise::add_band(const Band& band, const PreparedMetaballs& body, Points& points, int begin,
                                 int end) const {
  if (begin == end) return;
  const Box box = points.bounds(begin, end);
  const int middle =
      longest_side(box) > kDrawingReaches * double{band.reach} ? points.halve(begin, end, box) : begin;
  if (middle == begin) {
    add_group(band, draw_impulses(band, body, box), points, begin, end);
  } else {
    add_band(band, body, points, begin, middle);
    add_band(band, body, points, middle, end);
  }
}

void GaborSurfaceNoise::add_group(const Band& band, const std::vector<GaborImpulse>& impulses, Points& points,
                                  int begin, int end) const {
  const Box box = points.bounds(begin, end);
  const std::vector<GaborImpulse> near = reaching(impulses, box);
  const bool divisible =
      end - begin > kSmallestGroup && longest_side(box) > kSmallestReaches * double{band.reach};
  const int middle = divisible ? points.halve(begin, end, box) : begin;
  if (middle == begin) {
    const auto first = static_cast<std::size_t>(begin);
    add_impulses(near.data(), near.size(), band.amplitude, end - begin, &points.x[first], &points.y[first],
                 &points.z[first], &points.height[first]);
  } else {
    add_group(band, near, points, begin, middle);
    add_group(band, near, points, middle, end);
  }
}

}  // namespace astrolith
