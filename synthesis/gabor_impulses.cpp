#include "synthesis/gabor_impulses.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "numerics/scalar_math.h"

namespace astrolith {
namespace {

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

// Largest i with i * divisor <= n.
int floor_divided(int n, int divisor) { return n >= 0 ? n / divisor : -((-n + divisor - 1) / divisor); }

// A box of so many cells for each point is worth drawing whole, by tiles that others can use too.
constexpr std::int64_t kCellsPerPoint = 100;

}  // namespace

CellRange cells_around(const SurfaceBand& band, const Box& box) {
  return cells_within(box, Vec3d{1, 1, 1} * double{band.reach}, double{band.cell});
}

GaborImpulses::GaborImpulses(const GaborTiles& tiles, int n, const float* x, const float* y, const float* z)
    : band_(tiles.band()), n_(n), x_(x), y_(y), z_(z) {
  Box box;
  around_.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    const Vec3d p{double{x[i]}, double{y[i]}, double{z[i]}};
    box.extend(p);
    around_.push_back(cells_around(band_, Box{p, p}));
  }
  range_ = cells_around(band_, box);
  if (range_.cells() <= kCellsPerPoint * n) {
    collect_tiles(tiles);
  } else {
    mark_cells();
    draw_marked(tiles.body());
  }
}

std::size_t GaborImpulses::row(int cy, int cz) const {
  const auto y = static_cast<std::size_t>(cy - range_.first[1]);
  const auto z = static_cast<std::size_t>(cz - range_.first[2]);
  return (z * static_cast<std::size_t>(range_.size(1)) + y) * static_cast<std::size_t>(range_.size(0));
}

// Row by row of the range, a run of cells from each tile that the row crosses.
void GaborImpulses::collect_tiles(const GaborTiles& tiles) {
  std::array<int, 3> first, count;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] = floor_divided(range_.first[axis], kTileCells);
    count[axis] = floor_divided(range_.last[axis], kTileCells) - first[axis] + 1;
  }
  std::vector<std::shared_ptr<const DrawnCells>> held;
  for (int z = 0; z < count[2]; ++z) {
    for (int y = 0; y < count[1]; ++y) {
      for (int x = 0; x < count[0]; ++x)
        held.push_back(tiles.tile({first[0] + x, first[1] + y, first[2] + z}));
    }
  }
  start_.reserve(static_cast<std::size_t>(range_.cells()) + 1);
  for (int cz = range_.first[2]; cz <= range_.last[2]; ++cz) {
    const int tz = floor_divided(cz, kTileCells), z = cz - tz * kTileCells;
    for (int cy = range_.first[1]; cy <= range_.last[1]; ++cy) {
      const int ty = floor_divided(cy, kTileCells), y = cy - ty * kTileCells;
      for (int tx = first[0]; tx < first[0] + count[0]; ++tx) {
        const int begin = std::max(range_.first[0] - tx * kTileCells, 0);
        const int end = std::min(range_.last[0] - tx * kTileCells + 1, kTileCells);
        const auto tile =
            static_cast<std::size_t>(((tz - first[2]) * count[1] + ty - first[1]) * count[0] + tx - first[0]);
        const auto row = static_cast<std::size_t>((z * kTileCells + y) * kTileCells);
        append(*held[tile], row + static_cast<std::size_t>(begin), row + static_cast<std::size_t>(end));
      }
    }
  }
  start_.push_back(static_cast<std::uint32_t>(impulses_.size()));
  drawn_ = range_.cells();
}

void GaborImpulses::append(const DrawnCells& tile, std::size_t begin, std::size_t end) {
  const auto size = static_cast<std::uint32_t>(impulses_.size());
  for (std::size_t cell = begin; cell < end; ++cell) {
    start_.push_back(size + tile.start[cell] - tile.start[begin]);
  }
  impulses_.insert(impulses_.end(), tile.impulses.begin() + tile.start[begin],
                   tile.impulses.begin() + tile.start[end]);
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

void GaborImpulses::draw_marked(const PreparedBody& body) {
  std::vector<GaborCell> cells;
  std::size_t slot = 0;
  for (int cz = range_.first[2]; cz <= range_.last[2]; ++cz) {
    for (int cy = range_.first[1]; cy <= range_.last[1]; ++cy) {
      for (int cx = range_.first[0]; cx <= range_.last[0]; ++cx) {
        if (start_[slot++] != 0) cells.push_back({cx, cy, cz});
      }
    }
  }
  DrawnCells drawn = draw_cells(band_, body, cells);
  drawn_ = static_cast<std::int64_t>(cells.size());
  std::size_t next = 0;
  for (std::uint32_t& start : start_) {
    const bool marked = start != 0;
    start = drawn.start[next];
    if (marked) ++next;
  }
  impulses_ = std::move(drawn.impulses);
}

double GaborImpulses::points_per_cell() const {
  double visits = 0.0;
  for (const CellRange& r : around_) visits += static_cast<double>(r.cells());
  return visits / static_cast<double>(std::max<std::int64_t>(drawn_, 1));
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
