#include "synthesis/gabor_impulses.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

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

Vec3f cell_center(const std::array<int, 3>& c, float cell) {
  return {(static_cast<float>(c[0]) + 0.5f) * cell, (static_cast<float>(c[1]) + 0.5f) * cell,
          (static_cast<float>(c[2]) + 0.5f) * cell};
}

// Ten bits of a hash place an impulse along each axis, to a thousandth of a cell.
Vec3f point_in_cell(std::uint32_t hash, const std::array<int, 3>& c, float cell) {
  const auto at = [&](std::size_t axis, int shift) {
    const std::uint32_t bits = (hash >> shift) & 1023u;
    return (static_cast<float>(c[axis]) + (static_cast<float>(bits) + 0.5f) * 0x1p-10f) * cell;
  };
  return {at(0, 2), at(1, 12), at(2, 22)};
}

GaborImpulse make_impulse(const SurfaceBand& band, const Vec3f& p, const Frame& f, std::uint32_t hash) {
  // Sixteen bits choose the lobe, sixteen the phase.
  const std::uint32_t bits = hash_append(hash, 0);
  const GaborBand::Lobe& lobe = band.band.draw(static_cast<float>(bits >> 16) * 0x1p-16f);
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
          static_cast<float>(bits & 0xffffu) * 0x1p-16f};
}

// The cells of a box widened by `reach` and some slack for rounding.
CellRange cells_within(const Box& box, const Vec3d& reach, double cell) {
  constexpr double kSlack = 1.0 + 1e-3;
  const auto cell_of = [cell](double c) { return static_cast<int>(std::floor(c / cell)); };
  return {{cell_of(box.min.x - kSlack * reach.x), cell_of(box.min.y - kSlack * reach.y),
           cell_of(box.min.z - kSlack * reach.z)},
          {cell_of(box.max.x + kSlack * reach.x), cell_of(box.max.y + kSlack * reach.y),
           cell_of(box.max.z + kSlack * reach.z)}};
}

CellRange common(CellRange a, const CellRange& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    a.first[axis] = std::max(a.first[axis], b.first[axis]);
    a.last[axis] = std::min(a.last[axis], b.last[axis]);
  }
  return a;
}

// Half the extents along x, y and z of a kernel's support, a box along its frame.
Vec3d half_extents(const GaborImpulse& k, double a) {
  const auto along = [a](float u, float v, float n) {
    const double tangential = std::fabs(double{u}) + std::fabs(double{v});
    return (double{kGaborReach} * tangential + double{kGaborSlabReach} * std::fabs(double{n})) / (a * a);
  };
  return {along(k.ux, k.vx, k.nx), along(k.uy, k.vy, k.ny), along(k.uz, k.vz, k.nz)};
}

// The impulses of one cell, whose centre is `height` outside the surface.
void draw_cell(const SurfaceBand& band, const std::array<int, 3>& c, float height, const Vec3f& inward,
               std::vector<GaborImpulse>& impulses) {
  if (std::fabs(height) > band.farthest + band.cell) return;
  const Frame frame = tangent_frame(inward);
  const Vec3f center = cell_center(c, band.cell);
  const std::uint32_t cell_hash = hash_cell(band.seed, c[0], c[1], c[2]);
  for (int j = 0; j < band.impulses_per_cell; ++j) {
    const std::uint32_t hash = hash_append(cell_hash, static_cast<std::uint32_t>(j));
    const Vec3f p = point_in_cell(hash, c, band.cell);
    const float above = height + dot(frame.n, p - center);
    if (!(std::fabs(above) > band.farthest)) impulses.push_back(make_impulse(band, p, frame, hash));
  }
}

// kernel[i] = impulse i at one point; `impulses` holds one array of `stride` floats for each member.
ASTROLITH_SIMD_CLONES void kernels_at_point(const float* __restrict impulses, std::size_t stride, int n,
                                            float x, float y, float z, float* __restrict kernel) {
  const float* const m = impulses;
  const std::size_t s = stride;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const GaborImpulse impulse{m[i],          m[s + i],      m[2 * s + i],  m[3 * s + i],  m[4 * s + i],
                               m[5 * s + i],  m[6 * s + i],  m[7 * s + i],  m[8 * s + i],  m[9 * s + i],
                               m[10 * s + i], m[11 * s + i], m[12 * s + i], m[13 * s + i], m[14 * s + i]};
    kernel[i] = gabor_kernel(impulse, x, y, z);
  }
}

// One after the other, as a loop over impulses adds them.
ASTROLITH_SIMD_CLONES float sum_kernels(const float* kernel, std::size_t n, float amplitude, float height) {
  for (std::size_t k = 0; k < n; ++k) height = math::fma(amplitude, kernel[k], height);
  return height;
}

constexpr std::size_t kMembers = sizeof(GaborImpulse) / sizeof(float);
static_assert(kMembers == 15);

// Transposed: an array for each member.
std::vector<float> arrays_of(const std::vector<GaborImpulse>& impulses) {
  const std::size_t n = impulses.size();
  std::vector<float> arrays(kMembers * n);
  for (std::size_t i = 0; i < n; ++i) {
    std::array<float, kMembers> members;
    std::memcpy(members.data(), &impulses[i], sizeof members);
    for (std::size_t k = 0; k < kMembers; ++k) arrays[k * n + i] = members[k];
  }
  return arrays;
}

// Centres of cells and the body's field there.
struct Centers {
  std::vector<std::array<int, 3>> cell;
  std::vector<float> x, y, z, distance, gx, gy, gz;

  void add(const std::array<int, 3>& c, float side) {
    const Vec3f p = cell_center(c, side);
    cell.push_back(c);
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  void evaluate(const PreparedMetaballs& body) {
    Box box;
    for (std::size_t i = 0; i < x.size(); ++i) box.extend({double{x[i]}, double{y[i]}, double{z[i]}});
    for (std::vector<float>* v : {&distance, &gx, &gy, &gz}) v->resize(x.size());
    evaluate_metaballs(metaballs_reaching(body, box), static_cast<int>(x.size()), x.data(), y.data(),
                       z.data(), distance.data(), gx.data(), gy.data(), gz.data());
  }
};

}  // namespace

CellRange cells_around(const SurfaceBand& band, const Box& box) {
  return cells_within(box, Vec3d{1, 1, 1} * double{band.reach}, double{band.cell});
}

GaborImpulses::GaborImpulses(const SurfaceBand& band, const PreparedMetaballs& body, int n, const float* x,
                             const float* y, const float* z)
    : band_(band), n_(n), x_(x), y_(y), z_(z) {
  Box box;
  around_.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    const Vec3d p{double{x[i]}, double{y[i]}, double{z[i]}};
    box.extend(p);
    around_.push_back(cells_around(band, Box{p, p}));
  }
  range_ = cells_around(band, box);
  mark_cells();
  draw_cells(body);
}

std::size_t GaborImpulses::row(int cy, int cz) const {
  const auto y = static_cast<std::size_t>(cy - range_.first[1]);
  const auto z = static_cast<std::size_t>(cz - range_.first[2]);
  return (z * static_cast<std::size_t>(range_.size(1)) + y) * static_cast<std::size_t>(range_.size(0));
}

void GaborImpulses::mark_cells() {
  start_.assign(static_cast<std::size_t>(range_.cells()) + 1, 0);
  for (const CellRange& r : around_) {
    for (int cz = r.first[2]; cz <= r.last[2]; ++cz) {
      for (int cy = r.first[1]; cy <= r.last[1]; ++cy) {
        const std::size_t begin = row(cy, cz) + static_cast<std::size_t>(r.first[0] - range_.first[0]);
        std::fill_n(start_.begin() + static_cast<std::ptrdiff_t>(begin), r.size(0), 1u);
      }
    }
  }
}

void GaborImpulses::draw_cells(const PreparedMetaballs& body) {
  Centers centers;
  std::size_t slot = 0;
  for (int cz = range_.first[2]; cz <= range_.last[2]; ++cz) {
    for (int cy = range_.first[1]; cy <= range_.last[1]; ++cy) {
      for (int cx = range_.first[0]; cx <= range_.last[0]; ++cx) {
        if (start_[slot++] != 0) centers.add({cx, cy, cz}, band_.cell);
      }
    }
  }
  centers.evaluate(body);
  marked_ = static_cast<std::int64_t>(centers.cell.size());
  std::size_t i = 0;
  for (std::uint32_t& start : start_) {
    const bool marked = start != 0;
    start = static_cast<std::uint32_t>(impulses_.size());
    if (!marked) continue;
    draw_cell(band_, centers.cell[i], -centers.distance[i], {centers.gx[i], centers.gy[i], centers.gz[i]},
              impulses_);
    ++i;
  }
}

double GaborImpulses::points_per_cell() const {
  double visits = 0.0;
  for (const CellRange& r : around_) visits += static_cast<double>(r.cells());
  return visits / static_cast<double>(std::max<std::int64_t>(marked_, 1));
}

Vec3d GaborImpulses::largest_half_extents() const {
  Vec3d largest;
  for (const GaborImpulse& impulse : impulses_) {
    const Vec3d e = half_extents(impulse, double{band_.a});
    largest = {std::max(largest.x, e.x), std::max(largest.y, e.y), std::max(largest.z, e.z)};
  }
  return largest;
}

void GaborImpulses::add_by_cells(float* height) const {
  const Vec3d reach = largest_half_extents();
  const std::vector<float> arrays = arrays_of(impulses_);
  std::vector<float> kernel(impulses_.size());
  for (int i = 0; i < n_; ++i) {
    const Vec3d p{double{x_[i]}, double{y_[i]}, double{z_[i]}};
    const CellRange r =
        common(cells_within(Box{p, p}, reach, double{band_.cell}), around_[static_cast<std::size_t>(i)]);
    std::size_t count = 0;
    for (int cz = r.first[2]; cz <= r.last[2]; ++cz) {
      for (int cy = r.first[1]; cy <= r.last[1]; ++cy) {
        const std::size_t first = row(cy, cz) + static_cast<std::size_t>(r.first[0] - range_.first[0]);
        const std::uint32_t begin = start_[first], end = start_[first + static_cast<std::size_t>(r.size(0))];
        if (begin == end) continue;
        kernels_at_point(&arrays[begin], impulses_.size(), static_cast<int>(end - begin), x_[i], y_[i], z_[i],
                         &kernel[count]);
        count += end - begin;
      }
    }
    height[i] = sum_kernels(kernel.data(), count, band_.amplitude, height[i]);
  }
}

}  // namespace astrolith
