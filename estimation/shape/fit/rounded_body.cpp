#include "estimation/shape/fit/rounded_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "estimation/shape/fit/fit_check.h"
#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/refinement/rounding.h"
#include "estimation/shape/target/surface_components.h"
#include "numerics/errors.h"
#include "recipe/compact/number_table.h"
#include "recipe/recipe_json.h"
#include "synthesis/body/body_spheres.h"

namespace astrolith {
namespace {

// Steps of 10 to 99 units of the last decimal, numbered from the coarsest down: 90 in a decade.
constexpr int kStepsInDecade = 90;
constexpr int kDecades = 8;

// The dampings of the normal equations by which later numbers make up for the rounding of earlier ones. A
// rounding to bytes tries all of the first. A rounding to digits has finer steps, and takes one: a
// factorisation takes as long as ten steps of the fit.
constexpr double kDampings[] = {1e-3, 1e-2, 1e-1, 1.0};
constexpr double kDigitsDamping = 1e-2;

constexpr std::int64_t kCheckSamples = 1000;  // of the distances of a checked mesh, which are not used

NumberLattice lattice_number_from(int coarsest_decimals, int number) {
  return {coarsest_decimals + number / kStepsInDecade, 99 - number % kStepsInDecade};
}

double lattice_step(const NumberLattice& lattice) { return *lattice_number(lattice, 1); }

double on_lattice(const NumberLattice& lattice, double x) {
  const std::int64_t k = std::llround(x / lattice_step(lattice));
  return lattice_number(lattice, k).value_or(x);
}

double mean_model_distance(const MetaballModel& model, const std::vector<Vec3d>& points) {
  double sum = 0.0;
  for (const double s : model_distances(model, points)) sum += std::abs(s);
  return sum / static_cast<double>(points.size());
}

void sort_for_compact(std::vector<Sphere>& spheres) {
  NumberTable table{4, {}};
  for (const Sphere& s : spheres) {
    for (const double number : {s.center.x, s.center.y, s.center.z, s.radius}) table.values.push_back(number);
  }
  std::vector<Sphere> sorted;
  for (const std::size_t i : spatial_order(table)) sorted.push_back(spheres[i]);
  spheres = std::move(sorted);
}

std::size_t compact_bytes(const MetaballBody& body, const std::string& unit) {
  Recipe recipe;
  recipe.length_unit = unit;
  recipe.body = body;
  return recipe_to_compact(recipe).size();
}

// The decimals of numbers up to ten times as large as the diagonal, such as 0 for 1 to 10 km.
int choose_decimals(double diagonal) {
  int decimals = 0;
  for (; diagonal >= 10.0 && decimals > -kMostDecimals; diagonal /= 10.0) --decimals;
  for (; diagonal < 1.0 && decimals < kMostDecimals - kDecades; diagonal *= 10.0) ++decimals;
  return decimals;
}

class BodyRounding {
 public:
  BodyRounding(const TargetBody& target, const MetaballModel& model, const FitPoints& points,
               const RoundingOptions& options)
      : target_(target),
        model_(model),
        points_(points),
        options_(options),
        coarsest_decimals_(choose_decimals(target.diagonal)) {}

  RoundedBody run() {
    for (const double damping : kDampings) {
      keep_better(within_bytes(ModelRounding(model_, points_, options_.refinement, damping)));
    }
    return std::move(best_);
  }

  // The fewest decimals with which the body loses no more than allowed, or none.
  std::optional<RoundedBody> run_for_digits(double most_loss) const {
    const ModelRounding rounding(model_, points_, options_.refinement, kDigitsDamping);
    const double most = (1.0 + most_loss) * mean_model_distance(model_, points_.on_surface);
    std::optional<std::int64_t> wrong_unrounded;
    for (int decade = 0; decade < kDecades; ++decade) {
      // Ten units of the last decimal: one of the decimal before it.
      const MetaballBody body = rounded(rounding, lattice((decade + 1) * kStepsInDecade - 1));
      if (body_distance(body) > most) continue;
      if (!wrong_unrounded)
        wrong_unrounded = measured(body_in_file_frame(metaball_body(model_))).wrong_components;
      RoundedBody found = measured(body);
      if (found.wrong_components <= *wrong_unrounded) return found;
    }
    return std::nullopt;
  }

 private:
  // The finest steps with which the recipe has no more bytes than allowed.
  RoundedBody within_bytes(const ModelRounding& rounding) const {
    int coarse = 0, fine = kDecades * kStepsInDecade;
    if (compact_bytes(rounded(rounding, lattice(coarse)), options_.length_unit) > options_.bytes) {
      throw InputError("bytes: too few for so many metaballs; give more, or fewer metaballs");
    }
    while (fine - coarse > 1) {
      const int middle = (coarse + fine) / 2;
      const bool fits =
          compact_bytes(rounded(rounding, lattice(middle)), options_.length_unit) <= options_.bytes;
      (fits ? coarse : fine) = middle;
    }
    return measured(rounded(rounding, lattice(coarse)));
  }

  NumberLattice lattice(int number) const { return lattice_number_from(coarsest_decimals_, number); }

  MetaballBody rounded(const ModelRounding& rounding, const NumberLattice& lattice) const {
    const MetaballModel model = rounding.rounded({target_.center, target_.diagonal}, lattice_step(lattice));
    MetaballBody body = metaball_body(model);
    body.spheres.clear();
    body.subtract.clear();
    for (const ModelSphere& s : model.spheres) {
      const Vec3d p = target_.center + target_.diagonal * s.center;
      (s.subtractive ? body.subtract : body.spheres)
          .push_back({{on_lattice(lattice, p.x), on_lattice(lattice, p.y), on_lattice(lattice, p.z)},
                      on_lattice(lattice, target_.diagonal * s.radius)});
    }
    sort_for_compact(body.spheres);
    sort_for_compact(body.subtract);
    return body;
  }

  // Mean |s| at the samples of a body in the file's frame, fraction of the diagonal.
  double body_distance(const MetaballBody& body) const {
    return mean_model_distance(to_model(in_target_frame(target_, body)), points_.on_surface);
  }

  RoundedBody measured(MetaballBody body) const {
    const MetaballBody in_frame = in_target_frame(target_, body);
    const FitCheck check = check_fit(target_, in_frame, options_.check_resolution, kCheckSamples, 1);
    const double distance = body_distance(body);
    return {std::move(body), distance, compare_components(target_, check.mesh).wrong()};
  }

  MetaballBody body_in_file_frame(MetaballBody body) const {
    for_each_sphere(body, [&](Sphere& s) {
      s.center = target_.center + target_.diagonal * s.center;
      s.radius *= target_.diagonal;
    });
    return body;
  }

  void keep_better(RoundedBody other) {
    const bool better = std::tie(other.wrong_components, other.mean_distance) <
                        std::tie(best_.wrong_components, best_.mean_distance);
    if (best_.body.spheres.empty() || better) best_ = std::move(other);
  }

  const TargetBody& target_;
  const MetaballModel& model_;
  const FitPoints& points_;
  const RoundingOptions& options_;
  int coarsest_decimals_;
  RoundedBody best_;
};

}  // namespace

RoundedBody round_body(const TargetBody& target, const MetaballModel& model, const FitPoints& points,
                       const RoundingOptions& options) {
  return BodyRounding(target, model, points, options).run();
}

std::optional<RoundedBody> round_body_to_digits(const TargetBody& target, const MetaballModel& model,
                                                const FitPoints& points, const RoundingOptions& options,
                                                double most_loss) {
  return BodyRounding(target, model, points, options).run_for_digits(most_loss);
}

}  // namespace astrolith
