#include "synthesis/picture/reflectance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "numerics/errors.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

struct Geometry {
  double m0, m, phase;
};

// The directions lie above the ground, and some of them are grazing.
Geometry random_geometry(CounterRandom& random) {
  const auto cosine = [&] { return std::pow(random.uniform(1e-3, 1.0), random.uniform() < 0.3 ? 3.0 : 1.0); };
  const double m0 = std::max(1e-3, cosine()), m = std::max(1e-3, cosine()),
               psi = random.uniform(0.0, std::numbers::pi);
  const double sines = std::sqrt((1.0 - m0 * m0) * (1.0 - m * m));
  return {m0, m, std::acos(std::clamp(m0 * m + sines * std::cos(psi), -1.0, 1.0))};
}

TEST(Reflectance, IsReciprocal) {
  CounterRandom random(1);
  for (const char* words : {"lambert", "lommel-seeliger", "mcewen L .4", "minnaert k .6", "hapke theta 0",
                            "hapke w .6 g .2 b0 1.5 h .02 theta 35"}) {
    const Reflectance law = parse_reflectance("law", words);
    for (int n = 0; n < 2000; ++n) {
      const auto [m0, m, phase] = random_geometry(random);
      const double there = reflectance_at(law, m0, m, phase) / m0,
                   back = reflectance_at(law, m, m0, phase) / m;
      EXPECT_NEAR(there / back, 1.0, 1e-9) << words << ' ' << m0 << ' ' << m << ' ' << phase;
    }
  }
}

TEST(Reflectance, IsFiniteAtGrazingDirections) {
  CounterRandom random(2);
  for (const char* words : {"akimov", "minnaert k .2", "hapke w .999 g -.9 b0 10 h .001 theta 60"}) {
    const Reflectance law = parse_reflectance("law", words);
    for (int n = 0; n < 5000; ++n) {
      const auto [m0, m, phase] = random_geometry(random);
      const double value = reflectance_at(law, m0, m, phase);
      ASSERT_TRUE(std::isfinite(value) && value >= 0.0) << words << ' ' << m0 << ' ' << m << ' ' << phase;
    }
    for (const double phase : {0.0, 1e-9, std::numbers::pi}) {
      ASSERT_TRUE(std::isfinite(pictured_reflectance(law, 1e-6f, 0.0f, static_cast<float>(std::cos(phase)))))
          << words;
    }
  }
}

// Rough ground of no slope is smooth.
TEST(Reflectance, RoughnessFadesOut) {
  CounterRandom random(3);
  const Reflectance smooth = parse_reflectance("law", "hapke theta 0"),
                    nearly = parse_reflectance("law", "hapke theta .01");
  for (int n = 0; n < 500; ++n) {
    const auto [m0, m, phase] = random_geometry(random);
    if (std::min(m0, m) < 0.05) continue;
    EXPECT_NEAR(reflectance_at(nearly, m0, m, phase) / reflectance_at(smooth, m0, m, phase), 1.0, 1e-4);
  }
}

// Seen and lit from above at opposition Hapke's law is w / 8 [(1 + B0) P(0) + H(1)^2 - 1]; the full disk of
// Akimov is flat; a phase of 90 degrees halves what the middle of a sphere of Lommel and Seeliger sends back.
TEST(Reflectance, HasClosedFormsFromAbove) {
  const double w = 0.3, g = -0.2, gamma = std::sqrt(1.0 - w), p = (1.0 - g * g) / std::pow(1.0 + g, 3.0),
               h = 3.0 / (1.0 + 2.0 * gamma);
  const Reflectance hapke = parse_reflectance("law", "hapke w .3 g -.2 b0 .5 h .1 theta 0");
  EXPECT_NEAR(reflectance_at(hapke, 1.0, 1.0, 0.0), w / 8.0 * (1.5 * p + h * h - 1.0), 1e-12);
  const Reflectance akimov = parse_reflectance("law", "akimov");
  EXPECT_NEAR(reflectance_at(akimov, 0.3, 0.3, 0.0), 1.0, 1e-12);
  // On the equator of the sphere cos b = 1; at its middle g = 0.
  EXPECT_NEAR(reflectance_at(akimov, 0.5, 1.0, std::numbers::pi / 3.0),
              std::cos(std::numbers::pi / 6.0) * std::cos(1.5 * std::numbers::pi / 6.0), 1e-12);
}

// Lommel and Seeliger's law with the albedo of the phase angle (Buratti et al. 2011).
TEST(Reflectance, RoloIsLommelSeeligerWithItsPhaseCurve) {
  const Reflectance rolo = parse_reflectance("law", "rolo C0 .02 C1 .1 A0 .08 A1 -.0005 A2 2e-6");
  const double f = 0.02 * std::exp(-3.0) + 0.08 - 0.0005 * 30.0 + 2e-6 * 900.0;
  EXPECT_NEAR(reflectance_at(rolo, 0.4, 0.7, std::numbers::pi / 6.0), f * 0.4 / 1.1, 1e-12);
  EXPECT_TRUE(is_radiance_factor(rolo));
}

TEST(Reflectance, BodiesHaveFittedNumbers) {
  const Reflectance ceres = parse_reflectance("", "hapke ceres"),
                    rough = parse_reflectance("", "hapke ceres theta 40");
  EXPECT_EQ(ceres.w, 0.116);
  EXPECT_EQ(ceres.theta, 23.0);
  EXPECT_EQ(rough.w, 0.116);
  EXPECT_EQ(rough.theta, 40.0);
  EXPECT_EQ(parse_reflectance("", "hapke tempel1").b0, 0.0);
}

TEST(Reflectance, WordsAreChecked) {
  EXPECT_EQ(parse_reflectance("law", "minnaert k .55").k, 0.55);
  EXPECT_EQ(parse_reflectance("law", "lommel-seeliger").lunar_share, 1.0);
  for (const char* words : {"", "oren-nayar", "hapke w 1.2", "hapke w", "hapke theta 70", "rock L .2",
                            "akimov k 1", "minnaert k .5x", "hapke w .2 g", "rolo C9 1"}) {
    try {
      parse_reflectance("law", words);
      ADD_FAILURE() << words;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("law: ", 0), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace astrolith
