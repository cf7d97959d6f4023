// Asks about the unit of a mesh whose size is far from the size of its body, or of any small body. A body is
// recognised by the name that the file's name begins with; its radius tells metres from kilometres.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include "numerics/portable_double.h"

namespace astrolith {

struct KnownBody {
  std::string_view name;  // lower case
  double radius;          // km, of a sphere of the same volume, to 10 %
};

inline constexpr std::array kKnownBodies{
    KnownBody{"amalthea", 83.5},   KnownBody{"apophis", 0.17},   KnownBody{"arrokoth", 9.1},
    KnownBody{"bacchus", 0.32},    KnownBody{"bennu", 0.245},    KnownBody{"castalia", 0.54},
    KnownBody{"ceres", 470},       KnownBody{"deimos", 6.2},     KnownBody{"didymos", 0.38},
    KnownBody{"dimorphos", 0.075}, KnownBody{"epimetheus", 58},  KnownBody{"eros", 8.4},
    KnownBody{"gaspra", 6.1},      KnownBody{"geographos", 1.3}, KnownBody{"halley", 5},
    KnownBody{"hygiea", 216},      KnownBody{"hyperion", 135},   KnownBody{"ida", 15.7},
    KnownBody{"interamnia", 166},  KnownBody{"itokawa", 0.165},  KnownBody{"juno", 127},
    KnownBody{"kleopatra", 60},    KnownBody{"lutetia", 49},     KnownBody{"mathilde", 26.5},
    KnownBody{"moshup", 0.66},     KnownBody{"pandora", 40.5},   KnownBody{"phobos", 11.1},
    KnownBody{"psyche", 111},      KnownBody{"ryugu", 0.448},    KnownBody{"steins", 2.65},
    KnownBody{"tempel1", 2.8},     KnownBody{"toutatis", 1.3},   KnownBody{"vesta", 262}};

// The body that the file's name begins with ("Eros_gaskell.ply"; not "erosion.ply").
inline std::optional<KnownBody> known_body(std::string_view file_name) {
  std::string lower(file_name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const KnownBody& body : kKnownBodies) {
    if (lower.rfind(body.name, 0) != 0) continue;
    const char next = lower.size() > body.name.size() ? lower[body.name.size()] : '.';
    if (std::isalpha(static_cast<unsigned char>(next)) == 0) return body;
  }
  return std::nullopt;
}

// A question where a mesh of this volume, in cubic units, is not of the size of the body that its file is
// named after, or larger or smaller than any small body; else empty. `metres_per_unit` is 1 or 1000.
inline std::string unit_question(const std::filesystem::path& file, double volume, double metres_per_unit) {
  constexpr double kClearlyWrong = 30.0, kLargest = 600.0, kSmallest = 0.00025;  // km: Ceres has 470
  const double radius =
      portable::cbrt(std::abs(volume) * 3.0 / (4.0 * std::numbers::pi)) * metres_per_unit / 1000.0;
  const auto asked = [&](const std::string& is_not) {
    return fmt::format("note: {}: a mean radius of {:.4g} km is {}; is --unit {} right, or the mesh scaled?",
                       file.string(), radius, is_not, metres_per_unit == 1.0 ? "m" : "km");
  };
  if (const std::optional<KnownBody> body = known_body(file.filename().string())) {
    if (radius < kClearlyWrong * body->radius && body->radius < kClearlyWrong * radius) return {};
    return asked(fmt::format("not that of {} ({:.4g} km)", body->name, body->radius));
  }
  if (radius > kLargest) return asked("above that of any asteroid or comet");
  return radius < kSmallest ? asked("below that of any asteroid known") : std::string();
}

}  // namespace astrolith
