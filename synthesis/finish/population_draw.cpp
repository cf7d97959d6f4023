#include "synthesis/finish/population_draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/lay_on_base.h"

namespace astrolith {
namespace {

constexpr double kAxesSpread = 0.12;
constexpr double kNearAxes = 0.35;
constexpr double kMostStretch = 0.5;  // of the logarithm of an axis
constexpr double kRoughnessSpread = 0.3;
constexpr double kRoundAxes = 0.2;  // logarithm of the ratio of two axes that count as one
constexpr int kCheckCells = 40;
constexpr int kMostDraws = 64;

enum DrawStream : std::uint64_t { kShapeStream = 1, kSizeStream };

// Logarithms of half axes, whose sum is 0.
using LogAxes = std::array<double, 3>;

LogAxes centered(LogAxes l) {
  const double mean = (l[0] + l[1] + l[2]) / 3.0;
  for (double& v : l) v -= mean;
  return l;
}
LogAxes log_axes(double a, double b, double c) {
  return centered({portable::log(a), portable::log(b), portable::log(c)});
}
LogAxes log_axes(const MeasuredBody& body) {
  return log_axes(body.half_axes.x, body.half_axes.y, body.half_axes.z);
}
double distance(const LogAxes& a, const LogAxes& b) {
  double square = 0.0;
  for (std::size_t k = 0; k < 3; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(square);
}
double stretch(const LogAxes& a, const LogAxes& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::fabs(a[k] - b[k]));
  return most;
}

// An index with a chance in proportion to its weight.
std::size_t choose(const std::vector<double>& weights, CounterRandom& random) {
  double total = 0.0;
  for (const double w : weights) total += w;
  double rest = total * random.uniform();
  std::size_t last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    last = i;
    rest -= weights[i];
    if (rest < 0.0) break;
  }
  return last;
}

// A deviate of the gamma distribution of shape 3/2: the sum of those of 1 and 1/2.
double draw_gamma_three_halves(CounterRandom& random) {
  const double n = random.normal();
  return -portable::log(1.0 - random.uniform()) + 0.5 * n * n;
}

// The body in the frame of its axes and its centre of mass.
MetaballBody in_own_frame(const MeasuredBody& measured) {
  MetaballBody body = measured.body.front();
  const auto move = [&](Sphere& s) {
    const Vec3d p = s.center - measured.center;
    s.center = {round_to_seven_digits(dot(measured.axes[0], p)),
                round_to_seven_digits(dot(measured.axes[1], p)),
                round_to_seven_digits(dot(measured.axes[2], p))};
  };
  std::for_each(body.spheres.begin(), body.spheres.end(), move);
  std::for_each(body.subtract.begin(), body.subtract.end(), move);
  return body;
}

class PopulationDraw {
 public:
  explicit PopulationDraw(const Recipe& recipe)
      : recipe_(recipe),
        bodies_(recipe.population->bodies),
        conditions_(recipe.population->draw),
        eligible_(eligible_bodies()) {}

  DrawnBody draw() const {
    for (int attempt = 0; attempt < kMostDraws; ++attempt) {
      CounterRandom random(recipe_.seed, kShapeStream + (static_cast<std::uint64_t>(attempt) << 32));
      std::optional<DrawnBody> drawn = attempt_draw(random);
      if (!drawn) continue;
      drawn->attempts = attempt + 1;
      return *drawn;
    }
    throw InputError(fmt::format(
        "population: draw: gave no body in one piece in {} attempts; widen its conditions", kMostDraws));
  }

 private:
  std::vector<std::size_t> eligible_bodies() const {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const bool fits = (!conditions_.kind || bodies_[i].kind == *conditions_.kind) &&
                        (!conditions_.source || bodies_[i].source == *conditions_.source);
      if (fits || bodies_[i].name == conditions_.near) numbers.push_back(i);
    }
    if (numbers.size() < kLeastDonors) {
      throw InputError(
          fmt::format("population: draw: {} of {} bodies fulfil the class and the source; a draw needs two",
                      numbers.size(), bodies_.size()));
    }
    const auto is_near = [&](const MeasuredBody& body) { return body.name == conditions_.near; };
    if (!conditions_.near.empty() && std::none_of(bodies_.begin(), bodies_.end(), is_near)) {
      std::vector<std::string_view> names;
      for (const MeasuredBody& body : bodies_) names.push_back(body.name);
      throw InputError(fmt::format("population: draw: near: no body is called \"{}\"; there are {}",
                                   conditions_.near, fmt::join(names, ", ")));
    }
    return numbers;
  }

  // The axes of a draw: about given ones, or about those of a body that is near or any.
  LogAxes drawn_axes(CounterRandom& random) const {
    const bool given = !conditions_.axes.empty();
    const std::size_t own = near_body().value_or(eligible_[random.below(eligible_.size())]);
    LogAxes l = given ? log_axes(conditions_.axes[0], conditions_.axes[1], conditions_.axes[2])
                      : log_axes(bodies_[own]);
    for (double& v : l) v += (given ? conditions_.axes_deviation : kAxesSpread) * random.normal();
    std::sort(l.rbegin(), l.rend());
    return centered(l);
  }
  std::optional<std::size_t> near_body() const {
    for (const std::size_t i : eligible_) {
      if (!conditions_.near.empty() && bodies_[i].name == conditions_.near) return i;
    }
    return {};
  }

  std::vector<DonorShare> drawn_donors(const LogAxes& l, CounterRandom& random) const {
    std::vector<double> weights(bodies_.size(), 0.0);
    for (const std::size_t i : eligible_) {
      const double d = distance(log_axes(bodies_[i]), l);
      const bool bears = stretch(log_axes(bodies_[i]), l) <= kMostStretch;
      if (bears) weights[i] = portable::exp(-d * d / (2.0 * kNearAxes * kNearAxes));
    }
    const auto number = static_cast<std::size_t>(2 + (random.uniform() < 0.5));
    std::vector<DonorShare> donors;
    while (donors.size() < number &&
           std::any_of(weights.begin(), weights.end(), [](double w) { return w > 0.0; })) {
      const std::optional<std::size_t> near = donors.empty() ? near_body() : std::nullopt;
      const std::size_t body = near ? *near : choose(weights, random);
      weights[body] = 0.0;
      donors.push_back({body, draw_gamma_three_halves(random)});
    }
    double total = 0.0;
    for (const DonorShare& donor : donors) total += donor.share;
    for (DonorShare& donor : donors) donor.share = std::max(0.01, donor.share / total);
    // What lies near a body has most of it.
    if (near_body()) {
      const auto most =
          std::max_element(donors.begin(), donors.end(),
                           [](const DonorShare& a, const DonorShare& b) { return a.share < b.share; });
      std::swap(donors.front().share, most->share);
    }
    std::stable_sort(donors.begin(), donors.end(),
                     [](const DonorShare& a, const DonorShare& b) { return a.share > b.share; });
    return donors;
  }

  Donor donor(const DonorShare& share, const LogAxes& l, CounterRandom& random) const {
    const MeasuredBody& measured = bodies_[share.body];
    Donor donor;
    donor.name = measured.name;
    donor.share = round_to_seven_digits(share.share);
    for (bool& mirror : donor.mirror) mirror = random.uniform() < 0.5;
    const double angle = random.uniform(-180.0, 180.0);
    const LogAxes own = log_axes(measured);
    if (own[0] - own[1] < kRoundAxes && l[0] - l[1] < kRoundAxes) donor.turn = round_to_seven_digits(angle);
    donor.half_axes = {round_to_seven_digits(measured.half_axes.x),
                       round_to_seven_digits(measured.half_axes.y),
                       round_to_seven_digits(measured.half_axes.z)};
    donor.body = {in_own_frame(measured)};
    return donor;
  }

  // The diameter of a draw, from a stream of its own so that it does not depend on the shape's attempts.
  double drawn_diameter(const std::vector<DonorShare>& donors) const {
    CounterRandom random(recipe_.seed, kSizeStream);
    if (conditions_.diameter) {
      const double deviation = std::min(conditions_.diameter_deviation, *conditions_.diameter);
      double diameter = 0.0;
      do {
        diameter = *conditions_.diameter + deviation * random.normal();
      } while (!(diameter > 0.1 * *conditions_.diameter));
      return diameter;
    }
    double log_diameter = 0.0;
    for (const DonorShare& donor : donors)
      log_diameter += donor.share * portable::log(bodies_[donor.body].diameter);
    return portable::exp(log_diameter);
  }

  std::optional<DrawnBody> attempt_draw(CounterRandom& random) const {
    const LogAxes l = drawn_axes(random);
    if (l[0] - l[2] > portable::log(kMostElongation)) return {};
    DrawnBody drawn;
    drawn.donors = drawn_donors(l, random);
    if (drawn.donors.size() < kLeastDonors) return {};
    drawn.kind = bodies_[drawn.donors.front().body].kind;
    drawn.diameter = drawn_diameter(drawn.donors);
    drawn.recipe = recipe_;
    drawn.recipe.population.reset();
    Morph& morph = drawn.recipe.body.emplace().morph.emplace();
    morph.roughness = std::clamp(portable::exp(kRoughnessSpread * random.normal()), 0.3, 2.5);
    for (const DonorShare& share : drawn.donors) morph.donors.push_back(donor(share, l, random));
    morph.half_axes = {portable::exp(l[0]), portable::exp(l[1]), portable::exp(l[2])};
    if (!fit_to_size(drawn.diameter, *drawn.recipe.body)) return {};
    round(morph);
    drawn.recipe.description = description(drawn);
    return drawn;
  }

  // Scales a body of about unit radius to its diameter, with its centre of mass at the origin. Returns false
  // where it is not one piece without handles and cavities.
  static bool fit_to_size(double diameter, MetaballBody& body) {
    Recipe bare;
    bare.body = body;
    TriangleMesh mesh;
    try {
      mesh = make_coarse_mesh(ImplicitField(bare), kCheckCells);
    } catch (const InputError&) {
      return false;  // beyond the domain of its grid
    }
    const MeshTopology topology = analyze_topology(mesh);
    if (!topology.closed || topology.components != 1 || topology.genus != 0) return false;
    const double ratio = diameter / portable::cbrt(6.0 / std::numbers::pi * volume(mesh));
    Morph& morph = *body.morph;
    morph.half_axes *= ratio;
    morph.center = -ratio * volume_centroid(mesh);
    return true;
  }

  static void round(Morph& morph) {
    for (double* number : {&morph.half_axes.x, &morph.half_axes.y, &morph.half_axes.z, &morph.center.x,
                           &morph.center.y, &morph.center.z, &morph.roughness}) {
      *number = round_to_seven_digits(*number);
    }
  }

  std::string description(const DrawnBody& drawn) const {
    std::string text = recipe_.description;
    if (!text.empty()) text += ". ";
    text += "Drawn between";
    const char* before = " ";
    for (const DonorShare& donor : drawn.donors) {
      text += fmt::format("{}{} ({:.0f} %)", before, bodies_[donor.body].name, 100.0 * donor.share);
      before = ", ";
    }
    return text;
  }

  const Recipe& recipe_;
  const std::vector<MeasuredBody>& bodies_;
  const DrawConditions& conditions_;
  std::vector<std::size_t> eligible_;
};

}  // namespace

DrawnBody draw_body(const Recipe& recipe) { return PopulationDraw(recipe).draw(); }

const MeasuredBody* ground_donor(const DrawnBody& drawn, const BodyPopulation& population) {
  const MeasuredBody* best = nullptr;
  double least = 0.0, roughest = 0.0;
  for (const MeasuredBody& body : population.bodies)
    if (!body.recipe.empty()) roughest = std::max(roughest, body.roughness);
  for (const MeasuredBody& body : population.bodies) {
    if (body.recipe.empty()) continue;
    // The logarithm of the ratio of the diameters, that of the greatest roughness over its own twice, since
    // ground that a model does not show looks molten, a half for another class, one for a model that is no
    // camera's.
    const double smooth = body.roughness > 0.0 ? portable::log(roughest / body.roughness) : 0.0;
    const double unlike = std::fabs(portable::log(body.diameter / drawn.diameter)) + 2.0 * smooth +
                          0.5 * (body.kind != drawn.kind) + (body.source != ShapeSource::kCamera);
    if (best == nullptr || unlike < least) best = &body, least = unlike;
  }
  return best;
}

Recipe lay_ground(const DrawnBody& drawn, const MeasuredBody& measured, const Recipe& donor,
                  const std::string& donor_name) {
  for (const Layer& layer : donor.layers) {
    if (!donor.body || !std::holds_alternative<ReliefLayer>(layer)) continue;
    const double ratio = drawn.diameter * measured.unit / measured.diameter;
    Recipe recipe = drawn.recipe;
    recipe.layers.insert(recipe.layers.begin(), rescaled(drawn_from(*donor.body, layer), ratio));
    return recipe;
  }
  throw InputError(donor_name + ": holds no relief, which the population says it has; fit it anew");
}

}  // namespace astrolith
