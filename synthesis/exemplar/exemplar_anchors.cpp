#include "synthesis/exemplar/exemplar_anchors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "synthesis/body/ground_points.h"
#include "synthesis/exemplar/exemplar_ground.h"

namespace astrolith {
namespace {

float norm(const Vec3f& v) { return math::sqrt(dot(v, v)); }

// Moves the points to the surface, to first order and at most `longest` far.
void move_to_surface(float longest, GroundPoints& row) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    const float length = norm(row.gradient(i));
    if (!(length > 1e-18f)) continue;
    const float step = -math::clamp(row.distance[i], -longest, longest) / length;
    row.x[i] = math::fma(step, row.gx[i], row.x[i]);
    row.y[i] = math::fma(step, row.gy[i], row.y[i]);
    row.z[i] = math::fma(step, row.gz[i], row.z[i]);
  }
}

// A turn of the frame about its normal, as the cosine and the sine of its angle.
struct Turn {
  float cosine = 1.0f, sine = 0.0f;
};
Turn drawn_turn(ExemplarRotation rotation, std::uint32_t hash) {
  if (rotation == ExemplarRotation::kNone) return {};
  const float turns =
      rotation == ExemplarRotation::kAny ? unit_float(hash) : 0.25f * static_cast<float>(hash >> 30);
  return {math::cos_turns(turns), math::sin_turns(turns)};
}

ExemplarAnchor make_anchor(const ExemplarLayer& layer, const TangentFrame& frame,
                           const Vec3f& cells_per_length, std::uint32_t hash) {
  const double period = layer.border == ExemplarBorder::kMirror ? 2.0 : 1.0;
  const Turn turn = drawn_turn(layer.rotation, hash_append(hash, 2));
  const Vec3f u = frame.u * turn.cosine + frame.v * turn.sine,
              v = frame.v * turn.cosine - frame.u * turn.sine;
  const auto pixels = static_cast<float>(1.0 / layer.pixel_size);
  const auto per_edge = [&](float c, float cells) { return pixels * c / cells; };
  const auto offset = [&](std::uint32_t index, int side) {
    return static_cast<float>(period * side * static_cast<double>(unit_float(hash_append(hash, index))));
  };
  const Vec3f& c = cells_per_length;
  return {per_edge(u.x, c.x), per_edge(u.y, c.y), per_edge(u.z, c.z), offset(0, layer.pixels->width),
          per_edge(v.x, c.x), per_edge(v.y, c.y), per_edge(v.z, c.z), offset(1, layer.pixels->height)};
}

// Calls visit(cell y, cell z, number of the row's first anchor) for every row of cells along x.
template <class Visit>
void for_each_anchor_row(const ExemplarLattice& l, const Visit& visit) {
  parallel_for(0, std::int64_t{l.size[1]} * l.size[2], [&](std::int64_t row) {
    const int y = static_cast<int>(row % l.size[1]), z = static_cast<int>(row / l.size[1]);
    visit(l.low[1] + y, l.low[2] + z,
          static_cast<std::size_t>(row) * 2 * static_cast<std::size_t>(l.size[0]));
  });
}

// One row of anchors near the surface of a body.
class BodyRow {
 public:
  BodyRow(const ExemplarLattice& l, int cy, int cz) : row_(2 * static_cast<std::size_t>(l.size[0])) {
    for (std::size_t i = 0; i < row_.size(); ++i) {
      const float half = 0.5f * static_cast<float>(i & 1);
      const auto at = [half](int cell, float first, float cells_per_length) {
        return (static_cast<float>(cell) + half - first) / cells_per_length;
      };
      row_.x[i] = at(l.low[0] + static_cast<int>(i / 2), l.first.x, l.cells_per_length.x);
      row_.y[i] = at(cy, l.first.y, l.cells_per_length.y);
      row_.z[i] = at(cz, l.first.z, l.cells_per_length.z);
    }
  }

  // The gradients at the nearest points of the surface. Where the field is flat, they point to `middle`.
  void find_gradients(const BodyGround& ground, float longest, const Vec3f& middle) {
    evaluate(ground, row_);
    const GroundPoints at_anchors = row_;
    distance_ = at_anchors.distance;
    move_to_surface(longest, row_);
    evaluate(ground, row_);
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (norm(gradient(i)) > 1e-18f) continue;
      set_gradient(i, at_anchors.gradient(i));
      if (norm(gradient(i)) > 1e-18f) continue;
      set_gradient(i, middle - at_anchors.at(i));
    }
  }
  Vec3f gradient(std::size_t i) const { return row_.gradient(i); }

  // The tangent frame of an anchor. `longest` is that of find_gradients().
  TangentFrame frame(const ExemplarGround& ground, float longest, std::size_t i) const {
    const TangentFrame bare = tangent_frame(gradient(i));
    if (!ground.below || !serves_surface(ground, longest, i)) return bare;
    return turned_frame(bare, layered_inward(ground, row_.at(i), gradient(i), kSlopeRadius * longest));
  }
  std::size_t size() const { return row_.size(); }

 private:
  // Half the spacing of anchors in edges of cubic cells.
  static constexpr float kSlopeRadius = 0.39685026f;

  // Whether points of the layered surface may have the anchor. They lie within an edge of it. The distance is
  // one to first order, so that half an edge more is allowed.
  bool serves_surface(const ExemplarGround& ground, float longest, std::size_t i) const {
    return math::abs(distance_[i]) <= 1.5f * longest + static_cast<float>(ground.height_bound);
  }
  void set_gradient(std::size_t i, const Vec3f& g) { row_.gx[i] = g.x, row_.gy[i] = g.y, row_.gz[i] = g.z; }

  GroundPoints row_;
  std::vector<float> distance_;  // of the anchors from the bare surface, to first order, length units
};

std::uint32_t anchor_hash(std::uint32_t seed, std::int64_t x, std::int64_t y, std::int64_t z,
                          std::size_t half) {
  return hash_append(hash_wide_cell(seed, x, y, z), static_cast<std::uint32_t>(half));
}

}  // namespace

double exemplar_edge(double anchor_spacing) { return anchor_spacing * 1.25992104989487316477; }

double exemplar_edge(const ExemplarLayer& layer) {
  const int side = std::min(layer.pixels->width, layer.pixels->height);
  return exemplar_edge(layer.anchor_spacing) * side * layer.pixel_size;
}

ExemplarCells exemplar_cells(const NoiseFrame& frame, const Vec3d& edge) {
  ExemplarCells cells;
  const Vec3d per_length{1.0 / edge.x, 1.0 / edge.y, 1.0 / edge.z};
  const OriginCell origin = origin_cell(
      {frame.origin.x * per_length.x, frame.origin.y * per_length.y, frame.origin.z * per_length.z});
  cells.origin[0] = origin.x;
  cells.origin[1] = origin.y;
  cells.origin[2] = origin.z;
  ExemplarLattice& l = cells.lattice;
  l.cells_per_length = to_float(per_length);
  l.first = to_float(origin.rest);
  const std::array<double, 3> scale{per_length.x, per_length.y, per_length.z},
      first{origin.rest.x, origin.rest.y, origin.rest.z},
      low{frame.domain.min.x, frame.domain.min.y, frame.domain.min.z},
      high{frame.domain.max.x, frame.domain.max.y, frame.domain.max.z};
  std::array<double, 3> from{}, to{};
  cells.anchors = 2.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // A tetrahedron reaches at most one cell beyond the cell of its points.
    from[axis] = std::floor(low[axis] * scale[axis] + first[axis]) - 1.0;
    to[axis] = std::floor(high[axis] * scale[axis] + first[axis]) + 2.0;
    cells.anchors *= to[axis] - from[axis];
  }
  if (!(cells.anchors <= kMostExemplarAnchors)) return cells;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    l.low[axis] = static_cast<std::int32_t>(from[axis]);
    l.size[axis] = static_cast<std::int32_t>(to[axis] - from[axis]);
  }
  return cells;
}

std::vector<ExemplarAnchor> anchors_on_body(const ExemplarLayer& layer, const ExemplarCells& cells,
                                            std::uint32_t seed, const ExemplarGround& on) {
  const ExemplarLattice& l = cells.lattice;
  const BodyGround& ground = on.body;
  std::vector<ExemplarAnchor> anchors(static_cast<std::size_t>(cells.anchors));
  const Box& supports = ground.body.supports;
  const Vec3d origin = ground.origin != nullptr ? *ground.origin : Vec3d{};
  const Vec3f middle = to_float(0.5 * (supports.min + supports.max) - origin);
  // An anchor lies at most this far from the points that it serves.
  const float longest =
      1.0f / math::min(l.cells_per_length.x, math::min(l.cells_per_length.y, l.cells_per_length.z));
  for_each_anchor_row(l, [&](int cy, int cz, std::size_t first) {
    BodyRow row(l, cy, cz);
    row.find_gradients(ground, longest, middle);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::int64_t cx = cells.origin[0] + l.low[0] + static_cast<std::int64_t>(i / 2);
      const std::uint32_t hash = anchor_hash(seed, cx, cells.origin[1] + cy, cells.origin[2] + cz, i & 1);
      anchors[first + i] = make_anchor(layer, row.frame(on, longest, i), l.cells_per_length, hash);
    }
  });
  return anchors;
}

std::vector<ExemplarAnchor> anchors_on_plane(const ExemplarLayer& layer, const ExemplarCells& cells,
                                             std::uint32_t seed, const int (&period)[2]) {
  const ExemplarLattice& l = cells.lattice;
  std::vector<ExemplarAnchor> anchors(static_cast<std::size_t>(cells.anchors));
  const TangentFrame frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto wrapped = [](std::int64_t cell, int cells_per_period) {
    if (cells_per_period == 0) return cell;
    const std::int64_t rest = cell % cells_per_period;
    return rest < 0 ? rest + cells_per_period : rest;
  };
  for_each_anchor_row(l, [&](int cy, int cz, std::size_t first) {
    for (std::size_t i = 0; i < 2 * static_cast<std::size_t>(l.size[0]); ++i) {
      const std::int64_t cx = cells.origin[0] + l.low[0] + static_cast<std::int64_t>(i / 2);
      const std::uint32_t hash =
          anchor_hash(seed, wrapped(cx, period[0]), wrapped(cells.origin[1] + cy, period[1]),
                      cells.origin[2] + cz, i & 1);
      anchors[first + i] = make_anchor(layer, frame, l.cells_per_length, hash);
    }
  });
  return anchors;
}

}  // namespace astrolith
