#include "synthesis/gabor/gabor_kernel.h"

#include <cmath>
#include <functional>

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// An integral by Simpson's rule with n (even) steps.
double integral(const std::function<double(double)>& f, double low, double high, int n = 2000) {
  const double h = (high - low) / n;
  double sum = f(low) + f(high);
  for (int i = 1; i < n; ++i) sum += f(low + i * h) * (i % 2 ? 4 : 2);
  return sum * h / 3;
}

double profile(double u) { return gabor_profile(static_cast<float>(u)); }
double squared_profile(double u) { return profile(u) * profile(u); }
double slab(double n) { return std::pow(std::max(1.0 - n * n, 0.0), 2); }

TEST(GaborKernel, ConstantsAreTheirIntegrals) {
  EXPECT_NEAR(integral(squared_profile, -1.4, 1.4), kGaborProfileEnergy, 2e-6);
  const double second = integral([](double n) { return std::pow(slab(n), 2); }, -1, 1);
  const double fourth = integral([](double n) { return std::pow(slab(n), 4); }, -1, 1);
  EXPECT_NEAR(second, kGaborSlabEnergy, 1e-9);
  EXPECT_NEAR(second * second / fourth, kGaborSlabThickness, 1e-4);
  EXPECT_NEAR(std::exp(-kGaborKernelArea), 0.05, 1e-8);
}

// At the stated cell sides, the squared mean of k^2 over a cell is on average half of k^4.
TEST(GaborKernel, CellsMakeTheFourthCumulantVanish) {
  const auto same_cell = [](const std::function<double(double)>& square, double reach, double side) {
    const auto correlation = [&](double t) {
      return integral([&](double u) { return square(u) * square(u + t); }, -reach, reach, 400);
    };
    return 2 * integral([&](double t) { return (1 - t / side) * correlation(t); }, 0, side, 200) /
           (side * correlation(0));
  };
  EXPECT_NEAR(std::pow(same_cell(squared_profile, 1.4, kGaborPlaneCell), 2), 0.5, 1e-3);
  const auto squared_slab = [](double n) { return std::pow(slab(n), 2); };
  EXPECT_NEAR(std::pow(same_cell(squared_profile, 1.4, kGaborSpaceCell), 2) *
                  same_cell(squared_slab, 1.0, kGaborSpaceCell),
              0.5, 1e-3);
}

TEST(GaborKernel, SpectrumIsTheGaussiansWithinOnePercent) {
  // The spectrum is separable. Compares |E(x)|^2 |E(y)|^2 with exp(-2 pi (x^2 + y^2)), both scaled to unit
  // variance.
  constexpr int n = 61;
  double spectrum[n], ideal[n], sum = 0, ideal_sum = 0;
  for (int i = 0; i < n; ++i) {
    const double xi = 0.025 * (i - n / 2);
    const double transform =
        integral([xi](double u) { return profile(u) * std::cos(2 * M_PI * xi * u); }, -1.4, 1.4, 800);
    sum += spectrum[i] = transform * transform;
    ideal_sum += ideal[i] = std::exp(-2 * M_PI * xi * xi);
  }
  double error = 0, energy = 0;
  for (int i = 0; i < n * n; ++i) {
    const double expected = ideal[i / n] * ideal[i % n] / (ideal_sum * ideal_sum);
    error += std::pow(spectrum[i / n] * spectrum[i % n] / (sum * sum) - expected, 2);
    energy += expected * expected;
  }
  EXPECT_LT(std::sqrt(error / energy), 0.01);
}

TEST(GaborKernel, EndsWithZeroValueAndSlopeOnAllSides) {
  const GaborImpulse impulse{0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2, 1.5f, -0.7f, 0.1f};
  EXPECT_EQ(gabor_kernel(impulse, 0.7001f, 0.1f, 0.0f), 0.0f);
  EXPECT_EQ(gabor_kernel(impulse, 0.1f, -0.7001f, 0.0f), 0.0f);
  EXPECT_EQ(gabor_kernel(impulse, 0.1f, 0.1f, 0.5001f), 0.0f);
  EXPECT_EQ(gabor_kernel(impulse, 100.0f, 1e4f, 3.0f), 0.0f);
  const float h = 1e-3f;  // within h of the border values are of order h^2
  EXPECT_LT(std::fabs(gabor_kernel(impulse, 0.7f - h, 0.02f, 0.0f)), 1e-5f);
  EXPECT_LT(std::fabs(gabor_kernel(impulse, 0.02f, 0.0f, 0.5f - h)), 5e-5f);
  EXPECT_GT(std::fabs(gabor_kernel(impulse, 0.02f, 0.0f, 0.0f)), 0.1f);
}

TEST(GaborKernel, SlopeIsTheDerivativeAndTheValueTheSame) {
  const GaborImpulse impulse{0.1f, 0, 0, 2, 0.3f, 0, -0.3f, 2, 0, 0, 0, 2, 1.5f, -0.7f, 0.1f};
  CounterRandom random(2);
  for (int i = 0; i < 500; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-0.8, 0.8)); };
    const Vec3f p{coordinate(), coordinate(), coordinate()};
    const GaborSample sample = gabor_kernel_with_slope(impulse, p.x, p.y, p.z);
    ASSERT_EQ(sample.value, gabor_kernel(impulse, p.x, p.y, p.z));
    constexpr float h = 1e-3f;
    const auto difference = [&](float dx, float dy, float dz) {
      return (gabor_kernel(impulse, p.x + dx, p.y + dy, p.z + dz) -
              gabor_kernel(impulse, p.x - dx, p.y - dy, p.z - dz)) /
             (2 * h);
    };
    ASSERT_NEAR(sample.slope.x, difference(h, 0, 0), 5e-3f);
    ASSERT_NEAR(sample.slope.y, difference(0, h, 0), 5e-3f);
    ASSERT_NEAR(sample.slope.z, difference(0, 0, h), 5e-3f);
  }
}

}  // namespace
}  // namespace astrolith
