// The options of programs that describe shapes and measure surfaces.
#pragma once

#include <cstdint>
#include <string>

#include "descriptor/shape_description.h"
#include "descriptor/surface/surface_statistics.h"
#include "tasks/job/density_question.h"
#include "tasks/job/option_table.h"

namespace astrolith {

struct SurfaceOptions {
  SurfaceStatisticsOptions statistics;

  // `flag` is the option without which these mean nothing.
  void add_to(OptionTable& app, const Option& flag) {
    app.add_option("--surface-points", statistics.points,
                   "evenly spread points that stand for a surface; they decide the edge in which all radii "
                   "count. 0: as many as the mesh, or the coarser of two meshes, has vertices, up to 60,000")
        .check(in_range(std::int64_t{0}, std::int64_t{60000}))
        .needs(flag);
    app.add_option("--places", statistics.places, "of these points, at which the surface is measured")
        .check(in_range(std::int64_t{100}, std::int64_t{20000}))
        .needs(flag);
    app.add_option("--period", statistics.rotation_hours,
                   "of rotation about +z, hours, for slopes; 0: the body is at rest")
        .check(zero_or_more())
        .needs(flag);
    app.add_option("--density", statistics.density, "kg/m3, for slopes of a body that turns")
        .check(above_zero())
        .needs(flag);
  }
  SurfaceStatisticsOptions of(const Job& job) const {
    question_density(job, statistics.density);
    SurfaceStatisticsOptions options = statistics;
    options.seed = job.seed;
    return options;
  }
};

struct ShapeOptions {
  std::string features = "ahd";
  DescriptionOptions description;

  void add_to(OptionTable& app) {
    app.add_option("--features", features,
                   "wahl: the four of a pair of points; ahd: also curvature and normal perturbation")
        .check(one_of({"wahl", "ahd"}));
    app.add_option("--bins", description.bins, "histogram bins for each feature")
        .check(in_range(kMinBins, kMaxBins));
    app.add_option("--points", description.points, "samples of the surface; the time grows with their square")
        .check(in_range(std::int64_t{2}, std::int64_t{1} << 24));
  }
  DescriptionOptions with_seed(std::uint64_t seed) const {
    DescriptionOptions options = description;
    options.features = features == "wahl" ? PairFeatures::wahl : PairFeatures::ahd;
    options.seed = seed;
    return options;
  }
};

}  // namespace astrolith
