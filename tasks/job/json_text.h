// A job's figures as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace astrolith {

// The document with indents and a line break at its end. Bytes that are no UTF-8, as names of files may have,
// are replaced.
inline std::string json_text(const nlohmann::ordered_json& document) {
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace astrolith
