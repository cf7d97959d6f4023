#include "tasks/estimation/relief_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/length_unit.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

struct Length {
  double number = 0.0;
  std::string_view unit;  // empty: the mesh's
};

std::optional<Length> length_in(std::string_view words) {
  Length length;
  const auto [end, error] = std::from_chars(words.data(), words.data() + words.size(), length.number);
  if (error != std::errc() || !(length.number > 0.0) || !std::isfinite(length.number)) return std::nullopt;
  length.unit = words.substr(static_cast<std::size_t>(end - words.data()));
  if (length.unit.starts_with(' ')) length.unit.remove_prefix(1);
  for (const std::string_view unit : {"", "m", "km", "edges"}) {
    if (length.unit == unit) return length;
  }
  return std::nullopt;
}

TriangleMesh in_file_frame(const TargetBody& target) {
  TriangleMesh surface = target.surface;
  for (Vec3d& p : surface.vertices) p = target.center + target.diagonal * p;
  return surface;
}

// Reliefs of one surface over one body, each with its size.
class SizedReliefs {
 public:
  SizedReliefs(const TargetBody& target, std::size_t bytes, const Progress& progress, const Recipe& recipe)
      : surface_(in_file_frame(target)),
        bytes_(bytes),
        bare_(recipe_to_compact(recipe).size()),
        progress_(progress),
        recipe_(recipe) {}

  // From try to try the spacing follows from the bytes, which grow about as the number of heights does.
  ReliefFit finest() {
    const double least = least_relief_spacing(surface_);
    double spacing = std::max(least, std::sqrt(surface_area(surface_) * kBytesPerHeight / room()));
    std::optional<ReliefFit> best;
    double refused = 0.0;  // the largest spacing that takes too many bytes
    for (int i = 0; i < kMostTries; ++i) {
      ReliefFit fit = fitted(spacing, i);
      // The heights of a try that was stopped are not solved.
      if (stopped_) return best ? std::move(*best) : ReliefFit{};
      const double size = added_bytes(fit);
      const bool fits = size <= room();
      if (!fits) refused = std::max(refused, spacing);
      if (fits && (!best || spacing < best->layer.spacing)) best = std::move(fit);
      if (fits && (size > kFull * room() || spacing <= least)) break;
      double next = std::max(least, spacing * std::sqrt(size / (kAim * room())));
      if (next <= refused) next = best ? std::sqrt(refused * best->layer.spacing) : 1.1 * refused;
      spacing = next;
    }
    if (!best || best->heights < kFewestHeights) refuse();
    return std::move(*best);
  }

 private:
  static constexpr int kMostTries = 6;
  static constexpr double kBytesPerHeight = 0.55;      // of a model's own heights; a first guess
  static constexpr double kFull = 0.97, kAim = 0.985;  // of the bytes
  static constexpr std::size_t kFewestHeights = 100;   // fewer tell nothing of a surface

  ReliefFit fitted(double spacing, int number) {
    return fit_relief(surface_, recipe_, {spacing, 0.0}, [&](double fraction, std::string_view words) {
      stopped_ = stopped_ || !report(progress_, (number + fraction) / kMostTries, words);
      return !stopped_;
    });
  }
  double room() const {
    if (bytes_ <= bare_ + kFewestHeights / 2) refuse();
    return static_cast<double>(bytes_ - bare_);
  }
  // The bytes that the layer adds.
  double added_bytes(const ReliefFit& fit) const {
    Recipe with = recipe_;
    with.layers.emplace_back(fit.layer);
    return static_cast<double>(recipe_to_compact(with).size()) - static_cast<double>(bare_);
  }
  [[noreturn]] void refuse() const {
    throw InputError(fmt::format(
        "bytes: the metaballs take {} of {}, and the others hold fewer than {} heights; give more, fewer "
        "--spheres, or --base-only",
        bare_, bytes_, kFewestHeights));
  }

  TriangleMesh surface_;
  std::size_t bytes_, bare_;
  const Progress& progress_;
  const Recipe& recipe_;
  bool stopped_ = false;
};

}  // namespace

ValueRule relief_spacing_words() {
  const auto complaint = [](const std::string& words) {
    if (words == "auto" || length_in(words)) return std::string();
    return "must be auto or a length above 0, such as 2.5, 3m, 0.01km or 2edges, is \"" + words + "\"";
  };
  return {complaint, ""};
}

double parse_relief_spacing(const std::string& words, const std::string& unit, double mean_edge) {
  if (words.empty() || words == "auto") return 0.0;
  const Length length = length_in(words).value();
  if (length.unit.empty()) return length.number;
  if (length.unit == "edges") return length.number * mean_edge;
  return length.number * metres_per_unit(length.unit) / metres_per_unit(unit);
}

bool can_have_relief(const TargetBody& target) {
  return target.surface.triangles.size() >= kFewestReliefFacets;
}

void expect_relief(const TargetBody& target) { expect_relief_facets(target.surface); }

ReliefFit add_relief(const TargetBody& target, const std::string& words, const Progress& progress,
                     Recipe& recipe) {
  const TriangleMesh surface = in_file_frame(target);
  const double spacing = parse_relief_spacing(words, recipe.length_unit, mean_edge(surface));
  ReliefFit relief = fit_relief(surface, recipe, {spacing, 0.0}, progress);
  if (relief.layer.pixels != nullptr) recipe.layers.emplace_back(relief.layer);
  return relief;
}

ReliefFit add_relief_within(const TargetBody& target, std::size_t bytes, const Progress& progress,
                            Recipe& recipe) {
  ReliefFit relief = SizedReliefs(target, bytes, progress, recipe).finest();
  if (relief.layer.pixels != nullptr) recipe.layers.emplace_back(relief.layer);
  return relief;
}

}  // namespace astrolith
