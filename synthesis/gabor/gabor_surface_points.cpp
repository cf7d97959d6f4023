#include "synthesis/gabor/gabor_surface_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "synthesis/gabor/gabor_cells.h"
#include "synthesis/gabor/gabor_chunk.h"

namespace astrolith {
namespace {

// Draws the impulses of one band around one point after another. The memory is kept from point to point.
class GaborPointImpulses {
 public:
  // Both arguments must outlive the object.
  GaborPointImpulses(const SurfaceBand& band, const BodyGround& ground) : band_(band), ground_(ground) {}

  // The impulses that may reach the point, in the order in which bricks hold them. The chunks have no boxes,
  // and are valid until the next call.
  std::span<const ImpulseChunk> around(float x, float y, float z);

 private:
  void find_cells(const std::array<float, 3>& point);
  void append(const GaborImpulse& impulse);

  const SurfaceBand& band_;
  const BodyGround& ground_;
  std::vector<GaborCell> cells_;  // those that may hold an impulse that reaches the point
  GaborCellCenters centers_;
  std::vector<ImpulseChunk> chunks_;
  std::size_t impulses_ = 0;  // number of impulses in the chunks
};

// The rounding of positions far from the origin of the cells, in cells: 2^20 cells away float coordinates are
// multiples of an eighth of a cell.
constexpr double kCellSlack = 0.125;

// The cells along one axis whose impulses may reach a point, and how far each cell is from the point.
struct AxisCells {
  static constexpr int kMost = 8;  // twice the reach of a kernel, 1.53/a, is below 5 cells long

  AxisCells(const SurfaceBand& band, int axis, float at) {
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
void for_each_brick_cell(const AxisCells& axis, int brick, const Visit& visit) {
  const int first = std::max(axis.first, brick * kBrickCells);
  const int last = std::min(axis.last, brick * kBrickCells + kBrickCells - 1);
  for (int c = first; c <= last; ++c) visit(c);
}
template <typename Visit>
void for_each_brick(const AxisCells& axis, const Visit& visit) {
  for (int brick = containing_gabor_brick(axis.first); brick <= containing_gabor_brick(axis.last); ++brick)
    visit(brick);
}

// Whether kernels in a cell with this tangent frame may reach the point. (dx, dy, dz) is the offset of the
// point from the centre of the cell.
bool cell_reaches(const SurfaceBand& band, const TangentFrame& frame, float dx, float dy, float dz) {
  const GaborImpulse at_center = gabor_impulse(band.a, {0.0f, 0.0f, 0.0f}, frame, {1.0f, 0.0f, 0.0f}, 0.0f);
  const float half = (0.5f + static_cast<float>(kCellSlack)) * band.cell;
  const std::array<float, 3> offset{dx, dy, dz}, halves{half, half, half};
  return gabor_reaches(at_center, gabor_target(band.a, offset.data(), halves.data()));
}

// Finds the cells within reach of the point, brick by brick.
void GaborPointImpulses::find_cells(const std::array<float, 3>& point) {
  const AxisCells xs(band_, 0, point[0]), ys(band_, 1, point[1]), zs(band_, 2, point[2]);
  const double reach = (1.0 + 1e-3) * double{band_.reach} / double{band_.cell} + kCellSlack;
  const double farthest = reach * reach;
  cells_.clear();
  for_each_brick(zs, [&](int tz) {
    for_each_brick(ys, [&](int ty) {
      for_each_brick(xs, [&](int tx) {
        for_each_brick_cell(zs, tz, [&](int z) {
          for_each_brick_cell(ys, ty, [&](int y) {
            const double gap = zs.gap(z) + ys.gap(y);
            if (gap > farthest) return;
            for_each_brick_cell(xs, tx, [&](int x) {
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

constexpr int kGroup = static_cast<int>(kLanes);
// Sixteen groups form a cluster. The impulses that reach a cluster are sorted into its groups.
constexpr int kCluster = static_cast<int>(kLanes) * kGroup;

// Points whose boxes have more cells than this are split, so that memory is bounded.
constexpr std::int64_t kMostCells = 1 << 17;
// If a range of points has at most this many cells per point, the impulses of all these cells are drawn once,
// in bricks that are kept and shared. Otherwise the impulses are drawn for each point by itself.
constexpr std::int64_t kCellsPerPoint = 300;

// The cells whose impulses may reach a point of the box.
CellRange cells_around(const SurfaceBand& band, const PointBox& box) {
  CellRange range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const GaborCellSpan span =
        gabor_cells_around(band, static_cast<int>(axis), box.low[axis], box.high[axis]);
    range.first[axis] = span.first;
    range.last[axis] = span.last;
  }
  return range;
}

// A range of bricks, numbered in the order z, then y, then x.
struct BrickRange {
  explicit BrickRange(const CellRange& cells) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first[axis] = containing_gabor_brick(cells.first[axis]);
      count[axis] = containing_gabor_brick(cells.last[axis]) - first[axis] + 1;
    }
  }
  std::size_t size() const { return static_cast<std::size_t>(count[0] * count[1] * count[2]); }
  std::array<int, 3> index(std::size_t number) const {
    const int i = static_cast<int>(number);
    return {first[0] + i % count[0], first[1] + i / count[0] % count[1],
            first[2] + i / (count[0] * count[1])};
  }

  std::array<int, 3> first, count;
};

// The most memory of the bricks that a thread holds at once, bytes, but for the last brick. The cache may
// have dropped bricks that a thread still holds.
constexpr std::size_t kMostHeldBytes = 1 << 20;

using HeldBricks = std::vector<std::shared_ptr<const GaborBrick>>;

// Takes bricks of the range from number `next` on, as many as a thread may hold at once, and advances `next`.
HeldBricks next_bricks(const GaborBricks& bricks, const BrickRange& range, std::size_t& next) {
  HeldBricks held;
  for (std::size_t bytes = 0; next < range.size() && bytes < kMostHeldBytes; ++next) {
    held.push_back(bricks.brick(range.index(next)));
    bytes += held.back()->chunks.size() * sizeof(ImpulseChunk);
  }
  return held;
}

using Chunks = std::vector<const ImpulseChunk*>;

// Writes the chunks that overlap a box to `kept`.
void narrow(const Chunks& chunks, const PointBox& box, Chunks& kept) {
  kept.clear();
  for (const ImpulseChunk* chunk : chunks) {
    if (overlap(box, chunk->low, chunk->high)) kept.push_back(chunk);
  }
}

// Writes the chunks of the bricks that overlap a box to `chunks`.
void find_chunks(const HeldBricks& bricks, const PointBox& box, Chunks& chunks) {
  chunks.clear();
  for (const auto& brick : bricks) {
    if (!overlap(box, brick->low, brick->high)) continue;
    for (const ImpulseChunk& chunk : brick->chunks) {
      if (overlap(box, chunk.low, chunk.high)) chunks.push_back(&chunk);
    }
  }
}

}  // namespace

GaborSurfacePoints::GaborSurfacePoints(int n, const float* x, const float* y, const float* z,
                                       bool with_slopes)
    : index_(static_cast<std::size_t>(n)) {
  std::iota(index_.begin(), index_.end(), 0);
  x_.assign(x, x + n);
  y_.assign(y, y + n);
  z_.assign(z, z + n);
  if (n > kGroup) sort(0, n);
  const auto padded = static_cast<std::size_t>((n + kGroup - 1) / kGroup * kGroup);
  for (auto [to, from] : {std::pair{&x_, x}, {&y_, y}, {&z_, z}}) {
    for (std::size_t i = 0; i < index_.size(); ++i) (*to)[i] = from[index_[i]];
    to->resize(padded, n > 0 ? to->back() : 0.0f);
  }
  height_.assign(padded, 0.0f);
  if (with_slopes) {
    for (auto* s : {&sx_, &sy_, &sz_}) s->assign(padded, 0.0f);
  }
  find_groups();
}

// The last points of the last group repeat its last point.
void GaborSurfacePoints::find_groups() {
  groups_.resize(x_.size() / kLanes);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const std::array<const float*, 3> at{&x_[g * kLanes], &y_[g * kLanes], &z_[g * kLanes]};
    PointBox box{{at[0][0], at[1][0], at[2][0]}, {at[0][0], at[1][0], at[2][0]}};
    std::array<float, kLanes> squares{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < kLanes; ++i) {
        box.low[axis] = math::min(box.low[axis], at[axis][i]);
        box.high[axis] = math::max(box.high[axis], at[axis][i]);
      }
      const float center = 0.5f * (box.low[axis] + box.high[axis]);
      for (std::size_t i = 0; i < kLanes; ++i) {
        const float d = at[axis][i] - center;
        squares[i] += d * d;
      }
    }
    float farthest = 0.0f;
    for (const float square : squares) farthest = math::max(farthest, square);
    groups_[g] = {box, math::sqrt(farthest)};
  }
}

// Splits the points into halves along their longest axis until groups are left. `begin` is a multiple of the
// size of a group. It is a multiple of the size of a cluster if both halves hold clusters.
void GaborSurfacePoints::sort(int begin, int end) {
  if (end - begin <= kGroup) return;
  std::array<float, 3> low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  const std::array<const std::vector<float>*, 3> coordinates{&x_, &y_, &z_};
  for (int i = begin; i < end; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float c = (*coordinates[axis])[static_cast<std::size_t>(index_[static_cast<std::size_t>(i)])];
      low[axis] = std::min(low[axis], c);
      high[axis] = std::max(high[axis], c);
    }
  }
  const auto extent = [&](std::size_t axis) { return high[axis] - low[axis]; };
  const std::size_t axis = extent(0) >= extent(1) && extent(0) >= extent(2) ? 0
                           : extent(1) >= extent(2)                         ? 1
                                                                            : 2;
  const std::vector<float>& c = *coordinates[axis];
  const int unit = end - begin > kCluster ? kCluster : kGroup;
  const int middle = begin + ((end - begin) / 2 + unit - 1) / unit * unit;
  std::nth_element(index_.begin() + begin, index_.begin() + middle, index_.begin() + end, [&](int i, int j) {
    return c[static_cast<std::size_t>(i)] < c[static_cast<std::size_t>(j)];
  });
  sort(begin, middle);
  sort(middle, end);
}

PointBox GaborSurfacePoints::bounding_box(int begin, int end) const {
  const auto at = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return std::array<float, 3>{x_[k], y_[k], z_[k]};
  };
  const auto extended = [](const PointBox& box, const std::array<float, 3>& low,
                           const std::array<float, 3>& high) {
    PointBox both;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      both.low[axis] = std::min(box.low[axis], low[axis]);
      both.high[axis] = std::max(box.high[axis], high[axis]);
    }
    return both;
  };
  PointBox box{at(begin), at(begin)};
  if (whole_groups(begin, end)) {
    for (int i = begin; i < end; i += kGroup) {
      const PointBox& group = groups_[static_cast<std::size_t>(i / kGroup)].box;
      box = extended(box, group.low, group.high);
    }
  } else {
    for (int i = begin; i < end; ++i) box = extended(box, at(i), at(i));
  }
  return box;
}

GroupBoxes GaborSurfacePoints::group_boxes(float a, int begin, int end) const {
  GroupBoxes groups;
  for (int i = begin; i < end; i += kGroup) {
    const Group& from = groups_[static_cast<std::size_t>(i / kGroup)];
    const GaborTarget target = make_target(from.box, a);
    const std::size_t g = groups.count++;
    groups.x[g] = target.center[0];
    groups.y[g] = target.center[1];
    groups.z[g] = target.center[2];
    groups.half_x[g] = target.half[0];
    groups.half_y[g] = target.half[1];
    groups.half_z[g] = target.half[2];
    groups.disc[g] = most_disc(a, from.radius);
  }
  return groups;
}

HeightSums GaborSurfacePoints::sums_from(int begin) {
  const auto i = static_cast<std::size_t>(begin);
  if (sx_.empty()) return {&x_[i], &y_[i], &z_[i], &height_[i], nullptr, nullptr, nullptr};
  return {&x_[i], &y_[i], &z_[i], &height_[i], &sx_[i], &sy_[i], &sz_[i]};
}

void GaborSurfacePoints::add_band(const GaborBricks& bricks) {
  if (size() > 0) add_band(bricks, 0, size());
}

// Whether the range holds whole groups only. add_to_dense() adds to whole groups, and a split group belongs
// to more than one range.
bool GaborSurfacePoints::whole_groups(int begin, int end) const {
  return begin % kGroup == 0 && (end % kGroup == 0 || end == size());
}

void GaborSurfacePoints::add_band(const GaborBricks& bricks, int begin, int end) {
  const CellRange range = cells_around(bricks.band(), bounding_box(begin, end));
  if (range.cells() > kMostCells && end - begin > 1) {
    const int unit = end - begin > kGroup ? kGroup : 1;
    const int middle = begin + ((end - begin) / 2 + unit - 1) / unit * unit;
    add_band(bricks, begin, middle);
    add_band(bricks, middle, end);
  } else if (whole_groups(begin, end) && range.cells() <= kCellsPerPoint * (end - begin)) {
    add_to_dense(bricks, range, begin, end);
  } else {
    add_to_scattered(bricks, begin, end);
  }
}

// Bricks come in one order whatever part of them is held at once, and the sums are taken in this order.
void GaborSurfacePoints::add_to_dense(const GaborBricks& bricks, const CellRange& cells, int begin, int end) {
  const BrickRange range(cells);
  const PointBox box = bounding_box(begin, end);
  Chunks chunks;
  for (std::size_t next = 0; next < range.size();) {
    const HeldBricks held = next_bricks(bricks, range, next);
    find_chunks(held, box, chunks);
    if (!chunks.empty()) add_chunks(chunks, bricks.band(), begin, end);
  }
}

// Adds the kernels of the chunks to the sums at the points of a range of whole groups.
void GaborSurfacePoints::add_chunks(const std::vector<const ImpulseChunk*>& all, const SurfaceBand& band,
                                    int begin, int end) {
  Chunks chunks;
  for (int cluster = begin; cluster < end; cluster += kCluster) {
    const int cluster_end = std::min(cluster + kCluster, end);
    const PointBox box = bounding_box(cluster, cluster_end);
    narrow(all, box, chunks);
    add_to_groups(chunks, band.a, band.amplitude, make_target(box, band.a),
                  group_boxes(band.a, cluster, cluster_end), sums_from(cluster));
  }
}

void GaborSurfacePoints::add_to_scattered(const GaborBricks& bricks, int begin, int end) {
  GaborPointImpulses impulses(bricks.band(), bricks.ground());
  for (int i = begin; i < end; ++i) {
    const auto p = static_cast<std::size_t>(i);
    add_at_point(impulses.around(x_[p], y_[p], z_[p]), bricks.band().a, bricks.band().amplitude,
                 sums_from(i));
  }
}

void GaborSurfacePoints::store_heights(float* height) const {
  for (std::size_t i = 0; i < index_.size(); ++i) height[index_[i]] = height_[i];
}

void GaborSurfacePoints::store_slopes(float* x, float* y, float* z) const {
  for (std::size_t i = 0; i < index_.size(); ++i) {
    x[index_[i]] = sx_[i];
    y[index_[i]] = sy_[i];
    z[index_[i]] = sz_[i];
  }
}

}  // namespace astrolith
