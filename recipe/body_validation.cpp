#include <algorithm>
#include <cmath>

#include "recipe/body_internal.h"
#include "recipe/expect_internal.h"

namespace astrolith {
namespace {

void check(const Sphere& sphere, const Place& place) {
  expect_vector(sphere.center, place);
  expect_positive(sphere.radius, place.field("radius"));
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

}  // namespace

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
  const Place subtract = place.field("subtract");
  const double exponent = body.blend_exponent * (body.a - std::log(body.iso_value));
  if (!body.subtract.empty() && exponent > kMaxNetExponent) {
    subtract.fail(
        fmt::format("asks for blend_exponent * (a - log(iso_value)) of at most {}, is {}; lower one "
                    "of them, or raise iso_value",
                    kMaxNetExponent, exponent));
  }
  for (std::size_t i = 0; i < body.subtract.size(); ++i) check(body.subtract[i], subtract.element(i));
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

}  // namespace astrolith
