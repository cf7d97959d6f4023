#include "synthesis/finish/recipe_variation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "recipe/recipe_json.h"
#include "synthesis/body/body_spheres.h"
#include "synthesis/finish/lay_on_base.h"
#include "synthesis/noise/coordinate_warp.h"

namespace astrolith {
namespace {

// Sizes of the deformation at strength 1: the standard deviation of the logarithms of the axes' stretch, and
// the largest displacement of the bend as a fraction of half the diagonal of the body.
constexpr double kAxisStretch = 0.3;
constexpr double kBend = 0.35;
constexpr double kBendCycles = 0.5;  // cycles in half a diagonal

// Standard deviations of the logarithms of amplitudes and frequencies at strength 1.
constexpr double kAmplitudeChange = 0.5;
constexpr double kFrequencyChange = 0.25;

// The standard deviations of the logarithms of a morph's roughness and shares at strength 1, and that of the
// turns of its donors in degrees.
constexpr double kRoughnessChange = 0.4;
constexpr double kShareChange = 0.8;
constexpr double kTurn = 30.0;

enum Stream : std::uint64_t { kSeedStream, kAxesStream, kBendStream, kLayerStream, kMorphStream };

Box sphere_bounds(const MetaballBody& body) {
  Box box;
  for (const Sphere& s : adding_spheres(body)) {
    const Vec3d r{s.radius, s.radius, s.radius};
    box.extend(s.center - r);
    box.extend(s.center + r);
  }
  return box;
}

// A smooth map of space: a bend, followed by a stretch along the axes.
class Deformation {
 public:
  Deformation(const Box& body, double strength, std::uint64_t seed)
      : center_(body.center()),
        step_(0.01 * body.diagonal()),
        warp_(make_coordinate_warp(bend(body, strength), bend_seed(seed), body, arrays_)) {
    CounterRandom random(seed, kAxesStream);
    const auto factor = [&] {
      return portable::exp(kAxisStretch * strength * std::clamp(random.normal(), -2.0, 2.0));
    };
    stretch_ = {factor(), factor(), factor()};
  }

  Vec3d operator()(const Vec3d& p) const {
    const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
    float wx = 0, wy = 0, wz = 0;
    warp_points(warp_, arrays_.view(), 1, &x, &y, &z, &wx, &wy, &wz);
    const Vec3d moved = p + Vec3d{double{wx} - double{x}, double{wy} - double{y}, double{wz} - double{z}};
    const Vec3d d = moved - center_;
    return center_ + Vec3d{stretch_.x * d.x, stretch_.y * d.y, stretch_.z * d.z};
  }

  // The factor by which lengths grow near p: the cube root of the growth of a small volume, limited to 0.2 ..
  // 5 before the root.
  double growth(const Vec3d& p) const {
    const auto slope = [&](const Vec3d& d) { return (0.5 / step_) * ((*this)(p + d) - (*this)(p - d)); };
    const Vec3d a = slope({step_, 0, 0}), b = slope({0, step_, 0}), c = slope({0, 0, step_});
    return portable::cbrt(std::clamp(dot(a, cross(b, c)), 0.2, 5.0));
  }

 private:
  static Warp bend(const Box& body, double strength) {
    const double half = 0.5 * body.diagonal();
    Warp warp;
    warp.amplitude = kBend * strength * half;
    warp.frequency = kBendCycles / half;
    warp.octaves = 1;
    return warp;
  }
  static std::uint32_t bend_seed(std::uint64_t seed) { return hash_seed(seed, kBendStream); }

  Vec3d center_;
  double step_;
  ArrayStore arrays_;
  CoordinateWarp warp_;
  Vec3d stretch_{1, 1, 1};
};

// Varies a shape between measured ones: its axes, what it has of each donor, and how rough it is.
void vary(Morph& morph, double strength, std::uint64_t seed) {
  CounterRandom random(seed, kMorphStream);
  const auto change = [&](double& number, double deviation) {
    number = round_to_seven_digits(
        number * portable::exp(deviation * strength * std::clamp(random.normal(), -2.0, 2.0)));
  };
  for (double* axis : {&morph.half_axes.x, &morph.half_axes.y, &morph.half_axes.z})
    change(*axis, kAxisStretch);
  change(morph.roughness, kRoughnessChange);
  for (Donor& donor : morph.donors) {
    change(donor.share, kShareChange);
    donor.turn =
        std::clamp(round_to_seven_digits(donor.turn + kTurn * strength * random.normal()), -360.0, 360.0);
  }
}

// Varies the fields that a layer names. Returns the factor by which the heights of the layer have grown.
double vary(Layer& layer, double strength, CounterRandom random) {
  return std::visit(
      [&](auto& l) {
        if constexpr (requires { l.varied(); }) {
          const VariedFields varied = l.varied();
          const double growth = portable::exp(kAmplitudeChange * strength * random.normal());
          varied.height = round_to_seven_digits(varied.height * growth);
          varied.frequency = round_to_seven_digits(
              varied.frequency * portable::exp(kFrequencyChange * strength * random.normal()));
          return growth;
        } else {
          return 1.0;
        }
      },
      layer);
}

const std::string& name_of(const Layer& layer) {
  return std::visit([](const auto& l) -> const std::string& { return l.name; }, layer);
}

// Masks follow the heights of the layer that they refer to, the last layer of that name before them. The
// width of a blend follows the heights of its own layer. What was covered therefore stays covered. `growth`
// holds the factor of each layer's heights.
void follow_heights(const std::vector<double>& growth, std::vector<Layer>& layers) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (LayerUse* use = use_of(layers[i])) {
      use->combination.width = round_to_seven_digits(use->combination.width * growth[i]);
    }
    LayerMask* mask = mask_of(layers[i]);
    if (mask == nullptr) continue;
    std::size_t asked = i;
    while (asked > 0 && name_of(layers[asked - 1]) != mask->layer) --asked;
    if (asked == 0) continue;
    mask->from = round_to_seven_digits(mask->from * growth[asked - 1]);
    mask->to = round_to_seven_digits(mask->to * growth[asked - 1]);
  }
}

}  // namespace

Recipe vary_recipe(const Recipe& recipe, double strength, std::uint64_t variation_seed, VariedNoise noise) {
  Recipe varied = recipe;
  if (noise == VariedNoise::kNew) {
    varied.seed =
        CounterRandom(recipe.seed ^ (variation_seed * 0x9e3779b97f4a7c15u), kSeedStream).next() >> 11;
  }
  varied.provenance.achieved.clear();
  if (varied.body->morph) {
    vary(*varied.body->morph, strength, variation_seed);
  } else {
    const Deformation deform(sphere_bounds(*recipe.body), strength, variation_seed);
    for_each_sphere(*varied.body, [&](Sphere& s) {
      const Vec3d c = deform(s.center);
      s.radius = round_to_seven_digits(s.radius * deform.growth(s.center));
      s.center = {round_to_seven_digits(c.x), round_to_seven_digits(c.y), round_to_seven_digits(c.z)};
    });
  }
  std::vector<double> growth;
  for (std::size_t i = 0; i < varied.layers.size(); ++i) {
    const CounterRandom random(variation_seed, (std::uint64_t{kLayerStream} << 32) + i);
    varied.layers[i] = drawn_from(*recipe.body, varied.layers[i]);
    growth.push_back(vary(varied.layers[i], strength, random));
  }
  follow_heights(growth, varied.layers);
  return varied;
}

}  // namespace astrolith
