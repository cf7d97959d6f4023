// The body of a recipe: metaballs, and how bodies are combined. Lengths are in the recipe's `length_unit`.
// Include recipe/recipe.h, which includes this file.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "numerics/portable_double.h"
#include "numerics/vec3.h"

namespace astrolith {

// Limits of a recipe's numbers, which keep absurd files out. No number exceeds kMaxNumber in magnitude, and
// "> 0" means at least kMinPositive. Numbers at the ends of their ranges can still combine to more than a
// float holds.
inline constexpr double kMaxNumber = 1e12;
inline constexpr double kMinPositive = 1e-12;

// The largest logarithm of a kernel: e^80 times a million spheres is still a float.
inline constexpr double kMaxKernelExponent = 80.0;
// The largest logarithm of a kernel over the iso-value in a body with subtractive metaballs.
inline constexpr double kMaxNetExponent = 60.0;
// The largest `a` of kernels other than the Gaussian.
inline constexpr double kMaxTension = 10.0;

struct Sphere {
  Vec3d center;
  double radius = 1.0;  // > 0
};

// A displacement of coordinates by three fractal sums of simplex noise, one along each axis (thesis eq. 4.6):
//   warp_k(p) = amplitude * sum_o gain^o simplex_k(lacunarity^o * frequency * p)
struct Warp {
  double amplitude = 0.0;    // length units
  double frequency = 1.0;    // cycles per length unit of the first octave, > 0
  int octaves = 3;           // 1 .. 24; the last octave's frequency is at most kMaxNumber
  double gain = 0.5;         // [0, 4]
  double lacunarity = 1.95;  // (1, 16]
};

// The kernels of thesis 2.1, eq. 2.5 to 2.9.
enum class Kernel { kGaussian, kMetaball, kSoftObject, kWyvill, kCauchy };
inline constexpr Kernel kKernels[] = {Kernel::kGaussian, Kernel::kMetaball, Kernel::kSoftObject,
                                      Kernel::kWyvill, Kernel::kCauchy};

// The kernel's name in recipes and on command lines.
constexpr std::string_view kernel_word(Kernel kernel) {
  constexpr std::string_view kWords[] = {"gaussian", "metaball", "soft_object", "wyvill", "cauchy"};
  return kWords[static_cast<int>(kernel)];
}

// A group of spheres that layers can be tied to.
struct SphereGroup {
  std::string name;
  std::vector<int> spheres;  // indices in MetaballBody::spheres from 0: at least one, each at most once
};

// How a body is combined with another (thesis 2.2). Both are given by their signed distances f and g,
// positive inside:
//   union, intersection   (f + g +- sqrt(f^2 + g^2 - 2 alpha f g)) / (1 + alpha)       (R-functions)
//   difference            the intersection of f and -g
//   blend                 (f'^n + g'^n)^(1/n) = 1 with f' = max(0, 1 + f / width)      (super-elliptic)
//   clean union           f + g + sqrt(f^2 + g^2) + a0 / (1 + (f/a1)^2 + (g/a2)^2)     (eq. 2.16, 2.17)
// The R-functions, and the clean union without a bulge, keep the surfaces of both bodies. An alpha below 1
// rounds the field away from the surfaces, and so it rounds the heights that layers add.
enum class Operator { kUnion, kIntersection, kDifference, kBlend, kCleanUnion };
inline constexpr Operator kOperators[] = {Operator::kUnion, Operator::kIntersection, Operator::kDifference,
                                          Operator::kBlend, Operator::kCleanUnion};
constexpr std::string_view operator_word(Operator op) {
  constexpr std::string_view kWords[] = {"union", "intersection", "difference", "blend", "clean_union"};
  return kWords[static_cast<int>(op)];
}

struct MetaballBody;
struct BodyOperation {
  Operator kind = Operator::kUnion;
  double alpha = 1.0;                 // R-functions only, [-0.9, 1]
  double exponent = 2.0;              // blend only: n, [1, 64]
  double width = 1.0;                 // blend only: it ends this far from either body, length units, > 0
  double bulge = 0.0;                 // clean union only: a0, length units; a negative bulge carves
  double reach[2] = {1.0, 1.0};       // clean union only: a1 and a2, length units, > 0
  std::vector<MetaballBody> operand;  // exactly one body, without groups
};
inline constexpr int kMaxOperationDepth = 8;  // the most levels of operands within operands
inline constexpr int kMaxOperations = 256;    // the most operations in a whole recipe

// A measured body whose shape goes into a morph.
struct Donor {
  std::string name;    // for people
  double share = 1.0;  // > 0; the shares of a morph count by their ratios
  // How the donor is turned before its axes are stretched: mirrored along axes, then turned about z by `turn`
  // degrees in the space where its ellipsoid is a sphere, so that the ellipsoid keeps its axes.
  bool mirror[3] = {false, false, false};
  double turn = 0.0;  // [-360, 360]
  // Half axes of the ellipsoid with the donor's moments of inertia, in the donor's own length unit, > 0.
  Vec3d half_axes{1.0, 1.0, 1.0};
  // Exactly one body of metaballs without operations, groups and warp. Its centre of mass is the origin, and
  // its principal axes are the coordinate axes.
  std::vector<MetaballBody> body;
};
inline constexpr int kLeastDonors = 2, kMostDonors = 4;
inline constexpr double kMostElongation = 5.0;  // the largest ratio of two half axes of a morph

// A shape between measured ones, which is none of them. Let s_j be the signed distance to donor j after its
// axes have been stretched to `half_axes`, e that to the ellipsoid of these half axes, and w_j the shares,
// which add up to 1. The body is the set where
//   e + roughness sum_j w_j (s_j - e) / sqrt(sum_j w_j^2) >= 0.
// The root keeps the variance of the donors' residuals, which a mean would lower
// (synthesis/body/morph_grid.h).
struct Morph {
  Vec3d half_axes{1.0, 1.0, 1.0};  // length units, > 0
  Vec3d center;                    // of the ellipsoid, length units
  double roughness = 1.0;          // [0, 3]
  std::vector<Donor> donors;       // kLeastDonors .. kMostDonors
};

// m(p) = (sum_i f_i(p)^m)^(1/m),  f_i = exp(a - b |p - c_i|^2 / r_i^2)     (thesis eq. 4.3 to 4.5, per
// sphere) with f_i = 0 beyond cutoff_radii * r_i. The bare body is the set where m(p) >= iso_value. With a =
// b and iso_value = 1 a lone sphere's surface has its own radius.
//
// The other kernels are scaled to two values of the Gaussian: f_i is e^a at the centre and 1 where
// |p - c_i|^2 is a/b r_i^2. These kernels end continuously, where their own support ends or at cutoff_radii,
// whichever comes first. A kernel that ends at cutoff_radii is lowered by its value there. The other kernels
// need a tension `a` of at least least_tension(body), and their blend is a p-norm with m >= 1.
//
// A body can have subtractive metaballs. With g_j their kernels and T the iso-value,
//   m(p) = (sum_i f_i(p)^m / (1 + sum_j (g_j(p) / T)^m))^(1/m),
// and the surface is that of the difference, sum_i f_i^m - sum_j g_j^m = T^m.
//
// With a warp, m is evaluated at p + warp(p) instead of p. Low frequencies and high amplitudes of a warp make
// caves, tunnels and arches.
//
// A body of type "morph" has a `morph` in place of its metaballs, and neither groups nor a warp.
struct MetaballBody {
  std::optional<Morph> morph;
  Kernel kernel = Kernel::kGaussian;
  double a = 1.0;               // tension, > 0; at most kMaxTension for kernels other than the Gaussian
  double b = 1.0;               // tension, > 0
  double blend_exponent = 1.0;  // the thesis's m, > 0 or >= 1; blend_exponent * a <= kMaxKernelExponent
  double iso_value = 1.0;       // the thesis's T, > 0
  double cutoff_radii = 5.0;    // support of a kernel in radii of its sphere, > 1
  std::vector<Sphere> spheres;  // at least one, none in a morph
  // Subtractive metaballs, which belong to no group. A body with subtractive metaballs must have
  // blend_exponent (a - log iso_value) <= kMaxNetExponent.
  std::vector<Sphere> subtract;
  std::vector<SphereGroup> groups;        // sorted by name, each name once
  std::vector<BodyOperation> operations;  // applied to these metaballs in order
  std::optional<Warp> warp;

  std::size_t num_metaballs() const { return spheres.size() + subtract.size(); }

  // The group of this name, or null.
  const SphereGroup* find_group(std::string_view name) const {
    for (const SphereGroup& group : groups) {
      if (group.name == name) return &group;
    }
    return nullptr;
  }
};

// The least tension `a` for which the body's kernel can end at cutoff_radii: the flattest such kernel is a
// parabola. The result is 0 for the Gaussian, and infinite if the sphere's surface lies beyond cutoff_radii.
inline double least_tension(const MetaballBody& body) {
  const double surface = body.a / body.b, end = body.cutoff_radii * body.cutoff_radii;
  if (body.kernel == Kernel::kGaussian) return 0.0;
  return surface < end ? -portable::log1p(-surface / end) : std::numeric_limits<double>::infinity();
}

}  // namespace astrolith
