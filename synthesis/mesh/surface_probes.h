// Improves the estimate of a mesh by looking at it in a few places of its surface.
//
// A coarse mesh tells where the surface is and how large. From points that lie evenly over it blocks are
// followed to both sides along the axis that is nearest to the normal, as long as the surface may cross them.
// They are counted, with the triangles of the finer mesh in them, for the area of the coarse mesh in the same
// column: the projections of both surfaces along the axis are alike, however rough the finer one is. Blocks
// between two sheets of the surface count once. One of the blocks is meshed for its cost.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
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
  double blocks_of_square = 0.0;  // blocks for an area of the coarse mesh as large as a side of a block
  // These are sums over the blocks that were meshed, each weighted by the blocks for which it stands.
  double weights = 0.0, seconds = 0.0, evaluations = 0.0, list_bytes = 0.0;
  double triangles = 0.0;
  double crossed = 0.0, crossed_seconds = 0.0;  // of the blocks that the surface crosses
  int meshed_blocks = 0;
  double spent_seconds = 0.0;
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
      sums.spent_evaluations += kStepsToSurface;
      look_along(column_through(center, nearest_axis(place.normal), shift_of(i)), i, sums);
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

  double triangles_in(const Window& place, const BlockNode<Block>& node, ProbeSums& sums) const {
    BlockLayer<B> layer;
    layer.blocks.emplace_back(0, 0);
    LayerBlock<B>& block = layer.blocks.front();
    Owners<B> owners{};
    owners[0] = &block;
    sums.spent_evaluations +=
        static_cast<double>(evaluate_samples(place.grid, 0, node.field, owners, block).evaluations);
    take_signs(block);
    count_rows(place.grid.window_of(0, 0, 0), block);
    return double(number_rows(layer).triangles);
  }

  // A column of blocks through a point, along the axis that is nearest to the normal there. It ends on both
  // sides before the first block that is not mixed.
  struct Column {
    std::vector<Window> places;
    std::vector<BlockNode<Block>> mixed;
    Box box;
  };

  Column column_through(const Vec3d& center, const Vec3d& axis, double shift) const {
    constexpr int kFarthest = 16, kNear = 1;
    const auto place_of = [&](int j) { return window(center + ((shift + double(j)) * side()) * axis); };
    const Block near = field_.gather(joined(place_of(-kNear).box(), place_of(kNear).box()));
    Column column;
    for (const int direction : {1, -1}) {
      for (int j = direction > 0 ? 0 : -1; std::abs(j) < kFarthest; j += direction) {
        const Window place = place_of(j);
        const Box box = place.box();
        column.box = joined(column.box, place.samples_box());
        BlockNode<Block> node{0, 0, 1, std::abs(j) <= kNear ? near.restricted_to(box) : field_.gather(box)};
        // The first block may lie off the surface that those beyond it cross.
        if (node.field.content() != BlockContent::kMixed) {
          if (j != 0) break;
          continue;
        }
        column.places.push_back(place);
        column.mixed.push_back(std::move(node));
      }
    }
    return column;
  }

  void look_along(const Column& column, int index, ProbeSums& sums) const {
    const std::vector<BlockNode<Block>>& mixed = column.mixed;
    const double area = surface_.area_within(column.box);
    if (mixed.empty() || !(area > 0.0)) return;
    // Where the surface lies off the coarse one, a column may hold a scrap of that. It does not count a
    // hundred times.
    constexpr double kLeastArea = 0.25;
    const double squares = std::max(area / (side() * side()), kLeastArea);
    for (std::size_t k = 0; k < mixed.size(); ++k) {
      sums.triangles_per_area += triangles_in(column.places[k], mixed[k], sums) / (squares * side() * side());
    }
    if (!costs_) return;
    const double weight = double(mixed.size()) / squares;
    sums.blocks_of_square += weight;
    const std::size_t chosen = static_cast<std::size_t>(index) % mixed.size();
    const BlockCost cost =
        cost_of_block(column.places[chosen].grid, 0, mixed[chosen], with_neighbour_, warm_up_);
    sums.weights += weight;
    sums.triangles += weight * double(cost.counts.triangles);
    sums.crossed += cost.counts.triangles > 0 ? weight : 0.0;
    sums.crossed_seconds += cost.counts.triangles > 0 ? weight * cost.seconds : 0.0;
    sums.seconds += weight * cost.seconds;
    sums.evaluations += weight * cost.evaluations;
    sums.list_bytes += weight * cost.list_bytes;
    sums.spent_evaluations += cost.spent_evaluations;
    ++sums.meshed_blocks;
  }

  static Box joined(Box box, const Box& other) {
    box.extend(other.min);
    box.extend(other.max);
    return box;
  }

  static Vec3d nearest_axis(const Vec3d& normal) {
    const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
    return x >= y && x >= z ? Vec3d{1, 0, 0} : y >= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
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
