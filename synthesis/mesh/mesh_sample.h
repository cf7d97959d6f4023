// Estimates what a mesh takes from a random sample of its blocks, before the mesh is made.
//
// The sample follows the mesher: it narrows squares of blocks down to blocks, layer by layer, and meshes the
// blocks. Of each size of squares it narrows only some, evenly spread over the surface, and each of them
// stands for as many as were left out. Few squares and blocks give a rough estimate at a small cost.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "synthesis/mesh/mesher.h"
#include "synthesis/mesh/processor_clock.h"

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
  double sampled_blocks = 0.0;   // blocks that were meshed by this sample and the smaller ones before it
  double seconds = 0.0;          // of one processor, for finding and meshing all blocks
  double spent_seconds = 0.0;    // of one processor, for the sample
  double caching_seconds = 0.0;  // of one processor, by which meshing the sample first took longer than again
  double list_bytes = 0.0;       // memory of the field narrowed to one block
  // The most blocks in one layer, and in three successive layers.
  double blocks_of_layer = 0.0, blocks_of_three_layers = 0.0;
  // Triangles of the body without its layers in the same blocks, and how they go with those of the mesh over
  // the blocks of the sample (-1 to 1); 0 where the field does not give them.
  double bare_triangles = 0.0, bare_correlation = 0.0;
  bool whole = false;  // every block was meshed: the counts are exact

  double triangles_per_block() const { return blocks > 0.0 ? triangles / blocks : 0.0; }
};

// The share that is left of what does not fit: systematic sampling in the order of the items, which keeps
// about count items. `weight` is the number of items that one item stands for.
std::vector<std::size_t> evenly_chosen(std::size_t size, std::size_t count, std::uint32_t seed);

// The largest sum of `layers` successive elements of a profile that `samples` items gave. Where items are
// few, the sum of a longer range is taken instead, and scaled.
double most_in_layers(const std::vector<double>& profile, const std::vector<int>& samples, int layers);

// A better estimate of a mesh by that of the body without its layers, whose cheap blocks can be sampled more
// often: where both have more and fewer triangles in the same blocks, the sample of the mesh had as much too
// many or too few as that of the body.
MeshEstimate corrected_by_bare(MeshEstimate mesh, double bare_triangles);

// What an estimate may take.
struct SampleBudget {
  int first_blocks = 6;       // of the first and smallest sample
  double share = 0.03;        // of the seconds that are predicted for the mesh,
  double free_seconds = 0.0;  // or this many seconds of one processor if these are more
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
    estimate_.seconds += weight * clock.seconds();
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
      estimate_.seconds += nodes[n].weight * seconds[n];
      for (auto& quarter : quarters[n]) {
        if (quarter.x > nodes[n].node.x) {
          pairs += 1.0;
          both += std::any_of(quarters[n].begin(), quarters[n].end(),
                              [&](const auto& other) { return other.x < quarter.x && other.y == quarter.y; });
        }
      }
      for (auto& quarter : quarters[n]) next.push_back({nodes[n].z, nodes[n].weight, std::move(quarter)});
    }
    if (pairs > 0.0) with_neighbour_ = both / pairs;
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

  struct BlockCost {
    double bare_triangles = 0.0;
    double seconds = 0.0, first_seconds = 0.0, evaluations = 0.0, list_bytes = 0.0;
    LayerCounts counts;
  };

  void mesh(const std::vector<Node>& nodes) {
    std::vector<BlockCost> costs(nodes.size());
    parallel_for(0, static_cast<std::int64_t>(nodes.size()), [&](std::int64_t i) {
      costs[static_cast<std::size_t>(i)] = cost_of(nodes[static_cast<std::size_t>(i)]);
    });
    double weights = 0.0;
    estimate_.sampled_blocks = double(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const BlockCost& cost = costs[i];
      const double weight = nodes[i].weight;
      weights += weight;
      estimate_.evaluations += weight * cost.evaluations;
      estimate_.vertices += weight * cost.counts.vertices;
      estimate_.triangles += weight * cost.counts.triangles;
      estimate_.bare_triangles += weight * cost.bare_triangles;
      estimate_.seconds += weight * cost.seconds;
      estimate_.list_bytes += weight * cost.list_bytes;
      estimate_.spent_seconds += cost.seconds + cost.first_seconds;
      if (size_.warm_up) estimate_.caching_seconds += std::max(cost.first_seconds - cost.seconds, 0.0);
    }
    if (weights > 0.0) estimate_.list_bytes /= weights;
    correlate(costs);
  }

  void correlate(const std::vector<BlockCost>& costs) {
    double xx = 0.0, xy = 0.0, yy = 0.0, x_mean = 0.0, y_mean = 0.0;
    for (const BlockCost& cost : costs) {
      x_mean += cost.bare_triangles / double(costs.size());
      y_mean += cost.counts.triangles / double(costs.size());
    }
    for (const BlockCost& cost : costs) {
      const double x = cost.bare_triangles - x_mean, y = cost.counts.triangles - y_mean;
      xx += x * x, xy += x * y, yy += y * y;
    }
    if (xx > 0.0 && yy > 0.0) estimate_.bare_correlation = xy / std::sqrt(xx * yy);
  }

  // The body of a block without its layers, as a block of its own.
  struct BareBlock {
    const Block& block;
    BlockContent content() const { return block.content(); }
    BareBlock restricted_to(const Box&) const { return *this; }
    void evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                  std::span<float> value, float) const {
      block.evaluate_bare(x, y, z, value);
    }
  };

  double bare_triangles_of(const Node& node) const {
    BlockLayer<B> layer;
    layer.blocks.emplace_back(node.node.x, node.node.y);
    LayerBlock<B>& block = layer.blocks.front();
    Owners<B> owners{};
    owners[0] = &block;
    evaluate_samples(grid_, node.z, BareBlock{node.node.field}, owners, block);
    take_signs(block);
    count_rows(grid_.window_of(block.x, block.y, node.z), block);
    return number_rows(layer).triangles;
  }

  BlockCost cost_of(const Node& node) const {
    BlockCost cost;
    if (size_.warm_up) {
      cost = meshed(node);
      const double first = cost.seconds;
      cost = meshed(node);
      cost.first_seconds = first;
    } else {
      cost = meshed(node);
    }
    if constexpr (requires { node.node.field.list_bytes(); }) {
      cost.list_bytes = node.node.field.list_bytes();
      cost.bare_triangles = bare_triangles_of(node);
    }
    return cost;
  }

  // Meshes one block without its neighbours. In a mesh the neighbours evaluate part of its halo.
  BlockCost meshed(const Node& node) const {
    const ProcessorClock clock;
    BlockLayer<B> layer;
    layer.blocks.emplace_back(node.node.x, node.node.y);
    LayerBlock<B>& block = layer.blocks.front();
    Owners<B> owners{};
    owners[0] = &block;
    const auto samples = static_cast<double>(evaluate_samples(grid_, node.z, node.node.field, owners, block));
    constexpr double kOwned = double(B) * B * B;
    const double own = std::min(samples, kOwned) + (1.0 - with_neighbour_) * std::max(samples - kOwned, 0.0);
    BlockCost cost;
    cost.seconds = samples > 0.0 ? clock.seconds() * own / samples : 0.0;
    const ProcessorClock rest;
    take_signs(block);
    count_rows(grid_.window_of(block.x, block.y, node.z), block);
    cost.counts = number_rows(layer);
    std::vector<MeshVertex> vertices(cost.counts.vertices);
    cost.evaluations =
        own + double(make_vertices(grid_, node.z, node.node.field, 0, block, std::span(vertices)));
    make_polygons(node.z, cost.counts, block);
    cost.seconds += rest.seconds();
    return cost;
  }

  // The work of a mesh that needs neighbours: the block stands for each of them.
  void make_polygons(int z, const LayerCounts& counts, LayerBlock<B>& block) const {
    Owners<B> owners;
    owners.fill(&block);
    const BlockWindow<B> window = grid_.window_of(block.x, block.y, z);
    fill_sample_halo(owners, block);
    fill_vertex_halo(owners, window, block);
    std::vector<Triangle> triangles(counts.triangles);
    make_triangles(block, window, std::span(triangles));
  }

  BlockGrid<B> grid_;
  Block whole_;
  SampleSize size_;
  MeshEstimate estimate_;
  double with_neighbour_ = 0.7;  // share of the blocks whose lower neighbour is a block too
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
