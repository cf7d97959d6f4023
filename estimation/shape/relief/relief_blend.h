// The blend of a relief's heights at many samples at once, and its transpose: sums over the samples around
// each place. Neither stores the shares of a sample, which its place in the cell says.
#pragma once

#include <algorithm>
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
  std::vector<std::uint32_t> cell_first_run;  // of the cells with samples, and the number of runs
  std::size_t left_out = 0;                   // number of points that no height reaches

  std::size_t cells() const { return cell_first_run.size() - 1; }
};

// The places of the recipe's body at this spacing, and the samples of `surface`: its vertices, and four
// points of each facet. Both are in the recipe's frame and unit. Samples whose projection misses the bare
// surface by more than a quarter of the spacing are left out: no height brings the surface there. Expects a
// body without operations and warps. Where the spacing is six mean edges and more, the vertices serve alone.
// A result without places where progress asked to stop. Throws as find_relief_places().
ReliefSamples relief_samples(const TriangleMesh& surface, const Recipe& recipe, double spacing,
                             const Progress& progress);

// The number of the square of places around a point in its cell; points of one square read the same places.
inline int square_index(const std::array<float, 3>& at) {
  const auto along = [](float x) { return std::min(static_cast<int>(x), kReliefCell - 1); };
  return along(at[0]) + kReliefCell * (along(at[1]) + kReliefCell * along(at[2]));
}

// The sum of weight times B (recipe/relief_layer.h) over the places around a point.
float weight_around(const float* weights, const std::array<std::int32_t, 3>& tiles,
                    const std::array<float, 3>& at);

// What is summed over samples: share times this.
enum class SampleSum {
  kOne,     // 1
  kShare,   // the share itself
  kHeight,  // the height of the sample
  kBlend,   // the blend of the heights at the sample
  kError    // the height of the sample less the blend
};

// Length units.
struct HeightRange {
  float least, greatest;
};

class ReliefBlend {
 public:
  // The samples must outlive this.
  explicit ReliefBlend(const ReliefSamples& samples);

  // (places) The sums over all samples, in an order that does not depend on threads. Without heights all are
  // 0.
  std::vector<double> sums(SampleSum of, const std::vector<double>& heights) const;

  // (places) The range of the heights of the samples around each place; {0, 0} without samples.
  std::vector<HeightRange> ranges() const;

  // The mean over the samples of |height of the sample - blend of the heights|, length units.
  double mean_residual(const std::vector<double>& heights) const;

 private:
  std::vector<double> read_cells(SampleSum of, const std::vector<double>& heights,
                                 std::vector<float>& sums) const;

  const ReliefSamples& samples_;
  std::vector<std::uint32_t> first_;  // (places + 1) of `slots_`
  std::vector<std::uint32_t> slots_;  // where a place lies in the tiles
};

}  // namespace astrolith
