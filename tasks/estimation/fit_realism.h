// Whether the surface of a fit passes for the target's, as the summaries and the report state it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "estimation/shape/details/realism_check.h"
#include "estimation/shape/report/fit_report.h"
#include "tasks/description/surface_report.h"

namespace astrolith {

struct JudgedFit {
  std::optional<FitRealism> realism;  // none where progress asked to stop, or with the remark
  std::string remark;                 // why the surface could not be judged
};

// check_realism() for a whole fit, of which the verdict is only a part: what hinders it is no error.
JudgedFit judge_fit(const TargetBody& target, const Recipe& recipe, int seeds, std::uint64_t seed,
                    const Progress& progress);

// The verdict in the unit of the target's file, "m" or "km", with the p and the largest distance of each
// seed.
nlohmann::ordered_json fit_realism_json(const FitRealism& realism, const TargetBody& target,
                                        const std::string& unit);

// The verdict for a report, which refers to `realism`.
ReportedRealism reported(const FitRealism& realism, const TargetBody& target, const std::string& unit);

}  // namespace astrolith
