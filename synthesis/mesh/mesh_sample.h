// Estimates what a mesh takes from a random sample of its blocks, before the mesh is made.
//
// The sample follows the mesher: it narrows squares of blocks down to blocks, layer by layer, and meshes the
// blocks. Of each size of squares it narrows only some, evenly spread over the surface, and each of them
// stands for as many as were left out. Few squares and blocks give a rough estimate at a small cost.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "numerics/processor_clock.h"
#include "synthesis/mesh/block_cost.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

struct SampleSize {
  int nodes = 256;       // most squares of each size that are narrowed
  int blocks = 256;      // most blocks that are meshed
  bool warm_up = false;  // blocks are meshed twice, and the second time counts: caches are filled then
};

struct MeshEstimate {
  int resolution = 0;
  double step = 0.0;  // edge of a cell, length units
  double blocks = 0.0, evaluations = 0.0, vertices = 0.0, triangles = 0.0;
  double sampled_blocks = 0.0;     // blocks that were meshed by this sample and the smaller ones before it
  double sampled_windows = 0.0;    // these, and blocks around places of the surface that were only sampled
  double seconds = 0.0;            // of one processor, for finding and meshing all blocks
  double crossed_seconds = 0.0;    // the part of these for blocks that the surface crosses
  double finding_seconds = 0.0;    // the part of these for finding the blocks
  double spent_seconds = 0.0;      // of one processor, for the sample
  double spent_evaluations = 0.0;  // of the field, for the sample
  double list_bytes = 0.0;         // memory of the field narrowed to one block
  double crossed_share = 1.0;      // share of the blocks that the surface crosses; the others it only might
  // The most blocks in one layer, and in three successive layers.
  double blocks_of_layer = 0.0, blocks_of_three_layers = 0.0;
  double places_of_layer = 0.0;  // of blocks in the grid, whether the surface may cross them or not
  int narrowed_squares = 0;      // most squares of one size that the sample narrowed
  double with_neighbour = 0.7;   // share of the blocks whose lower neighbour is a block too
  bool whole = false;            // every block was meshed: the counts are exact

  double triangles_per_block() const { return blocks > 0.0 ? triangles / blocks : 0.0; }
};

// The share that is left of what does not fit: systematic sampling in the order of the items, which keeps
// about count items. `weight` is the number of items that one item stands for.
std::vector<std::size_t> evenly_chosen(std::size_t size, std::size_t count, std::uint32_t seed);

// The largest sum of `layers` successive elements of a profile that `samples` items gave. Where items are
// few, the sum of a longer range is taken instead, and scaled.
double most_in_layers(const std::vector<double>& profile, const std::vector<int>& samples, int layers);

// What an estimate may take.
struct SampleBudget {
  int first_nodes = 18, first_blocks = 6;  // of the first and smallest sample
  double share = 0.03;                     // of the seconds that are predicted for the mesh,
  double free_seconds = 0.0;               // or this many seconds of one processor if these are more
};

// Calls sample() with growing sizes until the estimate has taken what it may.
MeshEstimate estimate_within(const std::function<MeshEstimate(const SampleSize&)>& sample, bool warm_up,
                             const SampleBudget& budget);

template <int B, BlockField Field>
class MeshSampler {
 public:
  using Block = decltype(std::declval<const Field&>().gather(Box{}));

  MeshSampler(const Field& field, const BlockGrid<B>& grid, const SampleSize& size)
      : grid_(grid),
        whole_(field.gather(grid.samples.box({0, 0, 0}, grid.samples.cells, grid.samples.step))),
        size_(size) {
    estimate_.step = grid.samples.step;
    estimate_.places_of_layer = double(grid.blocks(0)) * double(grid.blocks(1));
    estimate_.whole = true;
  }

  MeshEstimate run() {
    std::vector<Node> nodes = roots();
    while (!nodes.empty() && nodes.front().node.size > 1)
      nodes = narrowed(thinned(std::move(nodes), size_.nodes));
    count_layers(nodes);
    mesh(thinned(std::move(nodes), size_.blocks));
    return estimate_;
  }

 private:
  // A square of blocks of layer z that stands for `weight` squares.
  struct Node {
    int z;
    double weight;
    BlockNode<Block> node;
  };

  std::vector<Node> roots() {
    const auto [first, end] = layers_of_window(grid_);
    const unsigned longest = static_cast<unsigned>(std::max(grid_.blocks(0), grid_.blocks(1)));
    const int size = std::max(2, static_cast<int>(std::bit_ceil(longest)));
    const std::vector<std::size_t> layers =
        evenly_chosen(static_cast<std::size_t>(end - first), static_cast<std::size_t>(size_.nodes), 0);
    estimate_.whole = layers.size() == static_cast<std::size_t>(end - first);
    const double weight = double(end - first) / double(layers.size());
    const ProcessorClock clock;
    std::vector<Node> nodes;
    for (const std::size_t i : layers) {
      const int z = first + static_cast<int>(i);
      nodes.push_back({z, weight, {0, 0, size, whole_.restricted_to(grid_.box(0, 0, z, size))}});
    }
    estimate_.spent_seconds += clock.seconds();
    estimate_.finding_seconds += weight * clock.seconds();
    return nodes;
  }

  // Keeps about `count` of the nodes.
  std::vector<Node> thinned(std::vector<Node> nodes, int count) {
    const std::vector<std::size_t> chosen =
        evenly_chosen(nodes.size(), static_cast<std::size_t>(count), ++draws_);
    if (chosen.size() == nodes.size()) return nodes;
    estimate_.whole = false;
    std::vector<Node> kept;
    for (const std::size_t i : chosen) {
      kept.push_back(std::move(nodes[i]));
      kept.back().weight *= double(nodes.size()) / double(chosen.size());
    }
    return kept;
  }

  // The quarters of the nodes that the surface may cross.
  std::vector<Node> narrowed(const std::vector<Node>& nodes) {
    estimate_.narrowed_squares = std::max(estimate_.narrowed_squares, static_cast<int>(nodes.size()));
    std::vector<std::vector<BlockNode<Block>>> quarters(nodes.size());
    std::vector<double> seconds(nodes.size());
    parallel_for(0, static_cast<std::int64_t>(nodes.size()), [&](std::int64_t i) {
      const auto n = static_cast<std::size_t>(i);
      const ProcessorClock clock;
      quarters[n] = mixed_quarters(grid_, nodes[n].z, nodes[n].node);
      seconds[n] = clock.seconds();
    });
    std::vector<Node> next;
    double pairs = 0.0, both = 0.0;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      estimate_.spent_seconds += seconds[n];
      estimate_.finding_seconds += nodes[n].weight * seconds[n];
      for (auto& quarter : quarters[n]) {
        if (quarter.x > nodes[n].node.x) {
          pairs += 1.0;
          both += std::any_of(quarters[n].begin(), quarters[n].end(),
                              [&](const auto& other) { return other.x < quarter.x && other.y == quarter.y; });
        }
      }
      for (auto& quarter : quarters[n]) next.push_back({nodes[n].z, nodes[n].weight, std::move(quarter)});
    }
    if (pairs > 0.0) estimate_.with_neighbour = both / pairs;
    return next;
  }

  void count_layers(const std::vector<Node>& nodes) {
    const auto layers = static_cast<std::size_t>(grid_.blocks(2));
    std::vector<double> profile(layers, 0.0);
    std::vector<int> samples(layers, 0);
    for (const Node& node : nodes) {
      estimate_.blocks += node.weight;
      profile[static_cast<std::size_t>(node.z)] += node.weight;
      ++samples[static_cast<std::size_t>(node.z)];
    }
    if (estimate_.whole) samples.assign(layers, 1 << 20);
    estimate_.blocks_of_layer = most_in_layers(profile, samples, 1);
    estimate_.blocks_of_three_layers = most_in_layers(profile, samples, 3);
  }

  void mesh(const std::vector<Node>& nodes) {
    std::vector<BlockCost> costs(nodes.size());
    parallel_for(0, static_cast<std::int64_t>(nodes.size()), [&](std::int64_t i) {
      const Node& node = nodes[static_cast<std::size_t>(i)];
      costs[static_cast<std::size_t>(i)] =
          cost_of_block(grid_, node.z, node.node, estimate_.with_neighbour, size_.warm_up);
    });
    double weights = 0.0, crossed = 0.0;
    estimate_.sampled_blocks = estimate_.sampled_windows = double(nodes.size());
    estimate_.seconds = estimate_.finding_seconds;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const BlockCost& cost = costs[i];
      const double weight = nodes[i].weight;
      weights += weight;
      crossed += cost.counts.triangles > 0 ? weight : 0.0;
      estimate_.crossed_seconds += cost.counts.triangles > 0 ? weight * cost.seconds : 0.0;
      estimate_.evaluations += weight * cost.evaluations;
      estimate_.vertices += weight * cost.counts.vertices;
      estimate_.triangles += weight * cost.counts.triangles;
      estimate_.seconds += weight * cost.seconds;
      estimate_.list_bytes += weight * cost.list_bytes;
      estimate_.spent_seconds += cost.spent_seconds;
      estimate_.spent_evaluations += cost.spent_evaluations;
    }
    if (!(weights > 0.0)) return;
    estimate_.list_bytes /= weights;
    estimate_.crossed_share = crossed / weights;
  }

  BlockGrid<B> grid_;
  Block whole_;
  SampleSize size_;
  MeshEstimate estimate_;
  std::uint32_t draws_ = 0;
};

// The estimate for mesh_field() and mesh_patch() with the same arguments. Both throw as they do.
template <int B = kBlockCells, BlockField Field>
MeshEstimate sample_field(const Field& field, const Box& bounds, int resolution, MeshTile tile,
                          const SampleSize& size) {
  const SampleGrid grid = make_sample_grid(bounds, resolution);
  MeshEstimate estimate =
      MeshSampler<B, Field>(field, {grid, window_of_tile<B>(grid, tile), true}, size).run();
  estimate.resolution = resolution;
  return estimate;
}
template <int B = kBlockCells, BlockField Field>
MeshEstimate sample_patch(const Field& field, double patch_size, int resolution, const SampleSize& size) {
  const SampleGrid grid = make_patch_grid(patch_size, resolution);
  MeshEstimate estimate = MeshSampler<B, Field>(field, {grid, window_of_patch(grid), false}, size).run();
  estimate.resolution = resolution;
  return estimate;
}

}  // namespace astrolith
