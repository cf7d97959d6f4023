// Lists of fields of a recipe's body, with their rules.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/portable_double.h"
#include "recipe/fields_internal.h"

namespace astrolith {
namespace {

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

void check_operations(const MetaballBody& body, const Place& place) {
  const OperationCount count = count_operations(body);
  if (count.operations <= kMaxOperations && count.depth <= kMaxOperationDepth) return;
  place.field("operations")
      .fail(fmt::format("must be at most {} in all and {} deep, are {} and {}; leave some out",
                        kMaxOperations, kMaxOperationDepth, count.operations, count.depth));
}

void check_operand(const BodyOperation& operation, const Place& place) {
  const Place body = place.field("body");
  if (operation.operand.size() != 1) body.fail("must be one body");
  if (!operation.operand.front().groups.empty()) {
    body.field("groups").fail("only the first body's spheres can be grouped; leave them out");
  }
}

void check_kernel_exponent(const MetaballBody& body, const Place& place) {
  if (body.blend_exponent * body.a <= kMaxKernelExponent) return;
  place.field("blend_exponent")
      .fail(fmt::format("blend_exponent * a must be at most {}, is {}; lower one of them", kMaxKernelExponent,
                        body.blend_exponent * body.a));
}

// Kernels other than the Gaussian end continuously, which limits the tension and the exponent.
void check_compact_kernel(const MetaballBody& body, const Place& place) {
  if (body.kernel == Kernel::kGaussian) return;
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

void check_spheres(const MetaballBody& body, const Place& place) {
  if (body.spheres.empty()) place.field("spheres").fail("must hold at least one [x, y, z, radius]");
  const double exponent = body.blend_exponent * (body.a - portable::log(body.iso_value));
  if (body.subtract.empty() || exponent <= kMaxNetExponent) return;
  place.field("subtract")
      .fail(fmt::format("asks for blend_exponent * (a - log(iso_value)) of at most {}, is {}; lower one "
                        "of them, or raise iso_value",
                        kMaxNetExponent, exponent));
}

void check_group(const SphereGroup& group, std::size_t num_spheres, const Place& place) {
  if (group.spheres.empty()) place.fail("must hold at least one sphere's place in the list of spheres");
  std::vector<bool> seen(num_spheres);
  for (std::size_t i = 0; i < group.spheres.size(); ++i) {
    const auto sphere = static_cast<std::size_t>(group.spheres[i]);
    if (seen[sphere]) {
      place.element(i).fail(fmt::format("sphere {} is there already; leave it out", sphere));
    }
    seen[sphere] = true;
  }
}

void check_groups(const MetaballBody& body, const Place& place) {
  const Place groups = place.field("groups");
  for (const SphereGroup& group : body.groups) {
    check_group(group, body.spheres.size(), groups.field(group.name));
  }
}

void check_morph_donor(const Donor& donor, const Place& place) {
  const Place at = place.field("body");
  if (donor.body.size() != 1) at.fail("must be one body");
  check_plain_metaballs(donor.body.front(), at);
}

void check_morph(const Morph& morph, const Place& place) {
  const std::size_t n = morph.donors.size();
  if (n < kLeastDonors || n > kMostDonors) {
    place.field("donors").fail(fmt::format("must be {} to {} donors, are {}; draw between measured bodies",
                                           kLeastDonors, kMostDonors, n));
  }
  const auto [x, y, z] = morph.half_axes;
  const double ratio = std::max({x, y, z}) / std::min({x, y, z});
  if (ratio > kMostElongation) {
    place.field("half_axes")
        .fail(fmt::format("have a ratio of {:.3g}; no donor bears more than {:g}, so state rounder ones",
                          ratio, kMostElongation));
  }
}

}  // namespace

void check_plain_metaballs(const MetaballBody& body, const Place& place) {
  if (body.morph) place.field("type").fail("must be \"metaballs\" here");
  if (!body.operations.empty() || !body.groups.empty() || body.warp) {
    place.fail("has operations, groups or a warp; a donor is metaballs alone");
  }
}

void visit_row(FieldVisitor& v, bool (&mirror)[3]) { v.array("flag", {&mirror[0], &mirror[1], &mirror[2]}); }

void visit_row(FieldVisitor& v, Vec3d& vector, const NumberLimits& limits) {
  v.row(Column{"x", vector.x, limits}, Column{"y", vector.y, limits}, Column{"z", vector.z, limits});
}

void visit_row(FieldVisitor& v, Sphere& sphere) {
  v.row(Column{"x", sphere.center.x, kAnyNumber}, Column{"y", sphere.center.y, kAnyNumber},
        Column{"z", sphere.center.z, kAnyNumber}, Column{"radius", sphere.radius, kPositive});
}

void visit_row(FieldVisitor& v, double (&reach)[2], const NumberLimits& limits) {
  v.row(Column{"a1", reach[0], limits}, Column{"a2", reach[1], limits});
}

void visit_octaves(FieldVisitor& v, double frequency, int& octaves, double& gain, double& lacunarity) {
  v.field("octaves", octaves, range(1, 24));
  v.field("gain", gain, range(0.0, 4.0));
  v.field("lacunarity", lacunarity, above_one(16.0));
  const double finest = frequency * portable::whole_power(lacunarity, octaves - 1);
  if (v.checking() && finest > kMaxNumber) {
    v.place().field("octaves").fail(fmt::format(
        "the last octave's frequency is {:.3g}, above {:g}; use fewer octaves", finest, kMaxNumber));
  }
}

void visit_fields(FieldVisitor& v, Warp& warp) {
  v.required("amplitude", warp.amplitude, kAnyNumber);
  v.required("frequency", warp.frequency, kPositive);
  visit_octaves(v, warp.frequency, warp.octaves, warp.gain, warp.lacunarity);
}

void visit_fields(FieldVisitor& v, BodyOperation& operation) {
  v.required_word("type", operation.kind, kOperators, operator_word);
  if (operation.kind == Operator::kBlend) {
    v.required("width", operation.width, kPositive);
    v.field("exponent", operation.exponent, range(1.0, 64.0));
  } else if (operation.kind == Operator::kCleanUnion) {
    v.field("bulge", operation.bulge, kAnyNumber);
    v.field("reach", operation.reach, kPositive);
  } else {
    v.field("alpha", operation.alpha, range(-0.9, 1.0));
  }
  if (v.reading()) operation.operand.emplace_back();
  v.rule(check_operand, operation);
  v.required("body", operation.operand.front());
}

void visit_fields(FieldVisitor& v, Donor& donor) {
  v.field("name", donor.name);
  v.field("share", donor.share, kPositive);
  v.field("mirror", donor.mirror);
  v.field("turn", donor.turn, range(-360.0, 360.0));
  v.required("half_axes", donor.half_axes, kPositive);
  if (v.reading()) donor.body.emplace_back();
  v.rule(check_morph_donor, donor);
  v.required("body", donor.body.front());
}

namespace {

// The fields of a body of type "morph", but for its operations.
void visit_morph(FieldVisitor& v, Morph& morph) {
  v.required("half_axes", morph.half_axes, kPositive);
  v.field_if(!(morph.center == Vec3d{}), "center", morph.center, kAnyNumber);
  v.field("roughness", morph.roughness, range(0.0, 3.0));
  v.rule(check_morph, morph);
  v.required("donors", morph.donors);
}

// The fields of a body of type "metaballs", but for its operations.
void visit_metaballs(FieldVisitor& v, MetaballBody& body) {
  v.word("kernel", body.kernel, kKernels, kernel_word);
  v.field("a", body.a, kPositive);
  v.field("b", body.b, kPositive);
  v.field("blend_exponent", body.blend_exponent, kPositive);
  v.rule(check_kernel_exponent, body);
  v.field("iso_value", body.iso_value, kPositive);
  v.field("cutoff_radii", body.cutoff_radii, above_one(kMaxNumber));
  v.rule(check_compact_kernel, body);
  v.rule(check_spheres, body);
  v.required("spheres", body.spheres);
  v.field_if(!body.subtract.empty(), "subtract", body.subtract);
  v.field_if(!body.groups.empty(), "groups",
             NamedMembers{body.groups, &SphereGroup::name, &SphereGroup::spheres},
             range(0, static_cast<int>(body.spheres.size()) - 1));
  v.rule(check_groups, body);
  v.field("warp", body.warp);
}

}  // namespace

void visit_fields(FieldVisitor& v, MetaballBody& body) {
  constexpr std::string_view kMetaballs = "metaballs", kMorph = "morph";
  std::string type(body.morph ? kMorph : kMetaballs);
  v.required("type", type);
  if (type != kMetaballs && type != kMorph) {
    v.place().field("type").fail("must be \"metaballs\" or \"morph\", is " + quote_text(type));
  }
  if (type == kMorph) {
    visit_morph(v, body.morph ? *body.morph : body.morph.emplace());
  } else {
    visit_metaballs(v, body);
  }
  v.rule(check_operations, body);
  v.field_if(!body.operations.empty(), "operations", body.operations);
}

}  // namespace astrolith
