// Turns a field into a closed 2-manifold triangle mesh: marching cubes over sparse blocks, layer by layer.
//
// One layer of blocks at a time is culled by bounds of the field, sampled, numbered and polygonised, in
// parallel over blocks; the layer below is kept for the samples and vertices they share, so memory is bounded
// by two layers. Vertices and triangles come in rows of the whole grid: the bytes depend on the field, the
// bounds and the resolution alone.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/mesh_sink.h"
#include "numerics/progress.h"
#include "synthesis/block_culling.h"
#include "synthesis/block_layer.h"
#include "synthesis/block_polygons.h"
#include "synthesis/block_sampling.h"
#include "synthesis/sample_grid.h"

namespace astrolith {

struct MeshStatistics {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  std::int64_t evaluations = 0;    // of the field, at samples and for normals
  std::int64_t active_blocks = 0;  // that the surface may cross; the others were never sampled
  std::int64_t total_blocks = 0;
  std::int64_t working_bytes = 0;  // of two layers of blocks and one of vertices and triangles, at their most
  std::int64_t cut_vertices = 0;   // in the planes where a tile was cut: its open ones
  double step = 0.0;               // edge of a cell, length units

  // V - E + F with E = 3F/2, as in every closed mesh of triangles.
  std::int64_t euler_characteristic() const { return vertices - triangles / 2; }
};

// One of `count` slabs along z, each of whole layers of blocks. Its mesh is open where it was cut; the
// vertices there have the same bits in both tiles that share them, so tiles fit without cracks.
struct MeshTile {
  int index = 0;  // 0 .. count - 1
  int count = 1;
};

template <int B, BlockField Field>
class LayeredMesher {
 public:
  LayeredMesher(const Field& field, const Box& bounds, int resolution, MeshSink& sink)
      : grid_{make_sample_grid(bounds, resolution)}, whole_(field.gather(whole_box())), sink_(sink) {
    statistics_.step = grid_.samples.step;
    statistics_.total_blocks = std::int64_t{grid_.blocks(0)} * grid_.blocks(1) * grid_.blocks(2);
  }

  MeshStatistics run(MeshTile tile, const Progress& progress) {
    const auto [first, end] = layers_of(tile);
    const BlockLayer<B> nothing(grid_.blocks(0), grid_.blocks(1));
    BlockLayer<B> two_below = nothing;
    BlockLayer<B> below = first > 0 ? make_layer(first - 1, nothing, BlockPart::kTopPlane) : nothing;
    statistics_.cut_vertices = top_plane_vertices(below);
    for (int z = first; z < end; ++z) {
      BlockLayer<B> layer = make_layer(z, below, BlockPart::kAll);
      check_open_sides(below, two_below, layer, z == first ? kTop : kAllSides);
      two_below = std::move(below);
      below = std::move(layer);
      if (!report(progress, double(z + 1 - first) / (end - first),
                  std::to_string(statistics_.triangles) + " triangles")) {
        throw WorkError("mesher: stopped before the mesh was complete");
      }
    }
    check_open_sides(below, two_below, nothing, end == grid_.blocks(2) ? kAllSides : kAllButTop);
    if (end < grid_.blocks(2)) statistics_.cut_vertices += top_plane_vertices(below);
    return statistics_;
  }

 private:
  using Blocks = std::vector<BlockNode<decltype(std::declval<const Field&>().gather(Box{}))>>;

  Box whole_box() const { return grid_.samples.box({0, 0, 0}, grid_.samples.cells, grid_.samples.step); }

  struct LayerRange {
    int first, end;
  };
  LayerRange layers_of(MeshTile tile) const {
    const std::int64_t layers = grid_.blocks(2);
    if (tile.count < 1 || tile.count > layers || tile.index < 0 || tile.index >= tile.count) {
      throw InputError("tile: there is no tile " + std::to_string(tile.index + 1) + " of " +
                       std::to_string(tile.count) + "; at this resolution there can be up to " +
                       std::to_string(layers));
    }
    return {static_cast<int>(layers * tile.index / tile.count),
            static_cast<int>(layers * (tile.index + 1) / tile.count)};
  }

  static std::int64_t top_plane_vertices(const BlockLayer<B>& layer) {
    std::int64_t vertices = 0;
    for (const LayerBlock<B>& block : layer.blocks) vertices += count_top_plane(block);
    return vertices;
  }

  BlockLayer<B> make_layer(int z, const BlockLayer<B>& below, BlockPart part) {
    const Blocks active = mixed_blocks(grid_, whole_, z);
    BlockLayer<B> layer(grid_.blocks(0), grid_.blocks(1));
    layer.blocks.reserve(active.size());
    for (const auto& node : active) layer.add(node.x, node.y);
    statistics_.active_blocks += static_cast<std::int64_t>(active.size());
    sample(z, active, below, part, layer);
    const LayerCounts counts = number_rows(layer);
    emit_vertices(z, active, counts, part, layer);
    if (part == BlockPart::kAll) emit_triangles(counts, below, layer);
    note_memory(layer.blocks.size());
    return layer;
  }

  void note_memory(std::size_t blocks) {
    const std::size_t bytes = 2 * blocks * (sizeof(LayerBlock<B>) + sizeof(typename Blocks::value_type)) +
                              vertices_.capacity() * sizeof(MeshVertex) +
                              triangles_.capacity() * sizeof(Triangle);
    statistics_.working_bytes = std::max(statistics_.working_bytes, static_cast<std::int64_t>(bytes));
  }

  // Calls body(i) for every block in parallel and adds up the evaluations it returns.
  template <typename Body>
  void for_each_block(const BlockLayer<B>& layer, const Body& body) {
    std::vector<std::int64_t> evaluations(layer.blocks.size());
    parallel_for(0, static_cast<std::int64_t>(layer.blocks.size()), [&](std::int64_t i) {
      evaluations[static_cast<std::size_t>(i)] = body(static_cast<std::size_t>(i));
    });
    for (std::int64_t n : evaluations) statistics_.evaluations += n;
  }

  void sample(int z, const Blocks& active, const BlockLayer<B>& below, BlockPart part, BlockLayer<B>& layer) {
    for_each_block(layer, [&](std::size_t i) {
      LayerBlock<B>& block = layer.blocks[i];
      return evaluate_samples(grid_, z, active[i].field, find_owners(layer, below, block), block);
    });
    for_each_block(layer, [&](std::size_t i) {
      LayerBlock<B>& block = layer.blocks[i];
      borrow_samples(find_owners(layer, below, block), block);
      take_signs(block);
      count_rows(block, part);
      return std::int64_t{0};
    });
  }

  void emit_vertices(int z, const Blocks& active, const LayerCounts& counts, BlockPart part,
                     BlockLayer<B>& layer) {
    const std::int64_t limit = std::numeric_limits<std::uint32_t>::max();
    if (statistics_.vertices + counts.vertices > limit) {
      throw WorkError("mesher: more than 2^32 vertices; lower the resolution");
    }
    const auto first = static_cast<std::uint32_t>(statistics_.vertices);
    vertices_.resize(counts.vertices);
    for_each_block(layer, [&](std::size_t i) {
      return make_vertices(grid_, z, active[i].field, first, part, layer.blocks[i], std::span(vertices_));
    });
    sink_.add_vertices(vertices_);
    statistics_.vertices += counts.vertices;
  }

  void emit_triangles(const LayerCounts& counts, const BlockLayer<B>& below, BlockLayer<B>& layer) {
    triangles_.resize(counts.triangles);
    for_each_block(layer, [&](std::size_t i) {
      borrow_vertices(find_owners(layer, below, layer.blocks[i]), layer.blocks[i]);
      make_triangles(layer.blocks[i], std::span(triangles_));
      return std::int64_t{0};
    });
    sink_.add_triangles(triangles_);
    statistics_.triangles += counts.triangles;
  }

  BlockGrid<B> grid_;
  decltype(std::declval<const Field&>().gather(Box{})) whole_;
  MeshSink& sink_;
  MeshStatistics statistics_;
  // Of the layer in hand; kept for their memory.
  std::vector<MeshVertex> vertices_;
  std::vector<Triangle> triangles_;
};

// Cells along a block's side: 8 keeps a block's samples in the first-level cache.
inline constexpr int kBlockCells = 8;

// Meshes the surface F = 0, or a tile of it, with `resolution` cells along the longest side of bounds, which
// must hold the surface. A sample is inside when F > 0 strictly. Vertices carry unit normals out of the body.
// Throws InputError for bad bounds, resolution or tile, WorkError when a promise of the field is broken (the
// bounds cut the body, a bound culled the surface) or progress asks to stop.
template <int B = kBlockCells, BlockField Field>
MeshStatistics mesh_field(const Field& field, const Box& bounds, int resolution, MeshSink& sink,
                          const Progress& progress = {}, MeshTile tile = {}) {
  return LayeredMesher<B, Field>(field, bounds, resolution, sink).run(tile, progress);
}

}  // namespace astrolith
