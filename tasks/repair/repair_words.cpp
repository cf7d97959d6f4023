#include "tasks/repair/mesh_repair.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace astrolith {
namespace {

std::string count_words(std::int64_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string length_words(double length, const std::string& unit, double diagonal) {
  if (unit == "km" && length < 1.0) return fmt::format("{:.3g} m", 1000.0 * length);
  if (!unit.empty()) return fmt::format("{:.3g} {}", length, unit);
  return fmt::format("{:.2g} % of the diagonal", 100.0 * length / diagonal);
}

// "surface through 29960 points, which lie 18 m from it (rms), at most 70 m; no ground is farther than 90 m
// from a point".
std::string point_words(const MeshRepair& repair, const std::string& unit) {
  const auto length = [&](double value) { return length_words(value, unit, repair.diagonal); };
  std::string words = fmt::format(
      "surface through {} points; their noise is {} (rms distance), at most {}; ground is at most {} from a "
      "point",
      repair.points, length(repair.noise), length(repair.farthest_point), length(repair.farthest_ground));
  constexpr double kWorthSaying = 5e-4;
  if (repair.unseen_share > kWorthSaying)
    words += fmt::format("; no point saw about {:.2g} % of the ground, which is a guess",
                         100.0 * repair.unseen_share);
  if (repair.stray_points > 0) {
    words += fmt::format("; {} left out, such as that at {:.4g} {:.4g} {:.4g}",
                         count_words(repair.stray_points, "stray point", "stray points"), repair.stray.x,
                         repair.stray.y, repair.stray.z);
  }
  return words;
}

std::string moved_words(const MeshRepair& repair, const std::string& unit) {
  // The last bits of coordinates are no move.
  if (!(repair.moved > 1e-9 * repair.diagonal)) return "nothing moved";
  // Somewhat above, so that the rounded figure is a bound, too.
  const double bound = repair.moved * 1.05;
  if (unit == "km" && bound < 1.0) return fmt::format("nothing moved by more than {:.2g} m", 1000.0 * bound);
  if (!unit.empty()) return fmt::format("nothing moved by more than {:.2g} {}", bound, unit);
  return fmt::format("nothing moved by more than {:.2g} % of the diagonal", 100.0 * bound / repair.diagonal);
}

std::string describe_bodies(const MeshRepair& repair) {
  if (repair.bodies == 1) return "";
  return fmt::format("holds {} bodies apart from one another", repair.bodies) +
         (repair.kept_volume < 1.0
              ? fmt::format(", the largest is taken ({:.3g} % of the volume)", 100.0 * repair.kept_volume)
              : ", all are taken");
}

// "1 part reaches into a larger one and 2 lie inside a larger one".
std::string describe_overlaps(const MeshRepair& repair, const std::string& overlap) {
  std::string words;
  if (repair.overlapping_parts > 0) {
    words = fmt::format("{} into a larger one",
                        count_words(repair.overlapping_parts, "part reaches", "parts reach"));
  }
  if (repair.nested_parts > 0) {
    if (!words.empty()) words += " and ";
    words += fmt::format("{} in the rock of a larger one",
                         count_words(repair.nested_parts, "part lies", "parts lie"));
  }
  if (repair.undecided_parts > 0) {
    if (!words.empty()) words += "; ";
    words += fmt::format("{} in the box of a larger one, not looked at closely",
                         count_words(repair.undecided_parts, "part lies", "parts lie"));
  }
  if (words.empty()) return words;
  return words + (repair.united ? ": united" : ": " + overlap);
}

void append(std::string& words, const std::string& more) {
  if (!words.empty() && !more.empty()) words += "; ";
  words += more;
}

}  // namespace

bool mentions_parts(const MeshRepair& repair) {
  return repair.bodies > 1 ||
         repair.overlapping_parts + repair.nested_parts + repair.cavities + repair.undecided_parts > 0;
}

std::string repair_words(const MeshRepair& repair, const std::string& unit, const RepairOptions& options) {
  std::string words = repair.points > 0 ? point_words(repair, unit) : "";
  std::vector<std::string> done;
  const auto add = [&](std::int64_t count, std::string_view verb, std::string_view one, std::string_view many,
                       const std::string& more = "") {
    if (count > 0) done.push_back(fmt::format("{} {}{}", verb, count_words(count, one, many), more));
  };
  if (repair.wrapped) {
    done.push_back(
        fmt::format("wrapped at {:.3g} % of the diagonal", 100.0 * repair.wrap_alpha / repair.diagonal));
  } else {
    add(repair.merged_vertices, "merged", "repeated or unused vertex", "repeated or unused vertices");
    add(repair.dropped_facets, "dropped", "facet", "facets",
        repair.dropped_share > 0.0 ? fmt::format(" ({:.2g} % of the surface)", 100.0 * repair.dropped_share)
                                   : "");
    add(repair.turned_facets, "turned", "facet", "facets");
    add(repair.stitched_edges, "stitched", "edge", "edges");
    add(repair.split_facets, "split", "facet", "facets");
    add(repair.holes, "filled", "hole", "holes",
        fmt::format(" (largest {:.2g} % of the surface)", 100.0 * repair.largest_hole));
    add(repair.crossing_facets, "replaced", "facet that crossed others", "facets that crossed others");
  }
  for (const std::string& item : done) words += item + ", ";
  if (!done.empty()) words += moved_words(repair, unit);
  append(words, describe_bodies(repair));
  append(words, describe_overlaps(repair, options.overlap));
  if (repair.cavities > 0) append(words, count_words(repair.cavities, "cavity", "cavities"));
  return words;
}

nlohmann::ordered_json repair_json(const MeshRepair& repair) {
  return {{"merged_vertices", repair.merged_vertices},
          {"dropped_facets", repair.dropped_facets},
          {"dropped_share", repair.dropped_share},
          {"turned_facets", repair.turned_facets},
          {"stitched_edges", repair.stitched_edges},
          {"split_facets", repair.split_facets},
          {"holes", repair.holes},
          {"filled_share", repair.filled_share},
          {"largest_hole", repair.largest_hole},
          {"crossing_facets", repair.crossing_facets},
          {"moved", repair.moved},
          {"wrapped", repair.wrapped},
          {"wrap_alpha", repair.wrap_alpha},
          {"wrap_offset", repair.wrap_offset},
          {"bodies", repair.bodies},
          {"kept_volume", repair.kept_volume},
          {"overlapping_parts", repair.overlapping_parts},
          {"nested_parts", repair.nested_parts},
          {"cavities", repair.cavities},
          {"undecided_parts", repair.undecided_parts},
          {"united", repair.united},
          {"points", repair.points},
          {"stray_points", repair.stray_points},
          {"noise", repair.noise},
          {"farthest_point", repair.farthest_point},
          {"farthest_ground", repair.farthest_ground},
          {"unseen_share", repair.unseen_share}};
}

}  // namespace astrolith
