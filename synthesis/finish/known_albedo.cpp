#include "synthesis/finish/known_albedo.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/triangle_mesh.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

constexpr const char* kMottles = "mottles";

// Normal albedos and what is said of their spread are published; shares of colours follow spectral slopes of
// the kinds of bodies, and how much craters and boulders differ is chosen within what pictures show.
constexpr std::array<KnownAlbedo, 6> kKnown{{
    {"bennu",
     {0.046, {0.98, 1.0, 1.02}, 1.08, {}},
     0.09,
     {0.044, 0.16, 0.015, 2.4, {0.98, 1.0, 1.02}},
     {1.15, {0.97, 1.0, 1.04}},
     "normal albedo .046, full width at half maximum some 25 %, boulders above .10 (Golish et al. 2021)"},
    {"ryugu",
     {0.0406, {1.0, 1.0, 0.99}, 1.06, {}},
     0.06,
     {0.0406, 0.1, 0.004, 2.0, {1.0, 1.0, 1.0}},
     {1.1, {0.97, 1.0, 1.04}},
     "normal albedo .0406 at 550 nm (Yokota et al. 2021)"},
    {"itokawa",
     {0.27, {1.13, 1.0, 0.82}, 1.2, {}},
     0.07,
     {0.25, 0.12, 0.01, 1.4, {1.12, 1.0, 0.83}},
     {1.2, {0.97, 1.0, 1.03}},
     "geometric albedo .27 +- .02 (Tatsumi et al.)"},
    {"eros",
     {0.23, {1.14, 1.0, 0.8}, 1.4, {}},
     0.06,
     {0.24, 0.1, 0.0, 1.0, {1.13, 1.0, 0.81}},
     {1.3, {0.98, 1.0, 1.02}},
     "geometric albedo .23 (Li 2005), walls of craters brighter than their surroundings (NEAR)"},
    {"67p",
     {0.055, {1.13, 1.0, 0.86}, 1.1, {}},
     0.12,
     {0.055, 0.2, 0.01, 1.5, {1.1, 1.0, 0.9}},
     {1.1, {0.96, 1.0, 1.06}},
     "mean .055, from .02 to .09 (Davidsson et al. 2022)"},
    {"vesta",
     {0.38, {1.06, 1.0, 0.88}, 1.15, {}},
     0.068,
     {0.38, 0.15, 0.01, 1.5, {1.05, 1.0, 0.9}},
     {1.35, {0.98, 1.0, 1.03}},
     "geometric albedo .38 +- .04, full width at half maximum 17 %, .55 to 2 times that in places (Li et al. "
     "2013)"},
}};

// The longest side of the bare body, about.
double size_of_body(const MetaballBody& body) {
  if (body.morph) {
    const Vec3d& half = body.morph->half_axes;
    return 2.0 * std::max({half.x, half.y, half.z});
  }
  Box box;
  for (const Sphere& sphere : body.spheres) {
    const Vec3d radius{sphere.radius, sphere.radius, sphere.radius};
    box.extend(sphere.center - radius);
    box.extend(sphere.center + radius);
  }
  return box.longest_side();
}

// Mottles from a quarter of the body down to some 1/2000 of it.
FractalLayer mottles(double size, double deviation) {
  constexpr double kDeviation = 0.5;  // of the sum of octaves over the amplitude
  FractalLayer layer;
  layer.name = kMottles;
  layer.amplitude = 0.01 * size;
  layer.frequency = 4.0 / size;
  layer.octaves = 9;
  layer.gain = 0.65;
  layer.use.combination.kind = Combine::kMask;
  layer.use.albedo = LayerAlbedo{.contrast = deviation / kDeviation};
  return layer;
}

bool is_mottles(const Layer& layer) {
  const FractalLayer* const noise = std::get_if<FractalLayer>(&layer);
  return noise != nullptr && noise->name == kMottles && noise->use.combination.kind == Combine::kMask;
}

}  // namespace

std::span<const KnownAlbedo> known_albedos() { return kKnown; }

KnownAlbedo drawn_albedo(std::uint64_t seed) {
  constexpr std::uint64_t kStream = 0xa1bed0;
  constexpr double kDarkShare = 0.253, kDark = 0.030, kBright = 0.168, kLeast = 0.02, kMost = 0.6;
  CounterRandom random(seed, kStream);
  const bool dark = random.uniform() < kDarkShare;
  KnownAlbedo known = kKnown[dark ? 0 : 2];
  const double rayleigh = std::sqrt(-2.0 * portable::log(1.0 - random.uniform()));
  const double normal = std::clamp((dark ? kDark : kBright) * rayleigh, kLeast, kMost);
  // From the blue of B types to the red of D types, and from grey to the red of Itokawa.
  const double slope = dark ? random.uniform(-0.4, 1.6) : random.uniform(0.3, 1.1);
  const Vec3d red = dark ? Vec3d{0.06, 0.0, -0.07} : known.ground.color - Vec3d{1.0, 1.0, 1.0};
  known.ground.color = known.boulders.color = Vec3d{1.0, 1.0, 1.0} + slope * red;
  known.boulders.normal *= normal / known.ground.normal;
  known.ground.normal = normal;
  known.source = "drawn for a near-Earth asteroid (Wright et al. 2016)";
  return known;
}

KnownAlbedo named_albedo(std::string_view name, std::uint64_t seed) {
  if (name == kDrawnAlbedo) return drawn_albedo(seed);
  std::string names;
  for (const KnownAlbedo& known : known_albedos()) {
    if (known.name == name) return known;
    names += fmt::format("{}, ", known.name);
  }
  throw InputError(fmt::format("albedo: there is none of {}; give one of {}{}", name, names, kDrawnAlbedo));
}

void set_albedo(Recipe& recipe, const KnownAlbedo& known) {
  recipe.albedo = known.ground;
  if (!recipe.layers.empty() && is_mottles(recipe.layers.back())) recipe.layers.pop_back();
  // Other layers keep their places, and with them their random numbers.
  for (Layer& layer : recipe.layers) {
    if (CraterLayer* craters = std::get_if<CraterLayer>(&layer)) craters->albedo = known.craters;
    if (BoulderLayer* boulders = std::get_if<BoulderLayer>(&layer)) boulders->albedo = known.boulders;
    if (LayerUse* use = find_use(layer)) use->albedo.reset();
  }
  if (known.mottling > 0.0) recipe.layers.push_back(mottles(size_of_body(*recipe.body), known.mottling));
}

}  // namespace astrolith
