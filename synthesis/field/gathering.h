// The rules for which elements of a field reach a block, for CPU and GPU. The lists of BlockLists
// (field_tables.h) are gathered by them.
#pragma once

#include "synthesis/body/body_at_point.h"
#include "synthesis/body/body_bounds.h"
#include "synthesis/field/content_bounds.h"
#include "synthesis/field/field_at_point.h"
#include "synthesis/field/field_tables.h"

namespace astrolith {

// A box that holds the projections of the points of `box` on the bare surface. Craters and Gabor noise are
// evaluated there.
ASTROLITH_HD inline Box projected_block(const FieldView& f, const Box& box) {
  return farthest_projected_box(body_box(f.body, f.arrays, box), f.height_bound);
}

// Whether a metaball of the leaf reaches a block; `at` is the leaf_box() of the block.
ASTROLITH_HD inline bool metaball_reaches(const BodyLeaf& leaf, const MetaballSphere<float>& sphere,
                                          const Box& at) {
  return reaches_box(sphere, double{leaf.metaballs.cutoff_squared}, at);
}

// Whether a crater of a list reaches a block; `projected` is the projected_block() of the block.
ASTROLITH_HD inline bool crater_reaches(const FieldView& f, std::uint32_t list, std::uint32_t number,
                                        const Box& projected) {
  return boxes_touch(crater_reach(f.arrays[f.craters(list).craters][number]),
                     f.in_layer_frame(f.crater_layer(list), projected));
}

// Whether a boulder reaches a block.
ASTROLITH_HD inline bool boulder_reaches(const FieldView& f, std::uint32_t number, const Box& box) {
  return boxes_touch(f.arrays[f.boulders][number].box, box);
}

// Calls write(impulse) for every spot of list number `list` that reaches the block, or for a share of them
// (for_each_spot).
template <class Write, class Share = AllCells>
ASTROLITH_HD void gather_spots(const FieldView& f, std::uint32_t list, const Box& box, Write&& write,
                               const Share& share = {}) {
  const ImpulseList from = f.arrays[f.spot_lists][list];
  const FieldLayer& layer = f.layers[from.layer];
  const SpotNoise& noise = *f.noise(layer).get_if<SpotNoise>();
  const Box where = displaced_layer_box(f.in_layer_frame(layer, box), layer.join.displaced);
  for_each_spot(f.arrays[noise.kinds][from.element], f.arrays[noise.thresholds],
                moved_into(where, noise.low, noise.high), write, share);
}

// A box of floats by its corners, its centre and half its sides, along the three axes.
struct FloatBox {
  float low[3], high[3], center[3], half[3];
};

// A box within a domain, rounded outwards to floats.
ASTROLITH_HD inline FloatBox outer_float_box(const Box& box, const Vec3f& least, const Vec3f& most) {
  // The neighbour of a finite float.
  const auto next_float = [](float v, bool up) {
    if (v == 0.0f) return math::from_bits(up ? 1 : std::int32_t(0x80000001u));
    return math::from_bits(math::to_bits(v) + ((v > 0.0f) == up ? 1 : -1));
  };
  FloatBox out;
  const auto set = [&](int axis, double low, double high, float from, float to) {
    out.low[axis] = math::clamp(next_float(static_cast<float>(low), false), from, to);
    out.high[axis] = math::clamp(next_float(static_cast<float>(high), true), from, to);
    out.center[axis] = 0.5f * (out.low[axis] + out.high[axis]);
    out.half[axis] = std::max(out.high[axis] - out.center[axis], out.center[axis] - out.low[axis]);
  };
  set(0, box.min.x, box.max.x, least.x, most.x);
  set(1, box.min.y, box.max.y, least.y, most.y);
  set(2, box.min.z, box.max.z, least.z, most.z);
  return out;
}

// Visits the cells of a band whose impulses may reach a box, or a share of them: cells share.begin(n) to
// share.end(n) - 1 of n. Cells come brick by brick, because the CPU keeps impulses in bricks
// (synthesis/gabor/gabor_bricks.h) and adds kernels in this order.
template <class Share, class Visit>
ASTROLITH_HD void for_each_gabor_cell(const GaborDraw& band, const FloatBox& box, const Share& share,
                                      const Visit& visit) {
  GaborCellSpan cells[3], bricks[3];
  for (int a = 0; a < 3; ++a) {
    cells[a] = gabor_cells_around(band, a, box.low[a], box.high[a]);
    bricks[a] = {containing_gabor_brick(cells[a].first), containing_gabor_brick(cells[a].last)};
  }
  const auto length = [](const GaborCellSpan& span) {
    return static_cast<std::uint64_t>(std::max(span.last - span.first + 1, 0));
  };
  const std::uint64_t all = length(cells[0]) * length(cells[1]) * length(cells[2]);
  const std::uint64_t begin = share.begin(all), end = share.end(all);
  std::uint64_t at = 0;  // number of the next cell
  const auto visit_brick = [&](int tx, int ty, int tz) {
    const auto brick_span = [&](int a, int brick) {
      return GaborCellSpan{std::max(cells[a].first, brick * kBrickCells),
                           std::min(cells[a].last, brick * kBrickCells + kBrickCells - 1)};
    };
    const GaborCellSpan xs = brick_span(0, tx), ys = brick_span(1, ty), zs = brick_span(2, tz);
    const std::uint64_t brick_cells = length(xs) * length(ys) * length(zs);
    if (at + brick_cells <= begin || at >= end) {
      at += brick_cells;
      return;
    }
    for (int z = zs.first; z <= zs.last; ++z) {
      for (int y = ys.first; y <= ys.last; ++y) {
        for (int x = xs.first; x <= xs.last; ++x, ++at) {
          if (at >= begin && at < end) visit(x, y, z);
        }
      }
    }
  };
  for (int tz = bricks[2].first; tz <= bricks[2].last; ++tz) {
    for (int ty = bricks[1].first; ty <= bricks[1].last; ++ty) {
      for (int tx = bricks[0].first; tx <= bricks[0].last; ++tx) visit_brick(tx, ty, tz);
    }
  }
}

// Calls write(impulse) for the Gabor impulses of list number `list` that may reach the block. Impulses that
// do not reach it may be among them; they add nothing. The frames of impulses follow from the body at the
// centres of their cells, so `metaballs` must hold the metaballs that reach the cells around the block.
// A share of them stands for that share of the cells. Frame::kBody is for fields of no patch, and takes fewer
// registers of a GPU.
template <Frame frame, class Write, class Share = AllCells>
ASTROLITH_HD void gather_gabor(const FieldView& f, std::uint32_t list, const LeafLists& metaballs,
                               const Box& box, Write&& write, const Share& share = {}) {
  const ImpulseList from = f.arrays[f.gabor_lists][list];
  const FieldLayer& layer = f.layers[from.layer];
  const GaborSurfaceNoise& noise = *f.noise(layer).get_if<GaborSurfaceNoise>();
  const SurfaceBand& band = f.arrays[noise.bands][from.element];
  const FloatBox at =
      outer_float_box(f.in_layer_frame(layer, projected_block(f, box)), noise.low, noise.high);
  const GaborTarget target = gabor_target(band.a, at.center, at.half);
  const auto write_reaching = [&](const GaborImpulse& impulse) {
    if (gabor_reaches(impulse, target)) write(impulse);
  };
  for_each_gabor_cell(band, at, share, [&](int x, int y, int z) {
    const Vec3f center = gabor_cell_center(band, x, y, z);
    const BodyAtPoint s = frame == Frame::kBody || layer.in_patch < 0
                              ? unwarped_body_at(f.body, f.arrays, metaballs, center)
                              : local_plain_body_at(f.body, f.arrays, metaballs, f.patch.origin, center);
    for_each_gabor_impulse(band, f.arrays[band.lobes], band.lobes.count, x, y, z, -s.distance, s.gradient,
                           write_reaching);
  });
}

// The largest distance, in length units, from the projected_block() of a block to the centre of a cell whose
// Gabor impulses may reach the block; 0 for a field without Gabor noise.
inline double gabor_margin(const FieldView& f) {
  double margin = 0.0;
  for (const ImpulseList& list : f.arrays.span(f.gabor_lists)) {
    const GaborSurfaceNoise& noise = *f.noise(f.layers[list.layer]).get_if<GaborSurfaceNoise>();
    const SurfaceBand& band = f.arrays[noise.bands][list.element];
    margin = std::max(margin, 1.01 * double{band.reach} + 2.0 * double{band.cell});
  }
  return margin;
}

}  // namespace astrolith
