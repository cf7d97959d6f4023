// Makes the triangles of a finished mesh more even. Marching cubes leaves slivers where the surface passes
// near a sample: one triangle in a hundred has a quality below .03. Two sweeps move the vertices along the
// surface, each to the mean of its neighbours, and Newton's steps bring them back to F = 0. Triangles keep
// their vertices, so that the mesh is as closed and as manifold as before.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_sink.h"
#include "numerics/progress.h"
#include "numerics/reported_loop.h"
#include "numerics/vec3.h"
#include "synthesis/mesh/block_polygons.h"
#include "synthesis/mesh/block_sampling.h"

namespace astrolith {

class RecordedMesh : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex> batch) override {
    vertices.insert(vertices.end(), batch.begin(), batch.end());
    batches_.push_back({vertices.size(), triangles.size()});
  }
  void add_triangles(std::span<const Triangle> batch) override {
    triangles.insert(triangles.end(), batch.begin(), batch.end());
    if (!batches_.empty()) batches_.back().triangles = triangles.size();
  }

  // Passes the mesh on: each batch of vertices with the triangles that followed it.
  void replay(MeshSink& sink) const {
    Batch before;
    for (const Batch& end : batches_) {
      sink.add_batch(std::span(vertices).subspan(before.vertices, end.vertices - before.vertices),
                     std::span(triangles).subspan(before.triangles, end.triangles - before.triangles));
      before = end;
    }
  }

  std::vector<MeshVertex> vertices;
  std::vector<Triangle> triangles;

 private:
  // The numbers of vertices and triangles at the end of a batch.
  struct Batch {
    std::size_t vertices = 0, triangles = 0;
  };
  std::vector<Batch> batches_;
};

// The vertices of a block: numbers[begin] .. numbers[end - 1].
struct VertexBlock {
  std::size_t slab;
  std::size_t begin, end;
};

// Blocks are cubes, and all blocks between two heights make up a slab. Empty blocks are left out.
struct VertexBlocks {
  std::vector<std::uint32_t> numbers;
  std::vector<VertexBlock> blocks;  // by slab
  std::vector<std::size_t> slabs;   // slab s is numbers[slabs[s]] .. numbers[slabs[s + 1] - 1]

  std::span<const std::uint32_t> slice(std::size_t begin, std::size_t end) const {
    return std::span(numbers).subspan(begin, end - begin);
  }
  std::size_t num_slabs() const { return slabs.empty() ? 0 : slabs.size() - 1; }
};

// Sorts the vertices of these numbers into blocks of this side, length units. Vertices of a block keep their
// order.
VertexBlocks sort_into_blocks(std::span<const Vec3f> places, std::vector<std::uint32_t> numbers, double side);

// The least box that holds the places of these numbers.
Box box_around(std::span<const Vec3f> places, std::span<const std::uint32_t> numbers);

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
  const auto probe_box = [&](std::span<const std::uint32_t> numbers) {
    return widened(box_around(places, numbers), (double{kLongestReturn} + kProbeReach) * step);
  };
  const auto whole = field.gather(probe_box(sorted.numbers));
  std::vector<std::optional<decltype(field.gather(Box{}))>> slabs(sorted.num_slabs());
  parallel_for(0, static_cast<std::int64_t>(slabs.size()), [&](std::int64_t i) {
    const auto s = static_cast<std::size_t>(i);
    const auto numbers = sorted.slice(sorted.slabs[s], sorted.slabs[s + 1]);
    if (!numbers.empty()) slabs[s] = whole.restricted_to(probe_box(numbers));
  });
  std::vector<std::int64_t> evaluations(sorted.blocks.size());
  const auto num_blocks = static_cast<std::int64_t>(sorted.blocks.size());
  reported_parallel_for({0, num_blocks, num_blocks}, progress, "even", [&](std::int64_t i) {
    const VertexBlock& block = sorted.blocks[static_cast<std::size_t>(i)];
    const auto numbers = sorted.slice(block.begin, block.end);
    const auto narrowed = slabs[block.slab]->restricted_to(probe_box(numbers));
    VertexReturn way(narrowed, step, surface);
    for (std::size_t k = 0; k < numbers.size(); k += kVerticesPerBatch)
      way.bring_back(numbers.subspan(k, std::min(kVerticesPerBatch, numbers.size() - k)), places);
    evaluations[static_cast<std::size_t>(i)] = way.evaluations();
  });
  return std::accumulate(evaluations.begin(), evaluations.end(), std::int64_t{0});
}

// The neighbours of each vertex of a manifold mesh, whose indices must be in range.
class MeshRelaxation {
 public:
  MeshRelaxation(std::size_t num_vertices, std::span<const Triangle> triangles);

  // Places of all vertices after some sweeps. A sweep moves each vertex to the mean of its neighbours, within
  // the plane through the vertex that its normal is perpendicular to. All vertices of a sweep move at once,
  // so that the result depends on the mesh alone. Vertices at open edges stay where they are.
  std::vector<Vec3f> places_after(std::span<const MeshVertex> vertices, int sweeps) const;

  // Places after half a sweep, in which only the corners of triangles below this quality move.
  std::vector<Vec3f> places_for_poor(std::span<const MeshVertex> vertices,
                                     std::span<const Triangle> triangles, float quality) const;

 private:
  bool is_inner(std::size_t v) const;
  std::span<const std::uint32_t> neighbours(std::size_t v) const;
  Vec3f vertex_move(std::span<const Vec3f> places, std::size_t v, const Vec3f& normal) const;

  std::vector<std::uint32_t> first_, neighbours_;  // the neighbours of one vertex after those of another
  std::vector<std::uint32_t> balance_;  // numbers of neighbours that follow less those that precede, mod 2^32
};

// Whether a triangle faces into the body, as the normals of its corners say.
bool is_turned_over(const MeshVertex& a, const MeshVertex& b, const MeshVertex& c);

// Puts vertices of `moved` back as they are in `plain`, until each triangle that is turned over has all its
// corners there. Such a triangle is turned over in the plain mesh already.
void put_back_turned(std::span<const MeshVertex> plain, std::span<const Triangle> triangles,
                     std::span<MeshVertex> moved);

// What evening did to a mesh. Lengths are in length units.
struct EvenStatistics {
  QualityFigures before, after;
  double mean_move = 0.0, largest_move = 0.0;  // of all vertices, between their places
  double largest_value = 0.0;                  // of |F| at the vertices that moved
  std::int64_t moved = 0, kept = 0;            // vertices
  std::int64_t evaluations = 0;                // of F
};

// A third sweep would add less than .02 to the first percentile, and move vertices further.
inline constexpr int kEvenSweeps = 2;
// Triangles below this quality are evened again, at most so many times.
inline constexpr float kPoorQuality = 0.5f;
inline constexpr int kMorePasses = 2;

// Counts the vertices that have moved, and measures how far.
inline void measure_moves(std::span<const MeshVertex> plain, const SurfaceVertices& even,
                          EvenStatistics& statistics) {
  for (std::size_t v = 0; v < plain.size(); ++v) {
    if (even.vertices[v].position == plain[v].position) continue;
    const double move = double{norm(even.vertices[v].position - plain[v].position)};
    ++statistics.moved;
    statistics.mean_move += move;
    statistics.largest_move = std::max(statistics.largest_move, move);
    statistics.largest_value = std::max(statistics.largest_value, double{even.values[v]});
  }
  statistics.kept = static_cast<std::int64_t>(plain.size()) - statistics.moved;
  statistics.mean_move /= static_cast<double>(plain.size());
}

// Moves vertices to the surface from `places`, but for those whose triangles would turn over. Returns the
// number of evaluations of F.
template <BlockField Field>
std::int64_t move_along_surface(const Field& field, double step, std::span<const Triangle> triangles,
                                std::span<const Vec3f> places, SurfaceVertices& even,
                                const Progress& progress) {
  const SurfaceVertices before = even;
  const std::int64_t evaluations = return_to_surface(field, step, places, even, progress);
  put_back_turned(before.vertices, triangles, even.vertices);
  for (std::size_t v = 0; v < places.size(); ++v) {
    if (even.vertices[v].position == before.vertices[v].position) even.values[v] = before.values[v];
  }
  return evaluations;
}

// Evens a mesh of the surface F = 0 with cells of side `step`, length units, as mesh_field() makes it. A
// vertex stays where it is if it lies on an open edge, so that tiles still fit; if no steps bring it back to
// the surface; or if a triangle would be turned over. The result does not depend on the number of threads.
// Throws WorkError where progress asks to stop.
template <BlockField Field>
EvenStatistics even_mesh(const Field& field, double step, RecordedMesh& mesh, const Progress& progress) {
  EvenStatistics statistics;
  if (mesh.triangles.empty()) return statistics;
  statistics.before = mesh_quality(mesh.vertices, mesh.triangles);
  const MeshRelaxation relaxation(mesh.vertices.size(), mesh.triangles);
  SurfaceVertices even{mesh.vertices, std::vector<float>(mesh.vertices.size())};
  statistics.evaluations = move_along_surface(
      field, step, mesh.triangles, relaxation.places_after(mesh.vertices, kEvenSweeps), even, progress);
  for (int pass = 0; pass < kMorePasses; ++pass) {
    statistics.evaluations +=
        move_along_surface(field, step, mesh.triangles,
                           relaxation.places_for_poor(even.vertices, mesh.triangles, kPoorQuality), even, {});
  }
  measure_moves(mesh.vertices, even, statistics);
  mesh.vertices = std::move(even.vertices);
  statistics.after = mesh_quality(mesh.vertices, mesh.triangles);
  return statistics;
}

}  // namespace astrolith
