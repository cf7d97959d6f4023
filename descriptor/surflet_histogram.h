// Histograms of all pairs of oriented points. They describe a shape and do not change when the shape is
// moved, turned or scaled.
#pragma once

#include <span>

#include "descriptor/pair_count.h"
#include "descriptor/shape_histogram.h"
#include "numerics/progress.h"
#include "numerics/vec3.h"

namespace astrolith {

// The largest distance between two of the points, in their unit, exact up to rounding; 0 for fewer than two
// points. Points must be finite. Pairs that cannot reach it, judged by their distances from the centre of the
// bounding box, are not examined. Throws WorkError when progress asks to stop.
double largest_distance(std::span<const Vec3d> points, const Progress& progress = {});

// The histogram of Wahl's four features over all unordered pairs of (n) points with (n) normals of any
// positive length, in time O(n^2). Only integers are summed, so that neither the order of the points nor the
// number of threads matters. delta is a fraction of the exact largest distance between two of the points.
// Positions are rounded to float32 around the middle of their box; one pair in some hundred thousand may
// therefore lie in the bin beside its own. Throws InputError when the sizes differ, when a number is not
// finite, when there are more than 2^24 points or when bins is outside 2 to 10. Throws WorkError when
// progress asks to stop.
ShapeHistogram surflet_histogram(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                 int bins = kDefaultBins, const Progress& progress = {},
                                 const PairCounter& counter = {});

// The histogram of the six features of the adaptive hybrid descriptor. curvatures (n) are Gaussian, in 1 /
// length^2.
ShapeHistogram ahd_histogram(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                             std::span<const double> curvatures, int bins = kDefaultBins,
                             const Progress& progress = {}, const PairCounter& counter = {});

// The two halves of ahd_histogram, for callers who count the pairs of many shapes together: the input of
// count_pairs, and the histogram made from its counts (descriptor/pair_count.h).
struct PairInput {
  std::vector<Vec3d> points, normals;  // points in units of max_distance about 0; unit normals
  std::vector<std::int32_t> local;
  int num_local = 1;
  int bins = kDefaultBins;
  double max_distance = 0.0;  // in the unit of the points
};
PairInput ahd_input(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                    std::span<const double> curvatures, int bins = kDefaultBins,
                    const Progress& progress = {});
ShapeHistogram ahd_histogram(const PairInput& input, std::span<const std::uint64_t> counts);

}  // namespace astrolith
