// The lists that blocks are evaluated with (FlatBlocks of synthesis/field/flat_field.h), written on a
// backend: each struct writes list number i, by the rules of FieldBlock::lists().
#pragma once

#include "cuda/mesher/cull_steps.h"
#include "synthesis/field/flat_body.h"

namespace astrolith {

// Blocks, and what culling left of their lists.
struct GatherFrom {
  FlatField field;
  MeshGrid grid;
  NodeLists lists;
  CullNodes blocks;

  ASTROLITH_HD Box box(std::size_t block) const {
    const CullNode& n = blocks.nodes[block];
    return grid.box(n.x, n.y, n.z, 1);
  }
  ASTROLITH_HD FlatRange range(std::size_t block, std::size_t list) const {
    return blocks.ranges[block * lists.count() + list];
  }
};

// The metaballs of leaf i % leaves and block i / leaves, from list `first_list` on.
struct GatherMetaballs {
  GatherFrom from;
  std::uint32_t first_list;

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const FlatRange range = from.range(i / from.lists.leaves, first_list + i % from.lists.leaves);
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
      write(from.field.spheres[from.blocks.numbers[k]]);
    }
  }
};

// The numbers of craters and boulders.
struct GatherLandforms {
  GatherFrom from;

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const FlatRange range =
        from.range(i / from.lists.landforms, from.lists.leaves + i % from.lists.landforms);
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) write(from.blocks.numbers[k]);
  }
};

// The spots of one size.
struct GatherSpots {
  GatherFrom from;
  std::uint32_t sizes;

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const FlatField& f = from.field;
    const FlatSpots& spots = f.spots[i % sizes];
    const FlatLayer& layer = f.layers[spots.layer];
    const Box where = displaced_layer_box(from.box(i / sizes), layer.join.displaced);
    for_each_spot(spots.kind, f.spot_thresholds, moved_into(where, layer.low, layer.high), write);
  }
};

// The Gabor impulses of one band. Cells come tile by tile, as the CPU keeps them: kernels are added in that
// order.
struct GatherGabor {
  GatherFrom from;
  std::uint32_t bands;
  FlatBlock metaballs;                  // of all blocks, for the body around the cells' centres
  const std::uint32_t* first_metaball;  // (blocks * leaves + 1)

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const FlatField& f = from.field;
    const FlatBand& band = f.bands[i % bands];
    const FlatLayer& layer = f.layers[band.layer];
    const Box at = farthest_projected_box(flat_body_box(f, from.box(i / bands)), f.height_bound);
    float low[3], high[3], center[3], half[3];
    outer_floats(at.min.x, at.max.x, layer.low.x, layer.high.x, low[0], high[0]);
    outer_floats(at.min.y, at.max.y, layer.low.y, layer.high.y, low[1], high[1]);
    outer_floats(at.min.z, at.max.z, layer.low.z, layer.high.z, low[2], high[2]);
    for (int a = 0; a < 3; ++a) {
      center[a] = 0.5f * (low[a] + high[a]);
      half[a] = std::max(high[a] - center[a], center[a] - low[a]);
    }
    FlatBlock body = metaballs;
    body.first_sphere = first_metaball + i / bands * from.lists.leaves;
    const auto write_near = [&](const GaborImpulse& impulse) {
      if (beyond_gabor_reach(impulse, center, half) <= 0.0f) write(impulse);
    };
    for_each_cell(band.draw, low, high, [&](int x, int y, int z) {
      const Vec3f middle = gabor_cell_center(x, y, z, band.draw.cell);
      const FlatBodySample s = body_at(body, middle);
      for_each_gabor_impulse(band.draw, f.lobes + band.lobes.first, band.lobes.count, x, y, z, -s.distance,
                             s.gradient, write_near);
    });
  }

 private:
  // Impulses are drawn on the metaballs' own side of the body's warp.
  ASTROLITH_HD FlatBodySample body_at(const FlatBlock& body, const Vec3f& p) const {
    if (from.field.num_steps != 0) return flat_body(from.field, body, p);
    const SurfaceDistance<float> d = flat_leaf(from.field, body, 0, p);
    return {d.distance, d.log_gradient, p};
  }
  // The values low .. high rounded outwards, within a layer's domain.
  ASTROLITH_HD static void outer_floats(double low, double high, float least, float most, float& first,
                                        float& last) {
    first = math::clamp(next_float(static_cast<float>(low), false), least, most);
    last = math::clamp(next_float(static_cast<float>(high), true), least, most);
  }
  // The neighbour of a finite float.
  ASTROLITH_HD static float next_float(float v, bool up) {
    if (v == 0.0f) return math::float_of(up ? 1 : std::int32_t(0x80000001u));
    return math::float_of(math::bits_of(v) + ((v > 0.0f) == up ? 1 : -1));
  }
  template <typename Visit>
  ASTROLITH_HD static void for_each_cell(const GaborDraw& band, const float* low, const float* high,
                                         const Visit& visit) {
    GaborCellSpan spans[3];
    for (int a = 0; a < 3; ++a) spans[a] = gabor_cells_around(band, low[a], high[a]);
    const auto of_tile = [](const GaborCellSpan& s, int tile) {
      return GaborCellSpan{std::max(s.first, tile * kTileCells),
                           std::min(s.last, tile * kTileCells + kTileCells - 1)};
    };
    for (int tz = gabor_tile_of(spans[2].first); tz <= gabor_tile_of(spans[2].last); ++tz) {
      for (int ty = gabor_tile_of(spans[1].first); ty <= gabor_tile_of(spans[1].last); ++ty) {
        for (int tx = gabor_tile_of(spans[0].first); tx <= gabor_tile_of(spans[0].last); ++tx) {
          const GaborCellSpan xs = of_tile(spans[0], tx), ys = of_tile(spans[1], ty),
                              zs = of_tile(spans[2], tz);
          for (int z = zs.first; z <= zs.last; ++z) {
            for (int y = ys.first; y <= ys.last; ++y) {
              for (int x = xs.first; x <= xs.last; ++x) visit(x, y, z);
            }
          }
        }
      }
    }
  }
};

}  // namespace astrolith
