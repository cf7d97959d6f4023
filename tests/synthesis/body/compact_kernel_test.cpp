// Tests of the five kernels: their values, their ends and their bounds over boxes.
#include "synthesis/body/compact_kernel.h"

#include "recipe/recipe_json.h"
#include "synthesis/body/metaball_body.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/point_value.h"

namespace astrolith {
namespace {

using testing::evaluate_one;
using testing::PointValue;
constexpr Kernel kCompactKernels[] = {Kernel::kMetaball, Kernel::kSoftObject, Kernel::kWyvill,
                                      Kernel::kCauchy};

double unit_value(Kernel kernel, double x) { return kernel_value<double>({kernel, 1.0, 0.0, 1.0}, x).value; }

// The thesis's formulas for a = b = 1 at d = 1/4 and d = 1/2.
TEST(Kernels, AreTheThesisFormulas) {
  const auto at = [](Kernel kernel, double d) { return unit_value(kernel, d * d); };
  EXPECT_DOUBLE_EQ(at(Kernel::kMetaball, 0.25), 1.0 - 3.0 / 16.0);
  EXPECT_DOUBLE_EQ(at(Kernel::kMetaball, 0.5), 1.5 * 0.25);
  EXPECT_NEAR(at(Kernel::kSoftObject, 0.5), 1.0 - 4.0 / 9 / 64 + 17.0 / 9 / 16 - 22.0 / 9 / 4, 1e-15);
  EXPECT_DOUBLE_EQ(at(Kernel::kWyvill, 0.5), 27.0 / 64.0);
  EXPECT_DOUBLE_EQ(at(Kernel::kCauchy, 0.5), 0.8);
}

TEST(Kernels, SlopesAndCurvaturesAreDerivatives) {
  for (const Kernel kernel : kCompactKernels) {
    SCOPED_TRACE(kernel_word(kernel));
    const CompactKernel<double> compact_kernel{kernel, 0.7, 0.01, 2.5};
    double slope_before = 1e9;
    for (double q = 0.01; q < 1.4; q += 0.0437) {
      const double h = 1e-5;
      const KernelDerivatives<double> k = kernel_value(compact_kernel, q),
                                      more = kernel_value(compact_kernel, q + h),
                                      less = kernel_value(compact_kernel, q - h);
      EXPECT_NEAR(k.slope, (less.value - more.value) / (2 * h), 1e-7);
      EXPECT_NEAR(k.curvature, (less.slope - more.slope) / (2 * h), 1e-4);
      EXPECT_LE(k.slope, slope_before);  // the bounds over boxes need slopes that fall
      slope_before = k.slope;
    }
  }
}

TEST(Kernels, ALoneSphereKeepsItsRadiusForAnyTension) {
  for (const Kernel kernel : kKernels) {
    for (const double tension : {0.1, 0.5, 1.0, 4.0, 10.0}) {
      for (const double m : {1.0, 2.5, 8.0}) {
        SCOPED_TRACE(::testing::Message() << kernel_word(kernel) << " tension " << tension << " m " << m);
        Recipe recipe = testing::sphere_recipe(2.0, {0.3, 0.1, -0.2});
        recipe.body->kernel = kernel;
        recipe.body->a = recipe.body->b = tension;
        recipe.body->blend_exponent = m;
        validate_recipe(recipe, "r");
        const ImplicitField field(recipe);
        EXPECT_NEAR(field.value({2.3, 0.1, -0.2}), 0.0, 1e-4);
        EXPECT_NEAR(norm(field.gradient({0.3, 2.1, -0.2}) + Vec3d{0, 1, 0}), 0.0, 2e-2);
        EXPECT_GT(field.value({0.3, 0.1, -0.2}), 0.5);
        EXPECT_LT(field.value({2.31, 0.1, -0.2}), -0.005);
        EXPECT_LT(field.value({40.0, 0.1, -0.2}), -10.0);
      }
    }
  }
}

// A kernel is e^tension at its centre, 1 at the surface and 0 at its end. Its end is its own or the cut-off.
TEST(Kernels, EndContinuously) {
  for (const Kernel kernel : kCompactKernels) {
    for (const double cutoff : {1.7, 3.0, 25.0, 1e6}) {
      for (const double tension : {1.0, 3.0, 9.0}) {
        double end = cutoff;
        const CompactKernel<double> k = scaled_kernel(kernel, tension, 1.0, end);
        EXPECT_LE(end, cutoff);
        EXPECT_NEAR(kernel_value(k, 0.0).value, std::exp(tension), 1e-9 * std::exp(tension));
        EXPECT_NEAR(kernel_value(k, 1.0).value, 1.0, 1e-9);
        EXPECT_NEAR(kernel_value(k, end).value, 0.0, 1e-9 * std::exp(tension));
      }
    }
  }
}

MetaballBody random_body(CounterRandom& random, int spheres, bool gaussian = false) {
  MetaballBody body = *testing::potato_recipe(spheres, random.next()).body;
  body.kernel = gaussian ? Kernel::kGaussian : kCompactKernels[random.below(4)];
  body.blend_exponent = random.uniform(1.0, 6.0);
  body.cutoff_radii = random.uniform(1.2, 5.0);
  body.b = std::pow(10.0, random.uniform(-0.3, 0.9));
  body.a = body.b;
  body.iso_value = std::pow(10.0, random.uniform(-0.3, 0.3));
  body.a = body.b = std::max(body.a, least_tension(body) + 0.01);
  CounterRandom dents(static_cast<std::uint64_t>(spheres), 1);
  if (spheres % 3 == 0) testing::add_dents(body, spheres / 3, dents);
  return body;
}

TEST(Kernels, DistanceGradientIsTheDerivativeOfTheDistance) {
  CounterRandom random(5);
  int checked = 0;
  for (int k = 0; k < 600; ++k) {
    const PreparedMetaballs metaballs = prepare_metaballs(random_body(random, 1 + k % 40));
    const Vec3d p = testing::random_point(random, {{-0.6, -0.4, -0.4}, {0.6, 0.4, 0.4}});
    if (std::fabs(evaluate_one(metaballs, p).distance) > 0.05f) continue;
    const Vec3d expected = testing::measured_gradient(metaballs, p, 1e-3);
    // The curvature jumps at the knee of the metaball kernel and at the ends of supports.
    checked += norm(distance_gradient(metaballs, p) - expected) < 0.05 * norm(expected);
    ASSERT_LT(norm(distance_gradient(metaballs, p) - expected), 0.5 * (1.0 + norm(expected))) << k;
  }
  EXPECT_GT(checked, 60);
}

TEST(Kernels, PowersHaveTheDerivativesOfACentreAndARadius) {
  CounterRandom random(9);
  for (int k = 0; k < 100; ++k) {
    const MetaballParameters<double> body = in_double(prepare_metaballs(random_body(random, 1)).parameters);
    const double q = random.uniform(0.01, 0.9) * body.cutoff_squared, h = 1e-6;
    const KernelDerivatives<double> f = kernel_power(body, q);
    const double slope = (kernel_power(body, q - h).value - kernel_power(body, q + h).value) / (2 * h);
    EXPECT_NEAR(f.slope, slope, 1e-5 * (1.0 + std::fabs(slope)));
  }
}

// The levels and divisors of the float evaluation keep within their bounds.
TEST(Kernels, IntervalsHoldEveryValue) {
  CounterRandom random(4);
  int proved = 0, steep = 0;
  for (int k = 0; k < 3000; ++k) {
    const PreparedMetaballs metaballs = prepare_metaballs(random_body(random, 1 + k % 50, k % 2 == 1));
    Box box;
    box.extend({random.uniform(-0.8, 0.8), random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6)});
    const double size = std::pow(10.0, random.uniform(-3.0, -0.3));
    box.extend(box.min + Vec3d{size, size * random.uniform(), size * random.uniform()});
    const PreparedMetaballs reaching = metaballs_reaching(metaballs, box);
    const double height = 0.2 * size;
    const MetaballInterval bound = bound_metaballs(reaching, box),
                           close = bound_metaballs(reaching, box, height);
    const double least = smallest_gradient(reaching, box);
    proved += bound.level_max < 0.0 || bound.level_min > 0.0;
    steep += least > 0.3 * bound.gradient_max;
    for (int i = 0; i < 30; ++i) {
      const Vec3d p = testing::random_point(random, box);
      const PointValue v = evaluate_one(metaballs, p);
      ASSERT_EQ(math::to_bits(v.distance), math::to_bits(evaluate_one(reaching, p).distance));
      const double divisor = std::sqrt(squared_norm(Vec3d{v.gx, v.gy, v.gz}) +
                                       static_cast<double>(metaballs.parameters.gradient_floor));
      const double level = double{v.distance} * divisor;
      ASSERT_LE(divisor, bound.gradient_max);
      ASSERT_GE(divisor, least);
      ASSERT_GE(level, bound.level_min);
      ASSERT_LE(level, bound.level_max);
      if (std::fabs(double{v.distance}) <= height) {
        ASSERT_LE(divisor, close.gradient_max);
      }
    }
  }
  EXPECT_GT(proved, 800);
  EXPECT_GT(steep, 30);
}

}  // namespace
}  // namespace astrolith
