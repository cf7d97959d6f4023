#include "apps/synth/synth_even.h"

#include <fmt/format.h>

namespace astrolith {

void report_even(Program& program, const EvenStatistics& done, const std::string& unit) {
  program.summary["even"] = {
      {"quality_before", {{"first_percentile", done.before.first_percentile}, {"mean", done.before.mean}}},
      {"quality_after", {{"first_percentile", done.after.first_percentile}, {"mean", done.after.mean}}},
      {"mean_move", done.mean_move},
      {"largest_move", done.largest_move},
      {"largest_value", done.largest_value},
      {"moved_vertices", done.moved},
      {"kept_vertices", done.kept}};
  program.say(fmt::format(
      "even: quality {:.2f} at the first percentile, before {:.2f}, and {:.2f} in the mean, before "
      "{:.2f}; {} vertices moved along the surface, by {:.3g} {} in the mean and {:.3g} at most, "
      "{} stay; |F| <= {:.2g}",
      done.after.first_percentile, done.before.first_percentile, done.after.mean, done.before.mean,
      done.moved, done.mean_move, unit, done.largest_move, done.kept, done.largest_value));
}

}  // namespace astrolith
