// The options of programs that describe shapes.
#pragma once

#include <string>

#include "descriptor/shape_description.h"
#include "tasks/job/option_table.h"

namespace astrolith {

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
