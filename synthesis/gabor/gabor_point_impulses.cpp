#include "synthesis/gabor/gabor_point_impulses.h"

#include <algorithm>
#include <cmath>

namespace astrolith {
namespace {

// The rounding of positions far from the origin of the cells, in cells: 2^20 cells away float coordinates are
// multiples of an eighth of a cell.
constexpr double kCellSlack = 0.125;

// The cells along one axis whose impulses may reach a point, and how far each cell is from the point.
struct CellsOfAxis {
  static constexpr int kMost = 8;  // twice the reach of a kernel, 1.53/a, is below 5 cells long

  CellsOfAxis(const SurfaceBand& band, int axis, float at) {
    const GaborCellSpan span = gabor_cells_around(band, axis, at, at);
    first = span.first;
    last = std::min(span.last, span.first + kMost - 1);
    const Vec3f& corner = band.first_corner;
    const double origin{axis == 0 ? corner.x : axis == 1 ? corner.y : corner.z};
    const double place = (double{at} - origin) / double{band.cell};
    for (int c = first; c <= last; ++c) {
      const double gap = std::max({c - place, place - (c + 1.0), 0.0});
      squared_gap[static_cast<std::size_t>(c - first)] = gap * gap;
    }
  }
  double gap(int cell) const { return squared_gap[static_cast<std::size_t>(cell - first)]; }

  int first, last;
  std::array<double, kMost> squared_gap{};  // in cells
};

// Calls visit(cell) for the cells of an axis in each of its bricks.
template <typename Visit>
void for_each_cell_of_brick(const CellsOfAxis& axis, int brick, const Visit& visit) {
  const int first = std::max(axis.first, brick * kBrickCells);
  const int last = std::min(axis.last, brick * kBrickCells + kBrickCells - 1);
  for (int c = first; c <= last; ++c) visit(c);
}
template <typename Visit>
void for_each_brick(const CellsOfAxis& axis, const Visit& visit) {
  for (int brick = gabor_brick_of(axis.first); brick <= gabor_brick_of(axis.last); ++brick) visit(brick);
}

// Whether kernels in a cell with this tangent frame may reach the point. (dx, dy, dz) is the offset of the
// point from the centre of the cell.
bool cell_reaches(const SurfaceBand& band, const TangentFrame& frame, float dx, float dy, float dz) {
  const GaborImpulse at_center = gabor_impulse(band.a, {0.0f, 0.0f, 0.0f}, frame, {1.0f, 0.0f, 0.0f}, 0.0f);
  const float half = (0.5f + static_cast<float>(kCellSlack)) * band.cell;
  const std::array<float, 3> offset{dx, dy, dz}, halves{half, half, half};
  return gabor_reaches(at_center, gabor_target(band.a, offset.data(), halves.data()));
}

}  // namespace

// Finds the cells within reach of the point, brick by brick.
void GaborPointImpulses::find_cells(const std::array<float, 3>& point) {
  const CellsOfAxis xs(band_, 0, point[0]), ys(band_, 1, point[1]), zs(band_, 2, point[2]);
  const double reach = (1.0 + 1e-3) * double{band_.reach} / double{band_.cell} + kCellSlack;
  const double farthest = reach * reach;
  cells_.clear();
  for_each_brick(zs, [&](int tz) {
    for_each_brick(ys, [&](int ty) {
      for_each_brick(xs, [&](int tx) {
        for_each_cell_of_brick(zs, tz, [&](int z) {
          for_each_cell_of_brick(ys, ty, [&](int y) {
            const double gap = zs.gap(z) + ys.gap(y);
            if (gap > farthest) return;
            for_each_cell_of_brick(xs, tx, [&](int x) {
              if (gap + xs.gap(x) <= farthest) cells_.push_back({x, y, z});
            });
          });
        });
      });
    });
  });
}

void GaborPointImpulses::append(const GaborImpulse& impulse) {
  const std::size_t chunk = impulses_ / kLanes;
  if (chunk == chunks_.size()) chunks_.emplace_back();
  set_lane(impulse, impulses_ % kLanes, chunks_[chunk]);
  ++impulses_;
}

std::span<const ImpulseChunk> GaborPointImpulses::around(float x, float y, float z) {
  find_cells({x, y, z});
  centers_.find(cells_, band_, ground_);
  impulses_ = 0;
  const GaborLobeShare* lobes = ground_.arrays[band_.lobes];
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const float height = -centers_.distance[i];
    if (is_far_gabor_cell(band_, height)) continue;
    const TangentFrame frame = tangent_frame({centers_.gx[i], centers_.gy[i], centers_.gz[i]});
    if (!cell_reaches(band_, frame, x - centers_.x[i], y - centers_.y[i], z - centers_.z[i])) continue;
    const GaborCell& c = cells_[i];
    for_each_gabor_impulse(band_, lobes, band_.lobes.count, c[0], c[1], c[2], height, frame,
                           [&](const GaborImpulse& impulse) { append(impulse); });
  }
  const std::size_t used = (impulses_ + kLanes - 1) / kLanes;
  if (impulses_ % kLanes != 0) empty_lanes(impulses_ % kLanes, chunks_[used - 1]);
  return std::span(chunks_).first(used);
}

}  // namespace astrolith
