// Numbers with their nouns and units, as messages of programs state them, and a job's figures as text.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "numerics/vec3.h"

namespace astrolith {

// The document with indents and a line break at its end. Bytes that are no UTF-8, as names of files may have,
// are replaced.
inline std::string json_text(const nlohmann::ordered_json& document) {
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

// "1 layer", "3 layers".
inline std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

// A count in three characters or so: "1.2 M", "340 k".
inline std::string rounded_count(double count) {
  return count >= 1e6 ? fmt::format("{:.1f} M", count / 1e6) : fmt::format("{:.0f} k", count / 1e3);
}

// "31 kB", "4.2 MB", "1.3 GB".
inline std::string byte_words(double bytes) {
  const char* unit = "GB";
  double amount = bytes / 1e9;
  if (bytes < 1e6) {
    unit = "kB";
    amount = std::max(bytes / 1e3, 1.0);
  } else if (bytes < 1e9) {
    unit = "MB";
    amount = bytes / 1e6;
  }
  return fmt::format("{:.{}f} {}", amount, amount < 9.95 && bytes >= 1e6 ? 1 : 0, unit);
}

// "about 6 s on idle cores, 11 s of the processor".
inline std::string seconds_words(double on_idle_cores, double processor_seconds) {
  return fmt::format("about {:.0f} s on idle cores, {:.0f} s of the processor", std::ceil(on_idle_cores),
                     std::ceil(processor_seconds));
}

// "0.561 x 0.302 x 0.246 km": the sides of a box, in `unit`.
inline std::string size_words(const Vec3d& sides, std::string_view unit) {
  return fmt::format("{:.3g} x {:.3g} x {:.3g} {}", sides.x, sides.y, sides.z, unit);
}

}  // namespace astrolith
