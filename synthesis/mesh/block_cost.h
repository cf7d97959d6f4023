// What the mesher takes for one block, found by meshing the block without its neighbours.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "numerics/processor_clock.h"
#include "synthesis/mesh/block_layer.h"
#include "synthesis/mesh/block_polygons.h"
#include "synthesis/mesh/block_sampling.h"

namespace astrolith {

struct BlockCost {
  double seconds = 0.0;            // of one processor
  double spent_seconds = 0.0;      // of one processor, for finding these figures
  double spent_evaluations = 0.0;  // of the field, for finding these figures
  double evaluations = 0.0, list_bytes = 0.0;
  LayerCounts counts;
};

// Polygons need neighbours: the block stands for each of them.
template <int B>
void make_lone_polygons(const BlockGrid<B>& grid, int z, const LayerCounts& counts, LayerBlock<B>& block) {
  Owners<B> owners;
  owners.fill(&block);
  const BlockWindow<B> window = grid.window_of(block.x, block.y, z);
  fill_sample_halo(owners, block);
  fill_vertex_halo(owners, window, block);
  std::vector<Triangle> triangles(counts.triangles);
  make_triangles(block, window, std::span(triangles));
}

// Meshes one block once. In a mesh a block shares samples with lower neighbours, which `with_neighbour` of
// the blocks have.
template <int B, FieldBlockLike Block>
BlockCost cost_of_meshing(const BlockGrid<B>& grid, int z, const BlockNode<Block>& node,
                          double with_neighbour) {
  const ProcessorClock clock;
  BlockLayer<B> layer;
  layer.blocks.emplace_back(node.x, node.y);
  LayerBlock<B>& block = layer.blocks.front();
  Owners<B> owners{};
  owners[0] = &block;
  const SampleCounts taken = evaluate_samples(grid, z, node.field, owners, block);
  const auto samples = static_cast<double>(taken.samples),
             of_samples = static_cast<double>(taken.evaluations);
  constexpr double kOwned = double(B) * B * B;
  const double own = std::min(samples, kOwned) + (1.0 - with_neighbour) * std::max(samples - kOwned, 0.0);
  const double own_share = samples > 0.0 ? own / samples : 0.0;
  BlockCost cost;
  cost.seconds = clock.seconds() * own_share;
  const ProcessorClock rest;
  take_signs(block);
  count_rows(grid.window_of(block.x, block.y, z), block);
  cost.counts = number_rows(layer);
  std::vector<MeshVertex> vertices(cost.counts.vertices);
  const auto of_vertices =
      static_cast<double>(make_vertices(grid, z, node.field, 0, block, std::span(vertices)));
  cost.evaluations = of_samples * own_share + of_vertices;
  cost.spent_evaluations = of_samples + of_vertices;
  make_lone_polygons(grid, z, cost.counts, block);
  cost.seconds += rest.seconds();
  cost.spent_seconds = clock.seconds();
  return cost;
}

// The cost of a block. With `warm_up` it is meshed twice, and the second time counts: caches are filled then.
template <int B, FieldBlockLike Block>
BlockCost cost_of_block(const BlockGrid<B>& grid, int z, const BlockNode<Block>& node, double with_neighbour,
                        bool warm_up) {
  BlockCost cost = cost_of_meshing(grid, z, node, with_neighbour);
  if (warm_up) {
    const BlockCost first = cost;
    cost = cost_of_meshing(grid, z, node, with_neighbour);
    cost.spent_seconds += first.spent_seconds;
    cost.spent_evaluations += first.spent_evaluations;
  }
  if constexpr (requires { node.field.list_bytes(); }) cost.list_bytes = node.field.list_bytes();
  return cost;
}

}  // namespace astrolith
