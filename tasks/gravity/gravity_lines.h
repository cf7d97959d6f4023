// What a reader of the terminal wants of the figures of gravity.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace astrolith {

// Ten lines at most. `figures` are those of the job's summary.
std::string gravity_lines(const nlohmann::ordered_json& figures);

}  // namespace astrolith
