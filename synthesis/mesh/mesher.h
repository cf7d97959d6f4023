// Turns a field into a closed 2-manifold triangle mesh: marching cubes over sparse blocks, layer by layer.
//
// Each layer of blocks is culled by bounds of the field, sampled, numbered and polygonised, in parallel over
// blocks. The layer below is kept for the samples and vertices that the two layers share. Two layers
// therefore bound the memory. The sink receives a layer while the next one is sampled, so that a sink that
// works on one thread keeps no other thread waiting. Vertices and triangles come in rows of the whole grid:
// the bytes depend on the field, the bounds and the resolution alone.
#pragma once

#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/mesh_sink.h"
#include "numerics/progress.h"
#include "numerics/unset_vector.h"
#include "synthesis/mesh/block_culling.h"
#include "synthesis/mesh/block_layer.h"
#include "synthesis/mesh/block_polygons.h"
#include "synthesis/mesh/block_sampling.h"
#include "synthesis/mesh/sample_grid.h"

namespace astrolith {

struct MeshStatistics {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  // Evaluations of the field, at samples and for normals. Samples whose signs are proven otherwise do not
  // count, so that a GPU, which proves none, states more.
  std::int64_t evaluations = 0;
  // Blocks that the surface may cross; the others are never sampled. A GPU has other bounds than the CPU.
  std::int64_t active_blocks = 0;
  std::int64_t total_blocks = 0;
  std::int64_t cut_vertices = 0;  // vertices in the planes where a tile or a patch is cut open
  double step = 0.0;              // edge of a cell, length units

  // V - E + F, where E = 3F/2 as in every closed triangle mesh.
  std::int64_t euler_characteristic() const { return vertices - triangles / 2; }
};

// One of `count` slabs along z, each of whole layers of blocks. The mesh of a tile is open where it is cut.
// Vertices there have the same bits in both tiles that share them, so that tiles fit without cracks.
struct MeshTile {
  int index = 0;  // 0 .. count - 1
  int count = 1;
};

// The cells of a tile. Throws InputError for a tile that does not exist.
template <int B>
CellWindow tile_window(const SampleGrid& grid, MeshTile tile) {
  const std::int64_t layers = (grid.cells[2] + B - 1) / B;
  if (tile.count < 1 || tile.count > layers || tile.index < 0 || tile.index >= tile.count) {
    throw InputError("tile: there is no tile " + std::to_string(tile.index + 1) + " of " +
                     std::to_string(tile.count) + "; at this resolution there can be up to " +
                     std::to_string(layers));
  }
  const auto layer = [&](int index) { return static_cast<int>(layers * index / tile.count); };
  return {{1, 1, B * layer(tile.index) + 1},
          {grid.cells[0], grid.cells[1], std::min(B * layer(tile.index + 1), grid.cells[2])}};
}

// The layers of blocks that a window needs, first .. end - 1.
struct LayerRange {
  int first, end;
};
// The first layer is the one that owns the samples in the lower side of the window.
template <int B>
LayerRange window_layers(const BlockGrid<B>& grid) {
  return {std::max(grid.window.first[2] - 2, 0) / B, (grid.window.last[2] - 1) / B + 1};
}

template <int B, BlockField Field>
class LayeredMesher {
 public:
  LayeredMesher(const Field& field, const BlockGrid<B>& grid, MeshSink& sink)
      : grid_(grid), whole_(field.gather(whole_box())), sink_(sink) {
    statistics_.step = grid_.samples.step;
    statistics_.total_blocks = std::int64_t{grid_.blocks(0)} * grid_.blocks(1) * grid_.blocks(2);
  }

  MeshStatistics run(const Progress& progress) {
    const auto [first, end] = window_layers(grid_);
    BlockLayer<B> two_below(grid_.blocks(0), grid_.blocks(1)), below = two_below, layer = two_below;
    for (int z = first; z < end; ++z) {
      make_layer(z, below, layer);
      if (z > first) check_open_sides(grid_, z - 1, below, z > first + 1 ? &two_below : nullptr, &layer);
      std::swap(two_below, below);
      std::swap(below, layer);
      if (!report(progress, double(z + 1 - first) / (end - first),
                  std::to_string(statistics_.triangles) + " triangles")) {
        throw WorkError("mesher: stopped before the mesh was complete");
      }
    }
    check_open_sides<B>(grid_, end - 1, below, end > first + 1 ? &two_below : nullptr, nullptr);
    pass_on();
    return statistics_;
  }

 private:
  using Blocks = std::vector<BlockNode<decltype(std::declval<const Field&>().gather(Box{}))>>;

  Box whole_box() const { return grid_.samples.box({0, 0, 0}, grid_.samples.cells, grid_.samples.step); }

  void make_layer(int z, const BlockLayer<B>& below, BlockLayer<B>& layer) {
    const Blocks active = mixed_blocks(grid_, whole_, z);
    layer.clear();
    layer.blocks.reserve(active.size());
    for (const auto& node : active) layer.add(node.x, node.y);
    statistics_.active_blocks += static_cast<std::int64_t>(active.size());
    sample(z, active, below, layer);
    const LayerCounts counts = number_rows(layer);
    emit_vertices(z, active, counts, layer);
    emit_triangles(z, counts, below, layer);
    statistics_.vertices += counts.vertices;
    statistics_.triangles += counts.triangles;
  }

  // Gives the vertices and triangles of the last layer to the sink.
  void pass_on() { sink_.add_batch(vertices_, triangles_); }

  // Calls body(i) for every block in parallel and adds up the counts it returns.
  template <typename Body>
  static std::int64_t for_each_block(const BlockLayer<B>& layer, const Body& body) {
    std::vector<std::int64_t> counts(layer.blocks.size());
    parallel_for(0, static_cast<std::int64_t>(layer.blocks.size()), [&](std::int64_t i) {
      counts[static_cast<std::size_t>(i)] = body(static_cast<std::size_t>(i));
    });
    return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  }

  // Samples a layer, while the sink receives the layer before it.
  void sample(int z, const Blocks& active, const BlockLayer<B>& below, BlockLayer<B>& layer) {
    std::vector<std::int64_t> evaluations(layer.blocks.size());
    parallel_for(-1, static_cast<std::int64_t>(layer.blocks.size()), [&](std::int64_t i) {
      if (i < 0) return pass_on();
      const auto n = static_cast<std::size_t>(i);
      LayerBlock<B>& block = layer.blocks[n];
      evaluations[n] =
          evaluate_samples(grid_, z, active[n].field, find_owners(layer, below, block), block).evaluations;
    });
    for (const std::int64_t count : evaluations) statistics_.evaluations += count;
    statistics_.cut_vertices += for_each_block(layer, [&](std::size_t i) {
      LayerBlock<B>& block = layer.blocks[i];
      fill_sample_halo(find_owners(layer, below, block), block);
      take_signs(block);
      return count_rows(grid_.block_window(block.x, block.y, z), block);
    });
  }

  void emit_vertices(int z, const Blocks& active, const LayerCounts& counts, BlockLayer<B>& layer) {
    const std::int64_t limit = std::numeric_limits<std::uint32_t>::max();
    if (statistics_.vertices + counts.vertices > limit) {
      throw WorkError("mesher: more than 2^32 vertices; lower the resolution");
    }
    const auto first = static_cast<std::uint32_t>(statistics_.vertices);
    vertices_.resize(counts.vertices);
    statistics_.evaluations += for_each_block(layer, [&](std::size_t i) {
      return make_vertices(grid_, z, active[i].field, first, layer.blocks[i], std::span(vertices_));
    });
  }

  void emit_triangles(int z, const LayerCounts& counts, const BlockLayer<B>& below, BlockLayer<B>& layer) {
    triangles_.resize(counts.triangles);
    for_each_block(layer, [&](std::size_t i) {
      LayerBlock<B>& block = layer.blocks[i];
      const BlockWindow<B> window = grid_.block_window(block.x, block.y, z);
      fill_vertex_halo(find_owners(layer, below, block), window, block);
      make_triangles(block, window, std::span(triangles_));
      return std::int64_t{0};
    });
  }

  BlockGrid<B> grid_;
  decltype(std::declval<const Field&>().gather(Box{})) whole_;
  MeshSink& sink_;
  MeshStatistics statistics_;
  // Vertices and triangles of the current layer; the vectors are kept for their memory.
  UnsetVector<MeshVertex> vertices_;
  UnsetVector<Triangle> triangles_;
};

// Cells along the side of a block. The samples of a block of 8^3 cells fit into the first-level cache.
inline constexpr int kBlockCells = 8;

// Meshes the surface F = 0, or a tile of it, with `resolution` cells along the longest side of `bounds`,
// which must hold the surface. A sample is inside when F > 0. Vertices carry unit normals out of the body.
// Throws InputError for bad bounds, a bad resolution or a bad tile. Throws WorkError when progress asks to
// stop, and when the field breaks a promise: the bounds cut the body, or a bound culled the surface.
template <int B = kBlockCells, BlockField Field>
MeshStatistics mesh_field(const Field& field, const Box& bounds, int resolution, MeshSink& sink,
                          const Progress& progress = {}, MeshTile tile = {}) {
  const SampleGrid grid = make_sample_grid(bounds, resolution);
  return LayeredMesher<B, Field>(field, {grid, tile_window<B>(grid, tile), true}, sink).run(progress);
}

// Meshes the part of the surface F = 0 that lies in a cube of side `size` around the origin of the field,
// with `resolution` cells along the sides of the cube. The mesh is open where the cube cuts the surface.
// Throws as mesh_field does.
template <int B = kBlockCells, BlockField Field>
MeshStatistics mesh_patch(const Field& field, double size, int resolution, MeshSink& sink,
                          const Progress& progress = {}) {
  const SampleGrid grid = make_patch_grid(size, resolution);
  return LayeredMesher<B, Field>(field, {grid, patch_window(grid), false}, sink).run(progress);
}

}  // namespace astrolith
