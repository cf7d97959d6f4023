// Looks at a mesh that is not made in some places of its surface.
//
// A coarse mesh tells where the surface is and how large. Through points that lie evenly over it the mesher
// makes columns of the finer mesh, along the axis that is nearest to the normal there. What a column takes,
// for each area of the coarse mesh in the same column, stands for the whole surface: the projections of both
// surfaces along the axis are alike, however rough the finer one is.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/box_tree.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/processor_clock.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

class ProbedSurface {
 public:
  ProbedSurface() = default;
  // Points are drawn from the triangles whose centres lie within the box, and area() is theirs.
  ProbedSurface(TriangleMesh mesh, const Box& within);

  bool empty() const { return !(area() > 0.0); }
  double area() const { return areas_.empty() ? 0.0 : areas_.back(); }  // square length units

  struct Point {
    Vec3d position;
    Vec3d normal;  // unit length, outwards
  };
  // The point number `index` of a sequence whose beginnings all lie evenly over the area. Expects a surface
  // that is not empty.
  Point point(int index) const;

  // The largest share of the area that lies in a slab of this height across the z axis; 0 to 1.
  double largest_share(double height) const;

  // The area within a box, of all triangles.
  double area_within(const Box& box) const;

 private:
  TriangleMesh mesh_;
  std::vector<double> areas_;  // of the triangles up to this one
  BoxTree tree_;               // of the triangles' boxes
};

// What the mesher takes for a square length unit of the coarse mesh, as the mean of some probes.
struct ProbeFigures {
  double triangles = 0.0, blocks = 0.0;
  double seconds = 0.0;      // of one processor
  double list_bytes = 0.0;   // memory of the field narrowed to a block, whatever the area
  double evaluations = 0.0;  // of the field, of all probes together
};

// A mesh to be probed.
struct ProbedMesh {
  const ProbedSurface& surface;
  double step;         // edge of its cells, length units
  double reach;        // how far its surface may lie from the coarse one, length units
  bool twice = false;  // columns are made twice, and the second time counts: caches are filled then
};

// The side of a column in cells. A column of two blocks owns all but its first cells, as a patch does.
template <int B>
inline constexpr int kColumnCells = 2 * B - 1;

template <int B>
BlockGrid<B> column_at(const ProbedSurface::Point& place, const ProbedMesh& mesh, double shift) {
  const Vec3d& n = place.normal;
  const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
  const std::size_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  const double side = B * mesh.step;
  std::array<int, 3> cells{2 * B, 2 * B, 2 * B};
  cells[axis] = B * (2 * static_cast<int>(std::ceil(mesh.reach / side)) + 2);
  const auto first = [&](std::size_t a) {
    return -0.5 * mesh.step * (cells[a] + 1) + (a == axis ? side * (shift - 0.5) : 0.0);
  };
  const SampleGrid samples{place.position + Vec3d{first(0), first(1), first(2)}, mesh.step, cells};
  return {samples, {{2, 2, 2}, cells}, false};
}

// Makes the column through point number `index` of the coarse mesh.
template <int B, BlockField Field>
ProbeFigures probe(const Field& field, const ProbedMesh& mesh, int index) {
  // Areas that are a scrap of the column's cross-section lie beside the surface that the column holds.
  constexpr double kLeastArea = 0.25;
  const double shift = double(hash_append(static_cast<std::uint32_t>(index), 7) >> 8) * 0x1p-24;
  const ProbedSurface::Point place = mesh.surface.point(index);
  const BlockGrid<B> grid = column_at<B>(place, mesh, shift);
  const SampleGrid& samples = grid.samples;
  const double side = kColumnCells<B> * mesh.step;
  const double area = std::max(mesh.surface.area_within(samples.box({1, 1, 1}, samples.cells, 0.0)),
                               kLeastArea * side * side);
  ProbeFigures figures;
  const auto make = [&] {
    MeshDiscard nowhere;
    LayeredMesher<B, Field> mesher(field, grid, nowhere);
    const ProcessorClock clock;
    const MeshStatistics made = mesher.run({});
    // The first cells are sampled and culled, and do not count.
    const double counts = double(kColumnCells<B>) / (2 * B);
    figures.triangles = double(made.triangles) / area;
    figures.blocks = counts * counts * double(made.active_blocks) / area;
    figures.evaluations += double(made.evaluations);
    return counts * clock.seconds() / area;
  };
  if (mesh.twice) make();
  figures.seconds = make();
  const Vec3d half = 0.5 * B * mesh.step * Vec3d{1, 1, 1};
  const auto block = field.gather({place.position - half, place.position + half});
  if constexpr (requires { block.list_bytes(); }) figures.list_bytes = block.list_bytes();
  return figures;
}

// The mean of `count` probes.
template <int B, BlockField Field>
ProbeFigures probe_surface(const Field& field, const ProbedMesh& mesh, int count) {
  std::vector<ProbeFigures> probes(static_cast<std::size_t>(count));
  parallel_for(0, count, [&](std::int64_t i) {
    on_one_thread([&] { probes[static_cast<std::size_t>(i)] = probe<B>(field, mesh, static_cast<int>(i)); });
  });
  ProbeFigures mean;
  for (const ProbeFigures& one : probes) {
    mean.triangles += one.triangles / count;
    mean.blocks += one.blocks / count;
    mean.seconds += one.seconds / count;
    mean.list_bytes += one.list_bytes / count;
    mean.evaluations += one.evaluations;
  }
  return mean;
}

}  // namespace astrolith
