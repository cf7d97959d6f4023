#include "estimation/shape/details/roughness.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "synthesis/noise/fractal_noise.h"
#include "tests/synthesis/lone_noise.h"

namespace astrolith {
namespace {

TEST(Roughness, OfAParabolaGrowsWithTheSquareOfTheLag) {
  // Every second difference of t = x^2 / 2 is r^2.
  std::vector<double> heights;
  std::vector<std::vector<HeightTriple>> triples(2);
  for (const double r : {0.1, 0.3}) {
    for (const double x : {0.0, 1.0, 2.0}) {
      const auto first = static_cast<std::uint32_t>(heights.size());
      for (const double at : {x - r, x, x + r}) heights.push_back(0.5 * at * at);
      triples[r < 0.2 ? 0 : 1].push_back({first, first + 1, first + 2});
    }
  }
  const std::vector<double> nu = roughness(heights, triples);
  EXPECT_NEAR(nu[0], 0.01, 1e-12);
  EXPECT_NEAR(nu[1], 0.09, 1e-12);
}

// Compares fractal sums as synthesis makes them with the closed form.
TEST(RoughnessModel, AgreesWithSynthesisedNoise) {
  const RoughnessModel model;
  const std::vector<double> lags{0.02, 0.05, 0.1};
  for (std::size_t which = 0; which < 3; ++which) {
    FractalLayer layer;
    layer.noise = kDetailNoises[which];
    layer.amplitude = 0.5;
    layer.frequency = 8.0;
    layer.octaves = 3;
    layer.gain = 0.6;
    const LoneNoise<FractalNoise> noise(layer, 7, 0, {{-9, -9, -9}, {9, 9, 9}});
    const std::vector<double> expected = model.of({which, 1.0, 8.0, 3, 0.6}, lags);
    for (std::size_t k = 0; k < lags.size(); ++k) {
      CounterRandom random(k, which);
      std::vector<float> x[3];
      const int n = 20000;
      for (int i = 0; i < n; ++i) {
        Vec3d u{random.normal(), random.normal(), random.normal()};
        u = normalized(u);
        const Vec3d p{random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-8, 8)};
        for (const double side : {-lags[k], 0.0, lags[k]}) {
          x[0].push_back(static_cast<float>(p.x + side * u.x));
          x[1].push_back(static_cast<float>(p.y + side * u.y));
          x[2].push_back(static_cast<float>(p.z + side * u.z));
        }
      }
      std::vector<float> h(x[0].size());
      noise.evaluate(static_cast<int>(h.size()), x[0].data(), x[1].data(), x[2].data(), h.data());
      double sum = 0.0;
      for (std::size_t i = 0; i < h.size(); i += 3)
        sum += std::pow(double{h[i]} - 2.0 * h[i + 1] + h[i + 2], 2);
      EXPECT_NEAR(std::sqrt(sum / n) / (0.5 * expected[k]), 1.0, 0.03) << which << " " << lags[k];
    }
  }
}

TEST(RoughnessModel, ANoiseIsFoundAgainFromItsRoughness) {
  const RoughnessModel model;
  const DetailRanges ranges{8.0, 80.0, 1e-6, 1e-1, 1.0};
  const std::vector<double> lags{0.0125, 0.0177, 0.025, 0.035, 0.05, 0.07};
  for (std::size_t which = 0; which < 3; ++which) {
    for (const double gain : {0.0, 0.5}) {
      const PlainNoise truth{which, 1.0, 20.0, 3, gain};
      std::vector<double> wanted = model.of(truth, lags);
      for (double& v : wanted) v *= 2e-3;
      // A gain of 0 leaves one octave.
      const std::vector<PlainNoise> good = noises_as_rough_as(wanted, lags, which, ranges, model);
      ASSERT_FALSE(good.empty());
      const auto same = std::find_if(good.begin(), good.end(),
                                     [&](const PlainNoise& n) { return n.octaves == (gain > 0.0 ? 3 : 1); });
      ASSERT_NE(same, good.end());
      const PlainNoise& found = *same;
      EXPECT_NEAR(found.amplitude / 2e-3, 1.0, 0.1) << which << " " << gain;
      EXPECT_NEAR(found.frequency / 20.0, 1.0, 0.1) << which << " " << gain;
    }
  }
}

TEST(Roughness, MisfitIsTheRootMeanSquareLogRatio) {
  const std::vector<double> a{1.0, 2.0}, b{1.0, 2.0}, twice{2.0, 4.0};
  EXPECT_EQ(roughness_misfit(a, b), 0.0);
  EXPECT_NEAR(roughness_misfit(a, twice), std::log(2.0), 1e-12);
  EXPECT_LE(roughness_misfit(a, std::vector<double>{0.0, 0.0}), 3.0);
}

}  // namespace
}  // namespace astrolith
