// The unit of a mesh's lengths, by --unit or by its file. A question asks about the unit of a mesh whose size
// is far from the size of its body, or of any small body. A body is recognised by the name that the file's
// name begins with; its radius tells metres from kilometres.
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

#include "numerics/length_unit.h"
#include "numerics/portable_double.h"
#include "tasks/job/job.h"

namespace astrolith {

struct UnitChoice {
  std::string given;             // by --unit; empty where it is not
  std::string otherwise = "km";  // where neither --unit nor the file says one
};

struct MeshUnit {
  std::string name;
  bool assumed = false;  // neither given nor stated: programs say so
};

// The unit of a mesh's lengths: the given one, else what the file or its label states, else `otherwise`. Says
// so where the file states another unit than the given one, and where a label decides. Throws InputError
// where the file's unit decides and is none of `units`; any unit will do where these are none.
MeshUnit resolve_unit(const Job& job, const std::filesystem::path& file, const UnitChoice& choice,
                      std::initializer_list<std::string_view> units);

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
// named after, or larger or smaller than any small body, or where an assumed unit makes it larger than most;
// else empty. Rocks in cm and mm may be of any size.
inline std::string unit_question(const std::filesystem::path& file, double volume, const MeshUnit& unit) {
  constexpr double kClearlyWrong = 30.0, kLargest = 600.0, kSmallest = 0.00025;  // km: Ceres has 470
  constexpr double kLargerThanMost = 30.0;  // km: shape models of some ten asteroids and of large moons
  const double size = portable::cbrt(std::abs(volume) * 3.0 / (4.0 * std::numbers::pi));
  const double radius = size * metres_per_unit(unit.name) / 1000.0;
  const std::string name = file.string();
  const auto asked = [&](const std::string& is_not) {
    return fmt::format("note: {}: a mean radius of {:.4g} km is {}; is --unit {} right, or the mesh scaled?",
                       name, radius, is_not, unit.name);
  };
  if (const std::optional<KnownBody> body = known_body(file.filename().string())) {
    if (radius >= kClearlyWrong * body->radius || body->radius >= kClearlyWrong * radius)
      return asked(fmt::format("not that of {} ({:.4g} km)", body->name, body->radius));
  } else if (radius > kLargest) {
    return asked("above that of any asteroid or comet");
  } else if (unit.assumed && radius > kLargerThanMost) {
    return fmt::format(
        "note: {}: states no unit and is taken in {}, which makes its mean radius {:.4g} km; in m it is "
        "{:.4g} m: "
        "add --unit m or --unit {}",
        name, unit.name, radius, size, unit.name);
  } else if (radius < kSmallest && (unit.name == "m" || unit.name == "km")) {
    return asked("below that of any asteroid known");
  }
  return {};
}

// What a program says where it has assumed a unit.
inline std::string assumed_unit_words(const std::string& name, const std::string& unit) {
  return fmt::format("note: {}: states no unit and is taken in {}; --unit says another", name, unit);
}

}  // namespace astrolith
