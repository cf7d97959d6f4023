// Fills the samples of a layer's blocks: first each block what it owns, and what nobody else will; then what
// its lower neighbours own.
#pragma once

#include <cstdint>
#include <vector>

#include "synthesis/block_culling.h"
#include "synthesis/block_layer.h"

namespace astrolith {

// Points gathered for one call of a field block.
struct PointBatch {
  void add(float px, float py, float pz) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
  }
  template <FieldBlockLike Block>
  void evaluate(const Block& field, float band = kExactEverywhere) {
    value.resize(x.size());
    if (!x.empty()) field.evaluate(x, y, z, value, band);
  }

  std::vector<float> x, y, z, value;
};

// Samples beyond the grid, in blocks that stick out of it, and all samples before they are known.
inline constexpr float kOutsideGrid = -1.0f;

// In steps of the grid. Along an edge a distance changes by about a step, so both ends of an edge that the
// surface crosses lie within the band. Where a field is steeper an end may lie beyond: its sign still is
// right, and the vertex stays on its edge.
inline constexpr double kSampleBand = 2.0;

// Evaluates the samples whose owner is the block itself or no active block; returns how many. Throws
// WorkError when a sample on the grid's border is inside.
template <int B, FieldBlockLike Block>
std::int64_t evaluate_samples(const BlockGrid<B>& grid, int layer_z, const Block& field,
                              const Owners<B>& owners, LayerBlock<B>& block) {
  PointBatch batch;
  std::vector<std::size_t> slots;
  bool at_border = false;
  std::vector<bool> on_border;
  block.values.fill(kOutsideGrid);
  const auto [nx, ny, nz] = grid.samples.cells;
  for (int z = 0; z <= B; ++z) {
    for (int y = 0; y <= B; ++y) {
      for (int x = 0; x <= B; ++x) {
        const unsigned owner = owner_of(x, y, z);
        if (owner != 0 && owners[owner] != nullptr) continue;
        const int gx = block.x * B + x, gy = block.y * B + y, gz = layer_z * B + z;
        if (gx > nx || gy > ny || gz > nz) continue;
        batch.add(grid.samples.x(gx), grid.samples.y(gy), grid.samples.z(gz));
        slots.push_back(LayerBlock<B>::sample(x, y, z));
        on_border.push_back(gx == 0 || gy == 0 || gz == 0 || gx == nx || gy == ny || gz == nz);
      }
    }
  }
  batch.evaluate(field, static_cast<float>(kSampleBand * grid.samples.step));
  for (std::size_t i = 0; i < slots.size(); ++i) {
    block.values[slots[i]] = batch.value[i];
    at_border = at_border || (on_border[i] && batch.value[i] > 0.0f);
  }
  if (at_border) fail_at_border();
  return static_cast<std::int64_t>(slots.size());
}

// Copies what active lower neighbours own.
template <int B>
void borrow_samples(const Owners<B>& owners, LayerBlock<B>& block) {
  for (int z = 0; z <= B; ++z) {
    for (int y = 0; y <= B; ++y) {
      const bool inner_row = y != 0 && z != 0;
      for (int x = 0; x <= (inner_row ? 0 : B); ++x) {
        const LayerBlock<B>* owner = owners[owner_of(x, y, z)];
        if (owner == nullptr || owner == &block) continue;
        block.values[LayerBlock<B>::sample(x, y, z)] =
            owner->values[LayerBlock<B>::sample(x == 0 ? B : x, y == 0 ? B : y, z == 0 ? B : z)];
      }
    }
  }
}

// Throws WorkError when the surface crosses side 0 .. 5 (axis, then low or high) of a block whose neighbour
// there was proved free of surface: the mesh would have a hole.
template <int B>
void check_side_is_uncrossed(const LayerBlock<B>& block, int side) {
  const int axis = side / 2;
  const int fixed = side % 2 != 0 ? B : 0;
  const auto inside = [&](int u, int v) {
    return axis == 0   ? block.inside(fixed, u, v)
           : axis == 1 ? block.inside(u, fixed, v)
                       : block.inside(u, v, fixed);
  };
  for (int v = 0; v <= B; ++v) {
    for (int u = 0; u <= B; ++u) {
      if (inside(u, v) != inside(0, 0)) {
        throw WorkError("mesher: the surface enters a block that a bound of the field proved free of it");
      }
    }
  }
}

// All sides of a layer that border on nothing active; above's blocks are known by now.
template <int B>
void check_open_sides(const BlockLayer<B>& layer, const BlockLayer<B>& below, const BlockLayer<B>& above) {
  parallel_for(0, static_cast<std::int64_t>(layer.blocks.size()), [&](std::int64_t i) {
    const LayerBlock<B>& block = layer.blocks[static_cast<std::size_t>(i)];
    const std::array<const LayerBlock<B>*, 6> neighbours = {
        layer.find(block.x - 1, block.y), layer.find(block.x + 1, block.y), layer.find(block.x, block.y - 1),
        layer.find(block.x, block.y + 1), below.find(block.x, block.y),     above.find(block.x, block.y)};
    for (int side = 0; side < 6; ++side) {
      if (neighbours[static_cast<unsigned>(side)] == nullptr) check_side_is_uncrossed(block, side);
    }
  });
}

}  // namespace astrolith
