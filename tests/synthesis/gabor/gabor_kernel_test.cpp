#include "synthesis/gabor/gabor_kernel.h"

#include <array>
#include <cmath>
#include <functional>

#include "numerics/hash_random.h"
#include "synthesis/gabor/gabor_draw.h"

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
double slab(double n) { return std::pow(std::max(1.0 - std::pow(n, 8), 0.0), 2); }
constexpr double kRadius{kGaborDiscReach};
double disc(double r) {
  return gabor_disc(std::max(static_cast<float>(1.0 - r * r / (kRadius * kRadius)), 0.0f));
}

TEST(GaborKernel, ConstantsAreTheirIntegrals) {
  EXPECT_NEAR(integral(squared_profile, -1.4, 1.4), kGaborProfileEnergy, 2e-6);
  EXPECT_NEAR(integral([](double r) { return 2 * M_PI * r * std::pow(disc(r), 2); }, 0, kRadius),
              kGaborDiscEnergy, 2e-6);
  EXPECT_NEAR(disc(0.0), 1.0, 1e-6);
  const double second = integral([](double n) { return std::pow(slab(n), 2); }, -1, 1);
  const double fourth = integral([](double n) { return std::pow(slab(n), 4); }, -1, 1);
  EXPECT_NEAR(second, kGaborSlabEnergy, 1e-9);
  EXPECT_NEAR(second * second / fourth, kGaborSlabThickness, 1e-4);
  EXPECT_NEAR(std::exp(-kGaborKernelArea), 0.05, 1e-8);
}

// At the sides of cells, the squared mean of k^2 over a cell is on average half of k^4.
TEST(GaborKernel, CellsMakeTheFourthCumulantVanish) {
  const auto in_plane = [](const std::function<double(double, double)>& square, double reach, double side) {
    constexpr int n = 56;
    const double step = 2 * reach / n;
    const auto correlation = [&](double s, double t) {
      double sum = 0;
      for (int i = 0; i < n * n; ++i) {
        const double u = -reach + (i % n + 0.5) * step, v = -reach + (i / n + 0.5) * step;
        sum += square(u, v) * square(u + s, v + t);
      }
      return sum;
    };
    constexpr int m = 12;
    double sum = 0;
    for (int i = 0; i < m * m; ++i) {
      const double s = (i % m + 0.5) / m, t = (i / m + 0.5) / m;
      sum += 4 * (1 - s) * (1 - t) * correlation(s * side, t * side) / (m * m);
    }
    return sum / correlation(0, 0);
  };
  const auto squared_profiles = [](double u, double v) { return squared_profile(u) * squared_profile(v); };
  EXPECT_NEAR(in_plane(squared_profiles, 1.4, kGaborPlaneCell), 0.5, 2e-3);
  const auto squared_disc = [](double u, double v) { return std::pow(disc(std::hypot(u, v)), 2); };
  const auto along_normal = [](double t) {
    return integral([t](double n) { return std::pow(slab(n) * slab(n + t), 2); }, -1, 1, 400);
  };
  const double side = kGaborSpaceCell;
  const double normal = 2 *
                        integral([&](double t) { return (1 - t / side) * along_normal(t); }, 0, side, 40) /
                        (side * along_normal(0));
  EXPECT_NEAR(in_plane(squared_disc, kRadius, side) * normal, 0.507, 2e-3);
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

// The spectrum of the disc, a function of the radius, against that of the Gaussian.
TEST(GaborKernel, SpectrumOfTheDiscIsTheGaussiansWithinOnePercent) {
  constexpr int n = 120;
  std::array<double, n> spectrum, ideal;
  double sum = 0, ideal_sum = 0;
  for (int i = 0; i < n; ++i) {
    const double xi = 0.02 * (i + 0.5);
    const double transform = integral(
        [xi](double r) { return 2 * M_PI * r * disc(r) * std::cyl_bessel_j(0.0, 2 * M_PI * xi * r); }, 0,
        kRadius, 200);
    const auto k = static_cast<std::size_t>(i);
    spectrum[k] = transform * transform;
    ideal[k] = std::exp(-2 * M_PI * xi * xi);
    sum += xi * spectrum[k];
    ideal_sum += xi * ideal[k];
  }
  double error = 0, energy = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double xi = static_cast<double>(k) + 0.5;
    error += xi * std::pow(spectrum[k] / sum - ideal[k] / ideal_sum, 2);
    energy += xi * std::pow(ideal[k] / ideal_sum, 2);
  }
  EXPECT_LT(std::sqrt(error / energy), 0.01);
}

TEST(GaborKernel, CosineIsTheCosine) {
  for (double turns = -3.0; turns < 3.0; turns += 1.0 / 777) {
    const auto x = static_cast<float>(turns);
    ASSERT_NEAR(double{gabor_cosine(x)}, std::cos(2 * M_PI * double{x}), 2e-6) << turns;
  }
}

// Bandwidth 2, along the axes.
constexpr float kScale = 4.0f / (kGaborDiscReach * kGaborDiscReach);

TEST(GaborKernel, EndsWithZeroValueAndSlopeOnAllSides) {
  const GaborImpulse impulse{0, 0, 0, 3.0f, -1.4f, 0, 0, 0, 2, 0.1f};
  const auto kernel = [&](float x, float y, float z) { return gabor_kernel(impulse, kScale, x, y, z); };
  EXPECT_EQ(kernel(0.57501f, 0.0f, 0.0f), 0.0f);
  EXPECT_EQ(kernel(0.0f, -0.57501f, 0.1f), 0.0f);
  EXPECT_EQ(kernel(0.41f, 0.41f, 0.0f), 0.0f);
  EXPECT_EQ(kernel(0.1f, 0.1f, 0.5001f), 0.0f);
  EXPECT_EQ(kernel(100.0f, 1e4f, 3.0f), 0.0f);
  const float h = 1e-3f;  // within h of the border values are of order h^2
  EXPECT_LT(std::fabs(kernel(0.575f - h, 0.0f, 0.0f)), 1e-4f);
  EXPECT_LT(std::fabs(kernel(0.02f, 0.0f, 0.5f - h)), 1e-3f);
  EXPECT_GT(std::fabs(kernel(0.02f, 0.0f, 0.0f)), 0.1f);
}

TEST(GaborKernel, SlopeIsTheDerivativeAndTheValueTheSame) {
  const GaborImpulse impulse{0.1f, 0, 0, 3.0f, -1.4f, 0.3f, 0.2f, 0.3f, 1.95f, 0.1f};
  CounterRandom random(2);
  for (int i = 0; i < 500; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-0.6, 0.6)); };
    const Vec3f p{coordinate(), coordinate(), coordinate()};
    const GaborSample sample = gabor_kernel_with_slope(impulse, kScale, p.x, p.y, p.z);
    ASSERT_EQ(sample.value, gabor_kernel(impulse, kScale, p.x, p.y, p.z));
    constexpr float h = 1e-3f;
    const auto difference = [&](float dx, float dy, float dz) {
      return (gabor_kernel(impulse, kScale, p.x + dx, p.y + dy, p.z + dz) -
              gabor_kernel(impulse, kScale, p.x - dx, p.y - dy, p.z - dz)) /
             (2 * h);
    };
    ASSERT_NEAR(sample.slope.x, difference(h, 0, 0), 1e-2f);
    ASSERT_NEAR(sample.slope.y, difference(0, h, 0), 1e-2f);
    ASSERT_NEAR(sample.slope.z, difference(0, 0, h), 3e-2f);
  }
}

// An impulse that gabor_reaches() leaves out is 0 at every point of the box, and most that are 0 are left
// out.
TEST(GaborKernel, NoReachingImpulseIsLeftOut) {
  CounterRandom random(5);
  const auto within = [&](double size) { return static_cast<float>(random.uniform(-size, size)); };
  int kept = 0, left_out = 0, needless = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3d n = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    const float a = 2.0f, size = i % 2 ? 0.05f : 0.5f;
    const TangentFrame frame =
        tangent_frame({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
    const GaborImpulse impulse =
        gabor_impulse(a, {within(1.0), within(1.0), within(1.0)}, frame, {1.0f, 0.1f, 0.2f}, 0.0f);
    const float center[3] = {within(0.2), within(0.2), within(0.2)};
    const float half[3] = {within(0.5) * size + size, within(0.5) * size + size, within(0.5) * size + size};
    const bool reaches = gabor_reaches(impulse, gabor_target(a, center, half));
    bool is_zero = true;
    for (int j = 0; j < 200; ++j) {
      // Every third coordinate lies on a face of the box.
      const auto at = [&](int axis) {
        const auto k = static_cast<std::size_t>(axis);
        return center[k] + ((j + axis) % 3 == 0 ? (j % 2 ? half[k] : -half[k]) : within(1.0) * half[k]);
      };
      is_zero = is_zero && gabor_kernel(impulse, gabor_disc_scale(a), at(0), at(1), at(2)) == 0.0f;
    }
    ASSERT_TRUE(reaches || is_zero) << i;
    ++(reaches ? kept : left_out);
    needless += reaches && is_zero ? 1 : 0;
  }
  EXPECT_GT(left_out, 1000);
  EXPECT_LT(needless, kept / 3);
}

}  // namespace
}  // namespace astrolith
