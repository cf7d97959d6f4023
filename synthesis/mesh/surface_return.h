// Brings vertices that have left the surface back to F = 0, along the gradient of F at the places where they
// are. Vertices for which that fails stay where the mesh had them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/mesh_sink.h"
#include "numerics/reported_loop.h"
#include "synthesis/mesh/block_polygons.h"
#include "synthesis/mesh/block_sampling.h"
#include "synthesis/mesh/vertex_blocks.h"

namespace astrolith {

// A vertex on its way: its place is start + along * out, and it has the normal `out`.
struct ReturningVertex {
  std::uint32_t number;
  Vec3f start, out;
  float slope;                // length of the gradient at `start`
  float along;                // length units
  float before = 0.0f;        // the length before
  float value_before = 0.0f;  // F there

  Vec3f place() const { return start + out * along; }
};

// The vertices of a mesh, and |F| at those that have been brought back to the surface, 0 for the others.
struct SurfaceVertices {
  std::vector<MeshVertex> vertices;
  std::vector<float> values;
};

// Limits of the way back, in steps of the grid: the |F| at which a vertex has arrived, the |F| that will do
// after the last evaluation, and the distance between the place of a vertex and the surface.
inline constexpr float kNearSurface = 0x1p-10f, kFairlyNear = 0x1p-5f, kLongestReturn = 0.5f;
// The reach of the probes for a gradient along each axis, in steps of the grid.
inline constexpr float kProbeReach = 0.25f;
// The most evaluations of F for one vertex, after those for its gradient.
inline constexpr int kReturnEvaluations = 8;

template <FieldBlockLike Block>
class VertexReturn {
 public:
  VertexReturn(const Block& field, double step, SurfaceVertices& surface)
      : field_(field), step_(static_cast<float>(step)), surface_(surface) {}

  std::int64_t evaluations() const { return evaluations_; }

  // Brings some vertices back from their places, kVerticesPerBatch at the most.
  void bring_back(std::span<const std::uint32_t> numbers, std::span<const Vec3f> places) {
    set_out(numbers, places);
    for (int k = 0; k < kReturnEvaluations && !vertices_.empty(); ++k) take_step(k == kReturnEvaluations - 1);
    vertices_.clear();
  }

 private:
  // Takes the gradient from the values of F at the corners of a small tetrahedron around each place, as for
  // the normals of the mesher. Their mean is F at the place, but for its curvature.
  void set_out(std::span<const std::uint32_t> numbers, std::span<const Vec3f> places) {
    const float h = kProbeReach * step_;
    PointBatch<4 * kVerticesPerBatch> probes;
    for (const std::uint32_t number : numbers) {
      for (int k = 0; k < 4; ++k) {
        const Vec3f p = normal_probe(places[number], h, k);
        probes.add(p.x, p.y, p.z);
      }
    }
    probes.evaluate_tetrahedra(field_);
    evaluations_ += static_cast<std::int64_t>(probes.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      Vec3f gradient;
      float sum = 0.0f;
      for (int k = 0; k < 4; ++k) {
        const float value = probes.value(4 * i + static_cast<std::size_t>(k));
        gradient += tetrahedron_corner(k) * value;
        sum += value;
      }
      const float length = norm(gradient);
      if (!(length > 0.0f && length <= std::numeric_limits<float>::max())) continue;
      const float slope = length / (4.0f * h);
      vertices_.push_back(
          {numbers[i], places[numbers[i]], gradient * (-1.0f / length), slope, 0.25f * sum / slope});
    }
  }

  // Evaluates F where the vertices are. Those on the surface have arrived, the others go on.
  void take_step(bool is_last) {
    std::erase_if(vertices_,
                  [&](const ReturningVertex& v) { return !(std::fabs(v.along) <= kLongestReturn * step_); });
    PointBatch<kVerticesPerBatch> points;
    for (const ReturningVertex& v : vertices_) {
      const Vec3f p = v.place();
      points.add(p.x, p.y, p.z);
    }
    points.evaluate(field_);
    evaluations_ += static_cast<std::int64_t>(points.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      ReturningVertex v = vertices_[i];
      const float value = points.value(i);
      if (std::fabs(value) <= (is_last ? kFairlyNear : kNearSurface) * step_) {
        arrive(v, value);
      } else if (!is_last) {
        go_on(v, value);
        vertices_[kept++] = v;
      }
    }
    vertices_.resize(kept);
  }

  void arrive(const ReturningVertex& v, float value) {
    surface_.vertices[v.number] = {v.place(), v.out};
    surface_.values[v.number] = std::fabs(value);
  }

  // A step of Newton's with the slope at the start, then steps of the secant. No vertex goes on from F = 0,
  // so that 0 stands for no value before.
  static void go_on(ReturningVertex& v, float value) {
    const float fall = v.value_before != 0.0f ? (v.value_before - value) / (v.along - v.before) : v.slope;
    v.before = v.along;
    v.value_before = value;
    v.along += value / fall;
  }

  const Block& field_;
  float step_;
  SurfaceVertices& surface_;
  std::vector<ReturningVertex> vertices_;
  std::int64_t evaluations_ = 0;
};

// The cells along the side of the blocks in which vertices are brought back.
inline constexpr double kReturnBlock = 8.0;

// Brings the vertices of a mesh with cells of side `step` back to the surface from `places`. A vertex whose
// place is where it lies stays. Returns the number of evaluations of F. Throws WorkError where progress asks
// to stop.
template <BlockField Field>
std::int64_t return_to_surface(const Field& field, double step, std::span<const Vec3f> places,
                               SurfaceVertices& surface, const Progress& progress) {
  std::vector<std::uint32_t> moving;
  for (std::uint32_t v = 0; v < places.size(); ++v) {
    if (!(places[v] == surface.vertices[v].position)) moving.push_back(v);
  }
  if (moving.empty()) return 0;
  const VertexBlocks sorted = sort_into_blocks(places, std::move(moving), kReturnBlock * step);
  const auto box_of = [&](std::span<const std::uint32_t> numbers) {
    return widened(box_around(places, numbers), (double{kLongestReturn} + kProbeReach) * step);
  };
  const auto whole = field.gather(box_of(sorted.numbers));
  std::vector<std::optional<decltype(field.gather(Box{}))>> slabs(sorted.num_slabs());
  parallel_for(0, static_cast<std::int64_t>(slabs.size()), [&](std::int64_t i) {
    const auto s = static_cast<std::size_t>(i);
    const auto numbers = sorted.numbers_of(sorted.slabs[s], sorted.slabs[s + 1]);
    if (!numbers.empty()) slabs[s] = whole.restricted_to(box_of(numbers));
  });
  std::vector<std::int64_t> evaluations(sorted.blocks.size());
  const auto num_blocks = static_cast<std::int64_t>(sorted.blocks.size());
  reported_parallel_for({0, num_blocks, num_blocks}, progress, "even", [&](std::int64_t i) {
    const VertexBlock& block = sorted.blocks[static_cast<std::size_t>(i)];
    const auto numbers = sorted.numbers_of(block.begin, block.end);
    const auto narrowed = slabs[block.slab]->restricted_to(box_of(numbers));
    VertexReturn way(narrowed, step, surface);
    for (std::size_t k = 0; k < numbers.size(); k += kVerticesPerBatch)
      way.bring_back(numbers.subspan(k, std::min(kVerticesPerBatch, numbers.size() - k)), places);
    evaluations[static_cast<std::size_t>(i)] = way.evaluations();
  });
  return std::accumulate(evaluations.begin(), evaluations.end(), std::int64_t{0});
}

}  // namespace astrolith
