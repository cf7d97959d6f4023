// Lists of fields of a population of measured bodies, with their rules.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "recipe/fields_internal.h"

namespace astrolith {
namespace {

void check_axes(const MeasuredBody& body, const Place& place) {
  const Vec3d &a = body.axes[0], &b = body.axes[1], &c = body.axes[2];
  constexpr double kSlack = 1e-3;
  const auto unlike = [](double value, double expected) { return !(std::fabs(value - expected) < kSlack); };
  if (unlike(squared_norm(a), 1.0) || unlike(squared_norm(b), 1.0) || unlike(dot(a, b), 0.0) ||
      unlike(norm(cross(a, b) - c), 0.0)) {
    place.field("axes").fail("must be three unit vectors of a right-handed frame");
  }
}

void check_measured_body(const MeasuredBody& body, const Place& place) {
  if (body.name.empty()) place.field("name").fail("must be a name of at least one letter");
  const Place at = place.field("body");
  if (body.body.size() != 1) at.fail("must be one body");
  check_plain_metaballs(body.body.front(), at);
  check_axes(body, place);
}

void check_conditions(const DrawConditions& draw, const Place& place) {
  if (draw.axes.empty()) return;
  const Place at = place.field("axes");
  if (draw.axes.size() != 3) at.fail(fmt::format("must be three numbers, are {}", draw.axes.size()));
  if (!(draw.axes[0] >= draw.axes[1] && draw.axes[1] >= draw.axes[2])) at.fail("must begin with the longest");
  if (const double ratio = draw.axes[0] / draw.axes[2]; ratio > kMostElongation) {
    at.fail(fmt::format("have a ratio of {:.3g}; no body is drawn beyond {:g}, so state rounder ones", ratio,
                        kMostElongation));
  }
}

void check_population(const BodyPopulation& population, const Place& place) {
  const std::vector<MeasuredBody>& bodies = population.bodies;
  const Place at = place.field("bodies");
  if (bodies.size() < kLeastDonors) {
    at.fail(fmt::format("must be at least {}, are {}; add models with fit_population", kLeastDonors,
                        bodies.size()));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto same = [&](const MeasuredBody& other) { return other.name == bodies[i].name; };
    if (std::any_of(bodies.begin(), bodies.begin() + static_cast<std::ptrdiff_t>(i), same)) {
      at.element(i).field("name").fail("is there already: " + quote_text(bodies[i].name));
    }
  }
}

// A word that may be left out.
template <class T, std::size_t n>
void optional_word(FieldVisitor& v, std::string_view name, std::optional<T>& value, const T (&values)[n],
                   std::string_view (*to_word)(T)) {
  std::optional<std::string> text;
  if (value) text = std::string(to_word(*value));
  v.field(name, text);
  if (!v.reading() || !text) return;
  std::vector<std::string_view> words;
  for (const T candidate : values) {
    if (*text == words.emplace_back(to_word(candidate))) value = candidate;
  }
  if (!value)
    v.place().field(name).fail("must be " + quote_list(words, " or ") + ", is " + quote_text(*text));
}

}  // namespace

void visit_row(FieldVisitor& v, Vec3d (&axes)[3]) {
  v.array("axis", {&axes[0], &axes[1], &axes[2]}, kAnyNumber);
}

void visit_fields(FieldVisitor& v, MeasuredBody& body) {
  v.required("name", body.name);
  v.required_word("class", body.kind, kBodyClasses, class_word);
  v.required_word("source", body.source, kShapeSources, source_word);
  v.required("diameter", body.diameter, kPositive);
  v.field("rotation_period", body.rotation_period, kNotNegative);
  v.field("density", body.density, kNotNegative);
  v.field("roughness", body.roughness, kNotNegative);
  v.field("unit", body.unit, kPositive);
  v.field("center", body.center, kAnyNumber);
  v.required("half_axes", body.half_axes, kPositive);
  v.field("axes", body.axes);
  if (v.reading()) body.body.emplace_back();
  v.rule(check_measured_body, body);
  v.required("body", body.body.front());
  v.field_if(!body.recipe.empty(), "recipe", body.recipe);
}

void visit_fields(FieldVisitor& v, DrawConditions& draw) {
  v.field("diameter", draw.diameter, kPositive);
  v.field("diameter_deviation", draw.diameter_deviation, kNotNegative);
  v.field_if(!draw.axes.empty(), "axes", draw.axes, kPositive);
  v.field("axes_deviation", draw.axes_deviation, range(0.0, 1.0));
  optional_word(v, "class", draw.kind, kBodyClasses, class_word);
  optional_word(v, "source", draw.source, kShapeSources, source_word);
  v.field_if(!draw.near.empty(), "near", draw.near);
  v.rule(check_conditions, draw);
}

void visit_fields(FieldVisitor& v, BodyPopulation& population) {
  v.field("draw", population.draw);
  v.required("bodies", population.bodies);
  v.rule(check_population, population);
}

}  // namespace astrolith
