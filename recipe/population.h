// A population of measured bodies, from which bodies that nobody has seen are drawn
// (synthesis/finish/population_draw.h). Include recipe/recipe.h, which includes this file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recipe/body.h"

namespace astrolith {

// What a body looks like, by features of its shape (tasks/estimation/body_class.h).
enum class BodyClass { kTop, kContactBinary, kElongated, kRounded, kFragment };
inline constexpr BodyClass kBodyClasses[] = {BodyClass::kTop, BodyClass::kContactBinary,
                                             BodyClass::kElongated, BodyClass::kRounded,
                                             BodyClass::kFragment};
constexpr std::string_view class_word(BodyClass kind) {
  constexpr std::string_view kWords[] = {"top", "contact_binary", "elongated", "rounded", "fragment"};
  return kWords[static_cast<int>(kind)];
}

// How the shape was measured. Models from radar and light curves are smoother than those from cameras.
enum class ShapeSource { kCamera, kRadar, kAdaptiveOptics, kLightCurve };
inline constexpr ShapeSource kShapeSources[] = {ShapeSource::kCamera, ShapeSource::kRadar,
                                                ShapeSource::kAdaptiveOptics, ShapeSource::kLightCurve};
constexpr std::string_view source_word(ShapeSource source) {
  constexpr std::string_view kWords[] = {"camera", "radar", "adaptive_optics", "light_curve"};
  return kWords[static_cast<int>(source)];
}

struct MeasuredBody {
  std::string name;  // of at least one letter, each name once in a population
  BodyClass kind = BodyClass::kRounded;
  ShapeSource source = ShapeSource::kCamera;
  double diameter = 1.0;         // of the sphere of its volume, in the recipe's length unit, > 0
  double rotation_period = 0.0;  // hours; 0 = unknown
  double density = 0.0;          // kg / m^3; 0 = unknown
  // The fitted body in a frame and a length unit of its own: metaballs without operations, groups and warp.
  std::vector<MetaballBody> body;  // exactly one
  double unit = 1.0;               // the recipe's length units in one of the body's, > 0
  // Its centre of mass, the half axes of the ellipsoid with its moments of inertia, longest first, and the
  // unit vectors along them, a right-handed frame; all in the frame and the unit of `body`.
  Vec3d center;
  Vec3d half_axes{1.0, 1.0, 1.0};
  Vec3d axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  // How rough the ground of its recipe is: the rms of its relief over means within some two hundredths of the
  // diameter, in diameters. Coarse and smoothed models have little; 0 = unknown.
  double roughness = 0.0;
  // The file of its whole recipe, with a relief, relative to the folder of the population; or empty. A drawn
  // body's ground is laid from it.
  std::string recipe;
};

// What is known of a body before it is seen. Without any of it a draw is as likely as the measured bodies
// are.
struct DrawConditions {
  std::optional<double> diameter;     // of the sphere of equal volume, length units, > 0
  double diameter_deviation = 0.0;    // standard deviation, length units
  std::vector<double> axes;           // ratios of its half axes a : b : c, longest first; or none
  double axes_deviation = 0.05;       // standard deviation of the logarithm of each, [0, 1]
  std::optional<BodyClass> kind;      // donors of this class alone
  std::optional<ShapeSource> source;  // donors of this source alone
  std::string near;                   // the name of a body that is one of the donors; or empty
};

// A recipe with a population has no body. Its members are bodies drawn from it, under the recipe's layers.
struct BodyPopulation {
  DrawConditions draw;
  std::vector<MeasuredBody> bodies;  // at least kLeastDonors
};

}  // namespace astrolith
