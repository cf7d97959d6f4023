#include "tasks/job/job.h"

#include <utility>

#include "numerics/version/code_version.h"

namespace astrolith {

Job::Job(std::string name)
    : own_options_(std::make_unique<OptionTable>()), options(*own_options_), name_(std::move(name)) {
  options
      .add_option("--seed", seed,
                  "seed of everything random; same input, options and seed give the same bytes")
      .check(in_range(std::int64_t{0}, (std::int64_t{1} << 53) - 1));
}

std::string Job::tool() const { return name_ + " " + kCodeVersion.text(); }

}  // namespace astrolith
