// Makes the triangles of a finished mesh more even. Marching cubes leaves slivers where the surface passes
// near a sample: one triangle in a hundred has a quality below .03. Two sweeps move the vertices along the
// surface, each to the mean of its neighbours, and Newton's steps bring them back to F = 0. Triangles keep
// their vertices, so that the mesh is as closed and as manifold as before.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include "geometry/triangle_quality.h"
#include "numerics/progress.h"
#include "synthesis/mesh/mesh_relaxation.h"
#include "synthesis/mesh/recorded_mesh.h"
#include "synthesis/mesh/surface_return.h"

namespace astrolith {

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
  statistics.before = quality_of(mesh.vertices, mesh.triangles);
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
  statistics.after = quality_of(mesh.vertices, mesh.triangles);
  return statistics;
}

}  // namespace astrolith
