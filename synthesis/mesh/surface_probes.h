// Improves the estimate of a mesh by looking at it in a few places of its surface.
//
// A coarse mesh tells where the surface is and how large. At points that lie evenly over it a window of one
// block counts the triangles of the finer mesh, for the area of the coarse mesh in the same window. This
// ratio varies little from place to place, while the triangles in blocks that the surface may cross range
// from none to many. From each point blocks are followed along the normal to both sides, as long as the
// surface may cross them: their number gives the volume of such blocks, and one of them is meshed for its
// cost.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "numerics/hash_random.h"
#include "synthesis/mesh/mesh_sample.h"
#include "synthesis/mesh/probed_surface.h"

namespace astrolith {

// Sums over the probes.
struct ProbeSums {
  int probes = 0;
  double triangles_per_area = 0.0;
  double blocks_along_normal = 0.0;
  // These four are sums over the blocks that were meshed, each weighted by the blocks along its normal.
  double weights = 0.0, seconds = 0.0, evaluations = 0.0, list_bytes = 0.0;
  int meshed_blocks = 0;
  double caching_seconds = 0.0, spent_seconds = 0.0;
  double spent_evaluations = 0.0;  // of the field, for all probes
};

// The estimate with the counts of probes of its surface, and with the seconds that follow from them.
MeshEstimate improved_by_probes(const MeshEstimate& estimate, const ProbedSurface& surface,
                                const ProbeSums& sums);

template <int B, BlockField Field>
class SurfaceProber {
 public:
  // Probes a mesh of cells of this size. `reach` limits how far the surface is looked for from the coarse
  // one; length units. Without `costs` only triangles are counted. The field and the surface must outlive
  // this.
  SurfaceProber(const Field& field, const ProbedSurface& surface, double step, double reach,
                double with_neighbour, bool warm_up, bool costs)
      : field_(field),
        surface_(surface),
        step_(step),
        reach_(reach),
        with_neighbour_(with_neighbour),
        warm_up_(warm_up),
        costs_(costs) {}

  // Adds the probes first .. first + count - 1 to the sums.
  void add(int first, int count, ProbeSums& sums) const {
    for (int i = first; i < first + count; ++i) {
      const ProcessorClock clock;
      const ProbedSurface::Point place = surface_.point(i);
      const Vec3d center = on_surface(place);
      const double area = surface_.area_within(window(place.position).samples_box());
      sums.spent_evaluations += kStepsToSurface;
      if (area > 0.0) sums.triangles_per_area += triangles_around(center, sums) / area;
      if (costs_) look_along(center, place.normal, i, sums);
      ++sums.probes;
      sums.spent_seconds += clock.seconds();
    }
  }

 private:
  using Block = decltype(std::declval<const Field&>().gather(Box{}));

  static constexpr int kStepsToSurface = 2;

  double side() const { return B * step_; }

  struct Window {
    BlockGrid<B> grid;
    Box samples_box() const { return grid.samples.box({0, 0, 0}, grid.samples.cells, 0.0); }
    Box box() const { return grid.box(0, 0, 0, 1); }
  };
  Window window(const Vec3d& center) const {
    const double half = 0.5 * side();
    const SampleGrid samples{center - Vec3d{half, half, half}, step_, {B, B, B}};
    return {{samples, {{1, 1, 1}, {B, B, B}}, false}};
  }

  BlockNode<Block> node_of(const Window& place) const { return {0, 0, 1, field_.gather(place.box())}; }

  double value_at(const Vec3d& p) const {
    const std::array<float, 1> x{static_cast<float>(p.x)}, y{static_cast<float>(p.y)},
        z{static_cast<float>(p.z)};
    std::array<float, 1> value{};
    field_.gather(widened({p, p}, 0.25 * step_))
        .evaluate(std::span<const float>(x), std::span<const float>(y), std::span<const float>(z),
                  std::span<float>(value), kExactEverywhere);
    return double{value[0]};
  }

  // The point of the surface near a point of the coarse one. F is nearly a distance there.
  Vec3d on_surface(const ProbedSurface::Point& place) const {
    double offset = 0.0;
    for (int step = 0; step < kStepsToSurface; ++step) {
      offset += value_at(place.position + offset * place.normal);
      offset = std::clamp(offset, -reach_, reach_);
    }
    return place.position + offset * place.normal;
  }

  double triangles_around(const Vec3d& center, ProbeSums& sums) const {
    const Window place = window(center);
    const BlockNode<Block> node = node_of(place);
    if (node.field.content() != BlockContent::kMixed) return 0.0;
    BlockLayer<B> layer;
    layer.blocks.emplace_back(0, 0);
    LayerBlock<B>& block = layer.blocks.front();
    Owners<B> owners{};
    owners[0] = &block;
    sums.spent_evaluations += static_cast<double>(evaluate_samples(place.grid, 0, node.field, owners, block));
    take_signs(block);
    count_rows(place.grid.window_of(0, 0, 0), block);
    return double(number_rows(layer).triangles);
  }

  void look_along(const Vec3d& center, const Vec3d& normal, int index, ProbeSums& sums) const {
    constexpr int kFarthest = 16;
    const double start = shift_of(index);
    std::vector<Window> places;
    std::vector<BlockNode<Block>> mixed;
    for (const int direction : {1, -1}) {
      for (int j = direction > 0 ? 0 : 1; j < kFarthest; ++j) {
        const Window place = window(center + ((start + double(direction * j)) * side()) * normal);
        BlockNode<Block> node = node_of(place);
        // The first block may lie off the surface that those beyond it cross.
        if (node.field.content() != BlockContent::kMixed) {
          if (j > 0) break;
          continue;
        }
        places.push_back(place);
        mixed.push_back(std::move(node));
      }
    }
    sums.blocks_along_normal += double(mixed.size());
    if (mixed.empty()) return;
    const std::size_t chosen = static_cast<std::size_t>(index) % mixed.size();
    const BlockCost cost = cost_of_block(places[chosen].grid, 0, mixed[chosen], with_neighbour_, warm_up_);
    const double weight = double(mixed.size());
    sums.weights += weight;
    sums.seconds += weight * cost.seconds;
    sums.evaluations += weight * cost.evaluations;
    sums.list_bytes += weight * cost.list_bytes;
    sums.caching_seconds += cost.caching_seconds;
    sums.spent_evaluations += cost.spent_evaluations;
    ++sums.meshed_blocks;
  }

  // A number in [0, 1) that goes with no other of the probe.
  static double shift_of(int index) {
    return double(hash_append(static_cast<std::uint32_t>(index), 7) >> 8) * 0x1p-24;
  }

  const Field& field_;
  const ProbedSurface& surface_;
  double step_, reach_, with_neighbour_;
  bool warm_up_, costs_;
};

}  // namespace astrolith
