// Prints a table of all optimisers on one problem: the least, median and largest value found over the seeds.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "estimation/optimize/optimizer.h"

namespace astrolith {

// `found` gives the value that an optimiser reaches from a seed. All optimisers get the same number of
// evaluations.
inline void print_optimizer_table(
    int evaluations, int seeds, const std::function<double(OptimizerAlgorithm, std::uint64_t seed)>& found) {
  fmt::print("fitness after {} evaluations, {} seeds\n{:8} {:>8} {:>8} {:>8}\n", evaluations, seeds, "",
             "least", "median", "largest");
  for (const char* name : {"pso", "crs2", "isres", "esch", "sbplx", "cmaes"}) {
    std::vector<double> values;
    for (int seed = 1; seed <= seeds; ++seed) {
      values.push_back(found(optimizer_from_name(name), static_cast<std::uint64_t>(seed)));
    }
    std::sort(values.begin(), values.end());
    fmt::print("{:8} {:8.5f} {:8.5f} {:8.5f}\n", name, values.front(), values[values.size() / 2],
               values.back());
    std::fflush(stdout);
  }
}

}  // namespace astrolith
