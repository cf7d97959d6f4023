#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "recipe/expect_internal.h"
#include "recipe/recipe_json.h"
#include "recipe/surface_features_internal.h"

namespace astrolith {
namespace {

void check(const Sphere& sphere, const Place& place) {
  expect_vector(sphere.center, place);
  expect_positive(sphere.radius, place.field("radius"));
}

// Of a fractal sum.
void check_octaves(double frequency, int octaves, double gain, double lacunarity, const Place& place) {
  expect_positive(frequency, place.field("frequency"));
  expect_integer(octaves, place.field("octaves"), 1, 24);
  expect_range(gain, place.field("gain"), 0.0, 4.0);
  expect_above_one(lacunarity, place.field("lacunarity"), 16.0);
  const double finest = frequency * std::pow(lacunarity, octaves - 1);
  if (finest > kMaxNumber) {
    place.field("octaves").fail(fmt::format(
        "the last octave's frequency is {:.3g}, above {:g}; use fewer octaves", finest, kMaxNumber));
  }
}

void check(const Warp& warp, const Place& place) {
  expect_number(warp.amplitude, place.field("amplitude"));
  check_octaves(warp.frequency, warp.octaves, warp.gain, warp.lacunarity, place);
}

// What a kernel that ends continuously asks for.
void check_profile(const MetaballBody& body, const Place& place) {
  const std::string kernel = quote_text(kernel_word(body.kernel));
  if (body.blend_exponent < 1.0) {
    place.field("blend_exponent")
        .fail(fmt::format("must be at least 1 for kernel {}, is {}; raise it", kernel, body.blend_exponent));
  }
  if (body.a > kMaxTension) {
    place.field("a").fail(
        fmt::format("must be at most {} for kernel {}, is {}; lower it", kMaxTension, kernel, body.a));
  }
  if (const double least = least_tension(body) + 1e-5; !(body.a >= least)) {
    place.field("a").fail(
        fmt::format("must be at least {:.6g} for kernel {} and these b and cutoff_radii, is {}; raise a, b "
                    "or cutoff_radii",
                    least, kernel, body.a));
  }
}

void check_groups(const MetaballBody& body, const Place& place) {
  for (std::size_t g = 0; g < body.groups.size(); ++g) {
    const SphereGroup& group = body.groups[g];
    const Place at = place.field(group.name);
    if (g > 0 && !(body.groups[g - 1].name < group.name)) {
      place.fail("must be sorted by name, each name once: " + quote_text(group.name) + " is not");
    }
    if (group.spheres.empty()) at.fail("must hold at least one sphere's place in the list of spheres");
    std::vector<bool> seen(body.spheres.size());
    for (std::size_t i = 0; i < group.spheres.size(); ++i) {
      expect_integer(group.spheres[i], at.element(i), 0, static_cast<int>(body.spheres.size()) - 1);
      const auto sphere = static_cast<std::size_t>(group.spheres[i]);
      if (seen[sphere]) at.element(i).fail(fmt::format("sphere {} is there already; leave it out", sphere));
      seen[sphere] = true;
    }
  }
}

// How many there are in all, and how deep.
struct OperationCount {
  int operations = 0, depth = 0;
};
OperationCount count_operations(const MetaballBody& body) {
  OperationCount all;
  for (const BodyOperation& operation : body.operations) {
    ++all.operations;
    for (const MetaballBody& operand : operation.operand) {
      const OperationCount inner = count_operations(operand);
      all.operations += inner.operations;
      all.depth = std::max(all.depth, inner.depth + 1);
    }
  }
  return all;
}

void check(const MetaballBody& body, const Place& place);

void check(const BodyOperation& operation, const Place& place) {
  expect_range(operation.alpha, place.field("alpha"), -0.9, 1.0);
  expect_range(operation.exponent, place.field("exponent"), 1.0, 64.0);
  expect_positive(operation.width, place.field("width"));
  expect_number(operation.bulge, place.field("bulge"));
  expect_positive(operation.reach[0], place.field("reach").field("a1"));
  expect_positive(operation.reach[1], place.field("reach").field("a2"));
  if (operation.operand.size() != 1) place.field("body").fail("must be one body");
  const MetaballBody& operand = operation.operand.front();
  if (!operand.groups.empty()) {
    place.field("body").field("groups").fail("only the first body's spheres can be grouped; leave them out");
  }
  check(operand, place.field("body"));
}

void check(const MetaballBody& body, const Place& place) {
  expect_positive(body.a, place.field("a"));
  expect_positive(body.b, place.field("b"));
  expect_positive(body.blend_exponent, place.field("blend_exponent"));
  if (body.blend_exponent * body.a > kMaxKernelExponent) {
    place.field("blend_exponent")
        .fail(fmt::format("blend_exponent * a must be at most {}, is {}; lower one of them",
                          kMaxKernelExponent, body.blend_exponent * body.a));
  }
  expect_positive(body.iso_value, place.field("iso_value"));
  expect_above_one(body.cutoff_radii, place.field("cutoff_radii"), kMaxNumber);
  if (body.kernel != Kernel::kGaussian) check_profile(body, place);
  const Place spheres = place.field("spheres");
  if (body.spheres.empty()) spheres.fail("must hold at least one [x, y, z, radius]");
  for (std::size_t i = 0; i < body.spheres.size(); ++i) check(body.spheres[i], spheres.element(i));
  check_groups(body, place.field("groups"));
  if (body.warp) check(*body.warp, place.field("warp"));
  const Place operations = place.field("operations");
  const OperationCount count = count_operations(body);
  if (count.operations > kMaxOperations || count.depth > kMaxOperationDepth) {
    operations.fail(fmt::format("must be at most {} in all and {} deep, are {} and {}; leave some out",
                                kMaxOperations, kMaxOperationDepth, count.operations, count.depth));
  }
  for (std::size_t i = 0; i < body.operations.size(); ++i) check(body.operations[i], operations.element(i));
}

// A recipe without a body is laid on one later.
void check(const LayerUse& use, const std::optional<MetaballBody>& body, const Place& place) {
  if (!use.locality) return;
  const Place locality = place.field("locality");
  expect_positive(use.locality->width, locality.field("width"));
  if (body && body->find_group(use.locality->group) == nullptr) {
    locality.field("group").fail("the body has no group " + quote_text(use.locality->group) +
                                 "; name one of body.groups");
  }
}

void check(const FractalLayer& layer, const Place& place) {
  expect_number(layer.amplitude, place.field("amplitude"));
  check_octaves(layer.frequency, layer.octaves, layer.gain, layer.lacunarity, place);
  expect_vector(layer.scale, place.field("scale"));
  expect_vector(layer.bias, place.field("bias"));
  expect_number(layer.weight, place.field("weight"));
  expect_range(layer.gradient_modulation, place.field("gradient_modulation"), 0.0,
               is_worley(layer.noise) ? 0.0 : kMaxNumber);
  if (layer.warp) check(*layer.warp, place.field("warp"));
}

void check(const GaborLobe& lobe, const Place& place) {
  expect_integer(lobe.bandwidth, place.field("bandwidth"), 1, 12);
  expect_range(lobe.frequency_x, place.field("frequency_x"), -0.5, 0.5);
  expect_range(lobe.frequency_y, place.field("frequency_y"), -0.5, 0.5);
  expect_positive(lobe.variance, place.field("variance"));
}

void check(const LayerColor& color, const Place& place) {
  const Place axis = place.field("axis");
  expect_range(color.axis.x, axis.field("x"), -1.0, 1.0);
  expect_range(color.axis.y, axis.field("y"), -1.0, 1.0);
  expect_range(color.axis.z, axis.field("z"), -1.0, 1.0);
  expect_vector(color.mean, place.field("mean"));
}

void check(const GaborLayer& layer, const Place& place) {
  expect_positive(layer.pixel_size, place.field("pixel_size"));
  expect_not_negative(layer.height_rms, place.field("height_rms"));
  expect_integer(layer.impulses_per_kernel, place.field("impulses_per_kernel"), 1, 1024);
  expect_number(layer.exemplar_mean, place.field("exemplar_mean"));
  expect_not_negative(layer.exemplar_rms, place.field("exemplar_rms"));
  if (layer.color) check(*layer.color, place.field("color"));
  const Place lobes = place.field("lobes");
  if (layer.lobes.empty())
    lobes.fail("must hold at least one [bandwidth, frequency_x, frequency_y, variance]");
  for (std::size_t i = 0; i < layer.lobes.size(); ++i) check(layer.lobes[i], lobes.element(i));
}

// What bounds the number of impulses that one point needs.
void check_spot_counts(const SpotLayer& layer, const Place& place) {
  const Vec3d& v = layer.variances;
  const double half_axis = layer.size * std::sqrt(layer.sigma * std::max({v.x, v.y, v.z}));
  if (!(half_axis <= kMaxSpotCells * layer.cell_size)) {
    place.field("cell_size")
        .fail(fmt::format(
            "a spot's half axis size * sqrt(sigma * variance) must be at most {:g} cells, is {:.3g}; "
            "use larger cells or smaller spots",
            kMaxSpotCells, half_axis / layer.cell_size));
  }
  const double finest =
      layer.density * std::pow(layer.lacunarity, (layer.layers - 1) * (layer.exponent - 2.0));
  if (!(std::max(layer.density, finest) <= kMaxSpotDensity)) {
    place.field("density").fail(fmt::format(
        "must be at most {:g} impulses a cell at every size, is {:.3g}; lower it, the exponent or the layers",
        kMaxSpotDensity, std::max(layer.density, finest)));
  }
}

void check(const SpotLayer& layer, const Place& place) {
  expect_number(layer.amplitude, place.field("amplitude"));
  expect_positive(layer.size, place.field("size"));
  expect_positive(layer.cell_size, place.field("cell_size"));
  expect_not_negative(layer.density, place.field("density"));
  expect_range(layer.probability, place.field("probability"), 0.0, 1.0);
  expect_range(layer.reach, place.field("reach"), 0.0, 1.0);
  expect_range(layer.least_weight, place.field("least_weight"), 0.0, 1.0);
  expect_range(layer.gaussian, place.field("gaussian"), -1e6, 1e6);
  expect_range(layer.alpha, place.field("alpha"), 0.0, 1e6);
  expect_range(layer.kappa, place.field("kappa"), -1e6, 1e6);
  expect_range(layer.beta, place.field("beta"), 0.0, 1e6);
  expect_range(layer.gamma, place.field("gamma"), 1e-6, 1e6);
  const Place variances = place.field("variances");
  expect_range(layer.variances.x, variances.field("x"), 1e-6, 1e6);
  expect_range(layer.variances.y, variances.field("y"), 1e-6, 1e6);
  expect_range(layer.variances.z, variances.field("z"), 1e-6, 1e6);
  expect_range(layer.sigma, place.field("sigma"), 1e-6, 1e6);
  expect_integer(layer.layers, place.field("layers"), 1, 12);
  expect_above_one(layer.lacunarity, place.field("lacunarity"), 16.0);
  expect_range(layer.gain, place.field("gain"), 0.0, 4.0);
  expect_range(layer.exponent, place.field("exponent"), 0.0, 6.0);
  check_spot_counts(layer, place);
}

void check(const SparseLayer& layer, const Place& place) {
  expect_number(layer.amplitude, place.field("amplitude"));
  expect_positive(layer.cell_size, place.field("cell_size"));
  expect_integer(layer.levels, place.field("levels"), 1, 16);
  expect_range(layer.probability, place.field("probability"), 0.0, 1.0);
  expect_range(layer.threshold, place.field("threshold"), 0.0, 1.0);
  expect_range(layer.gain, place.field("gain"), 0.0, 4.0);
}

void check(const Erosion& erosion, const Place& place) {
  expect_range(erosion.talus_angle, place.field("talus_angle"), 1.0, 85.0);
  expect_integer(erosion.iterations, place.field("iterations"), 1, 100000);
  expect_range(erosion.density, place.field("density"), 1.0, 30000.0);
  if (erosion.rotation_period != 0.0) {
    expect_range(erosion.rotation_period, place.field("rotation_period"), 0.01, 1e6);
  }
}

void expect_direction(const Vec3d& v, const Place& place) {
  expect_vector(v, place);
  if (norm(v) < kMinPositive) place.fail("must not be zero; give the direction");
}

void check(const RandomPhaseLayer& layer, const Place& place) {
  expect_not_negative(layer.height_rms, place.field("height_rms"));
  expect_positive(layer.cell_size, place.field("cell_size"));
  expect_integer(layer.waves, place.field("waves"), 1, 128);
  expect_positive(layer.frequency_min, place.field("frequency_min"));
  expect_positive(layer.frequency_max, place.field("frequency_max"));
  if (layer.frequency_max < layer.frequency_min) {
    place.field("frequency_max")
        .fail(fmt::format("must be at least frequency_min, {}, is {}; swap them", layer.frequency_min,
                          layer.frequency_max));
  }
  expect_range(layer.exponent, place.field("exponent"), -8.0, 8.0);
  expect_direction(layer.direction, place.field("direction"));
  expect_range(layer.spread, place.field("spread"), 0.0, 1.0);
  expect_range(layer.randomness, place.field("randomness"), 0.0, 1.0);
}

void check(const PhasorLayer& layer, const Place& place) {
  expect_number(layer.amplitude, place.field("amplitude"));
  expect_positive(layer.frequency, place.field("frequency"));
  expect_positive(layer.cell_size, place.field("cell_size"));
  if (!(layer.frequency * layer.cell_size <= kMaxPhasorTurns)) {
    place.field("cell_size")
        .fail(fmt::format("frequency * cell_size must be at most {:g}, is {:.3g}; use smaller cells",
                          kMaxPhasorTurns, layer.frequency * layer.cell_size));
  }
  expect_integer(layer.impulses_per_cell, place.field("impulses_per_cell"), 1, 16);
  expect_direction(layer.direction, place.field("direction"));
  expect_range(layer.spread, place.field("spread"), 0.0, 1.0);
}

template <typename T>
void expect_sorted(const std::vector<std::pair<std::string, T>>& named, const Place& place) {
  for (std::size_t i = 1; i < named.size(); ++i) {
    if (!(named[i - 1].first < named[i].first)) {
      place.fail("must be sorted by name, each name once: " + quote_text(named[i].first) + " is not");
    }
  }
}

void check(const Provenance& provenance, const Place& place) {
  if (provenance.input_name.find('/') != std::string::npos) {
    place.field("input_name")
        .fail("must be a file name without folders, is " + quote_text(provenance.input_name));
  }
  const std::string& hash = provenance.input_sha256;
  const bool digits = std::all_of(hash.begin(), hash.end(), [](unsigned char c) { return std::isxdigit(c); });
  if (!hash.empty() && (hash.size() != 64 || !digits)) {
    place.field("input_sha256").fail("must be 64 hexadecimal digits or empty, is " + quote_text(hash));
  }
  expect_sorted(provenance.options, place.field("options"));
  const Place achieved = place.field("achieved");
  expect_sorted(provenance.achieved, achieved);
  for (const auto& [name, value] : provenance.achieved) {
    if (!std::isfinite(value)) achieved.field(name).fail(fmt::format("must be finite, is {}", value));
  }
}

}  // namespace

void validate_recipe(const Recipe& recipe, const std::string& name) {
  const Place place(name);
  if (recipe.format_version != kRecipeFormatVersion) {
    place.field("format_version")
        .fail(fmt::format("must be {}, is {}", kRecipeFormatVersion, recipe.format_version));
  }
  const std::string& unit = recipe.length_unit;
  if (unit != "m" && unit != "km" && unit != "px") {
    place.field("length_unit").fail("must be \"m\", \"km\" or \"px\", is " + quote_text(unit));
  }
  if (recipe.seed >= std::uint64_t{1} << 53) {
    place.field("seed").fail(fmt::format("must be below 2^53, is {}", recipe.seed));
  }
  check(recipe.provenance, place.field("provenance"));
  if (!recipe.body && recipe.layers.empty()) place.fail("has neither a body nor layers; add one of them");
  if (recipe.body) check(*recipe.body, place.field("body"));
  const Place layers = place.field("layers");
  for (std::size_t i = 0; i < recipe.layers.size(); ++i) {
    const Place at = layers.element(i);
    std::visit([&](const auto& layer) { check(layer, at); }, recipe.layers[i]);
    if (const LayerUse* use = use_of(recipe.layers[i])) check(*use, recipe.body, at);
  }
  if (!recipe.erosion) return;
  check(*recipe.erosion, place.field("erosion"));
  if (!recipe.body) place.field("erosion").fail("needs a body; add one, or leave it out");
}

}  // namespace astrolith
