// Histograms of all pairs of oriented points: a shape's fingerprint that does not change when the shape is
// moved, turned or scaled.
#pragma once

#include <span>

#include "descriptor/pair_count.h"
#include "descriptor/shape_histogram.h"
#include "numerics/progress.h"
#include "numerics/vec3.h"

namespace astrolith {

// Wahl's four features of all unordered pairs of (n) points with (n) normals of any positive length; time
// O(n^2), integers only, so the order of points and the thread count change nothing. delta is a fraction of
// the exact largest distance between two of the points. Positions are rounded to float32 around the middle of
// their box, so a pair in some hundred thousand may lie in the bin beside its own. Throws InputError when
// sizes differ, a number is not finite, there are more than 2^24 points or bins is outside 2 to 10,
// WorkError when progress asks to stop.
ShapeHistogram surflet_histogram(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                 int bins = kDefaultBins, const Progress& progress = {},
                                 const PairCounter& counter = {});

// The six features of the adaptive hybrid descriptor; curvatures (n) are Gaussian, in 1 / length^2.
ShapeHistogram ahd_histogram(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                             std::span<const double> curvatures, int bins = kDefaultBins,
                             const Progress& progress = {}, const PairCounter& counter = {});

// The two halves of ahd_histogram, for whoever counts the pairs of many shapes together: what pairs are
// counted of, and the histogram from count_pairs' counts (descriptor/pair_count.h).
struct PairInput {
  std::vector<Vec3d> points, normals;  // in units of the largest distance, the middle of their box at 0; unit
  std::vector<std::int32_t> local;
  int num_local = 1;
  int bins = kDefaultBins;
  double max_distance = 0.0;  // the points' unit
};
PairInput ahd_input(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                    std::span<const double> curvatures, int bins = kDefaultBins);
ShapeHistogram ahd_histogram(const PairInput& input, std::span<const std::uint64_t> counts);

}  // namespace astrolith
