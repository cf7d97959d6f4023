// Points of a measured surface as conditions on the heights of a relief layer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/relief/relief_places.h"
#include "synthesis/relief/relief_tiles.h"

namespace astrolith {

// A point of the bare surface, below a point of the measured one.
struct ReliefSample {
  std::array<float, 3> at;  // in spacings from the corner of its cell
  float height;             // the height that brings the layered surface to the measured point, length units
  float scale;              // 1 / the sum over the places around of weight times B, as relief_mean() divides
};

// The samples first to end - 1. They read the same tiles.
struct SampleRun {
  std::array<std::int32_t, 3> tiles;
  std::uint32_t first, end;
};

struct ReliefSamples {
  std::vector<ReliefPlace> places;
  ReliefTiles tiles;
  std::vector<float> weights;         // (tiles x kReliefTileSize) of the places of the tiles; 0 without one
  std::vector<ReliefSample> samples;  // cell by cell
  std::vector<SampleRun> runs;
  std::vector<std::uint32_t> first_run_of_cell;  // of the cells with samples, and the number of runs
  std::size_t left_out = 0;                      // number of points that no height reaches

  std::size_t cells() const { return first_run_of_cell.size() - 1; }
};

// The places of the recipe's body at this spacing, and the samples of `surface`: its vertices, and four
// points of each facet. Both are in the recipe's frame and unit. Samples whose projection misses the bare
// surface by more than a quarter of the spacing are left out: no height brings the surface there. Expects a
// body without operations and warps. Where the spacing is six mean edges and more, the vertices serve alone.
// A result without places where progress asked to stop. Throws as find_relief_places().
ReliefSamples relief_samples(const TriangleMesh& surface, const Recipe& recipe, double spacing,
                             const Progress& progress);

}  // namespace astrolith
