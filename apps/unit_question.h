// The unit of a mesh's lengths, and the question that a size raises which its body, or no body at all, has.
// Bodies are known by the names that file names often hold, with radii that tell metres from kilometres.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include "apps/program.h"
#include "geometry/io/stated_unit.h"
#include "numerics/errors.h"

namespace astrolith {

struct UnitChoice {
  std::string given;             // by --unit; empty where it is not
  std::string otherwise = "km";  // where neither --unit nor the file says one
};

// The unit of a mesh's lengths: the given one, else what the file states, else `otherwise`. Says so where the
// file states another unit than the given one. Throws InputError where the file's unit decides and is none of
// `units`; any unit will do where these are none.
inline std::string unit_of_mesh(const Program& program, const std::filesystem::path& file,
                                const UnitChoice& choice, std::initializer_list<std::string_view> units) {
  const std::string stated = stated_length_unit(file);
  if (stated.empty()) return choice.given.empty() ? choice.otherwise : choice.given;
  if (!choice.given.empty() && choice.given != stated) {
    program.say(fmt::format("note: {}: states its unit as {}; taken in {}, as --unit says", file.string(),
                            stated, choice.given));
    return choice.given;
  }
  if (units.size() == 0 || std::find(units.begin(), units.end(), stated) != units.end()) return stated;
  throw InputError(fmt::format("{}: states its unit as {}, which is none of {}; add --unit", file.string(),
                               stated, fmt::join(units, ", ")));
}

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
      std::cbrt(std::abs(volume) * 3.0 / (4.0 * std::numbers::pi)) * metres_per_unit / 1000.0;
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
