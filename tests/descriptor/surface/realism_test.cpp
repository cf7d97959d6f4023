#include "descriptor/surface/realism.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "numerics/errors.h"
#include "tests/descriptor/surface/rough_spheres.h"

namespace astrolith {
namespace {

using testing::BumpHeights;
using testing::rough_sphere;
using testing::WaveHeights;

constexpr double kSphereEdge = 0.0376;

template <typename Heights>
SurfaceStatistics measured(const Heights& height, std::uint64_t seed = 1) {
  SurfaceStatisticsOptions options;
  options.places = 900;
  options.seed = seed;
  return surface_statistics(rough_sphere(height), options);
}
// Each surface is measured once, however many tests ask for it.
const SurfaceStatistics& waves(double amplitude, std::uint64_t noise_seed, std::uint64_t seed = 1) {
  static std::map<std::tuple<double, std::uint64_t, std::uint64_t>, SurfaceStatistics> known;
  const auto [it, is_new] = known.try_emplace({amplitude, noise_seed, seed});
  if (is_new) {
    const WaveHeights height(6 * kSphereEdge, noise_seed);
    it->second = measured([&](const Vec3d& p) { return amplitude * height(p); }, seed);
  }
  return it->second;
}

bool says(const RealismVerdict& verdict, const std::string& beginning) {
  const auto words = realism_words(verdict, {});
  return std::any_of(words.begin(), words.end(), [&](const auto& w) { return w.starts_with(beginning); });
}

TEST(Realism, ABodySampledAgainPasses) {
  const RealismVerdict verdict = judge_realism(waves(0.01, 1, 1), waves(0.01, 1, 2), {});
  EXPECT_TRUE(verdict.passes) << verdict.p << " " << verdict.largest_distance;
  EXPECT_GT(verdict.p, 0.5);
  EXPECT_NEAR(verdict.variance_ratio, 1, 0.3);
  EXPECT_EQ(realism_words(verdict, {}), std::vector<std::string>{"passes"});
}

TEST(Realism, OtherTopologyIsSaidFirst) {
  RealismVerdict verdict = judge_realism(waves(0.01, 1, 1), waves(0.01, 1, 2), {});
  verdict.passes = false;
  verdict.other_topology = "has 2 parts";
  EXPECT_EQ(realism_words(verdict, {}), std::vector<std::string>{"has 2 parts"});
}

TEST(Realism, AnotherDrawOfTheSameNoisePasses) {
  const RealismVerdict verdict = judge_realism(waves(0.01, 1), waves(0.01, 2), {});
  EXPECT_TRUE(verdict.passes) << verdict.p << " " << verdict.largest_distance;
}

TEST(Realism, ASmootherSurfaceIsToldInWords) {
  const RealismVerdict verdict = judge_realism(waves(0.01, 1), waves(0.006, 2), {});
  EXPECT_FALSE(verdict.passes);
  EXPECT_LT(verdict.p, 0.01);
  EXPECT_TRUE(says(verdict, "too smooth between 0.11 and ")) << realism_words(verdict, {})[0];
  const RealismVerdict turned = judge_realism(waves(0.006, 1), waves(0.01, 2), {});
  EXPECT_TRUE(says(turned, "too rough between 0.11 and "));
}

TEST(Realism, MissingBouldersAndCratersAreNamed) {
  const BumpHeights bumps(200, 1.5 * kSphereEdge, 2);
  const WaveHeights ground(6 * kSphereEdge, 3);
  const auto with = [&](double height) {
    return measured([&](const Vec3d& p) { return 0.004 * ground(p) + height * bumps(p); });
  };
  const SurfaceStatistics &none = waves(0.008, 4), &boulders = with(0.03), &craters = with(-0.03);
  EXPECT_TRUE(says(judge_realism(boulders, none, {}), "no boulders"));
  EXPECT_TRUE(says(judge_realism(craters, none, {}), "no craters"));
  EXPECT_TRUE(says(judge_realism(none, boulders, {}), "too many boulders"));
  EXPECT_TRUE(says(judge_realism(none, craters, {}), "too many craters"));
}

TEST(Realism, MissingRegionsAreNamed) {
  const WaveHeights height(5 * kSphereEdge, 3), other(5 * kSphereEdge, 4);
  const auto halves = measured([&](const Vec3d& p) { return (p.z > 0 ? 0.012 : 0.004) * height(p); });
  const auto even = measured([&](const Vec3d& p) { return 0.007 * other(p); });
  const RealismVerdict verdict = judge_realism(halves, even, {});
  EXPECT_FALSE(verdict.passes);
  EXPECT_TRUE(says(verdict, "no rough and smooth regions"));
  EXPECT_LT(verdict.variance_ratio, 0.3);
}

// Draws of one kind, whose values are normal and independent: p is then uniform.
SurfaceStatistics drawn(std::uint64_t seed) {
  CounterRandom random(seed, 0);
  SurfaceStatistics s;
  s.points = 20000;
  s.body_radius = 40;
  for (const SurfaceQuantity quantity : {SurfaceQuantity::roughness, SurfaceQuantity::skewness}) {
    s.local.push_back({quantity, 3.0, {}});
  }
  std::vector<std::uint8_t> regions;
  for (int i = 0; i < 400; ++i) {
    s.places.push_back({40 * random.uniform(), 40 * random.uniform(), 0});
    regions.push_back(static_cast<std::uint8_t>(random.below(kRegions)));
    for (LocalStatistic& statistic : s.local) statistic.values.push_back(random.normal());
  }
  s.regions = regional_sums(regions, s.places, s.local[0].values, 1.0);
  return s;
}

TEST(Realism, RejectsFiveInAHundredDrawsOfOneKind) {
  constexpr int kTrials = 200;
  int rejected = 0;
  for (std::uint64_t t = 0; t < kTrials; ++t) {
    const RealismVerdict verdict = judge_realism(drawn(2 * t), drawn(2 * t + 1), {.permutations = 199});
    if (verdict.p <= 0.05) ++rejected;
  }
  EXPECT_GE(rejected, 2);
  EXPECT_LE(rejected, 20);  // 10 expected, deviation 3.1
}

// 40 centres, spread evenly over the unit sphere along a spiral.
std::vector<std::uint8_t> find_regions_by_side(const std::vector<Vec3d>& places) {
  std::vector<std::uint8_t> regions;
  for (const Vec3d& place : places) {
    std::size_t nearest = 0;
    double least = 1e300;
    for (std::size_t r = 0; r < kRegions; ++r) {
      const double z = 1 - (2.0 * static_cast<double>(r) + 1) / kRegions,
                   turn = 2.399963 * static_cast<double>(r);
      const Vec3d center{std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
      const double squared = squared_norm(center - place);
      if (squared < least) least = squared, nearest = r;
    }
    regions.push_back(static_cast<std::uint8_t>(nearest));
  }
  return regions;
}

// Draws of one kind whose values reach beyond a region, so that neighbouring regions are alike.
SurfaceStatistics drawn_smoothly(std::uint64_t seed) {
  constexpr double kReach = 0.35;  // a region is .6 wide
  const BumpHeights up(120, kReach, 2 * seed), down(120, kReach, 2 * seed + 1);
  CounterRandom random(seed, 0);
  SurfaceStatistics s;
  s.points = 20000;
  s.body_radius = 40;
  s.local.push_back({SurfaceQuantity::roughness, 3.0, {}});
  for (int i = 0; i < 500; ++i) {
    s.places.push_back(testing::random_direction(random));
    s.local[0].values.push_back(up(s.places.back()) - down(s.places.back()));
  }
  s.regions = regional_sums(find_regions_by_side(s.places), s.places, s.local[0].values, 1.0 / 40);
  return s;
}

TEST(Realism, RejectsFewDrawsOfOneKindWhoseRegionsAreAlike) {
  constexpr int kTrials = 200;
  int rejected = 0;
  for (std::uint64_t t = 0; t < kTrials; ++t) {
    const RealismVerdict verdict =
        judge_realism(drawn_smoothly(2 * t), drawn_smoothly(2 * t + 1), {.permutations = 199});
    if (verdict.p < kPassingP) ++rejected;
  }
  EXPECT_LE(rejected, 22);  // 18 are; 33 when single regions were exchanged
}

TEST(Realism, ReliefIsComparedByScale) {
  const RealismVerdict verdict = judge_realism(waves(0.01, 1), waves(0.006, 1), {});
  ASSERT_EQ(verdict.bands.size(), 3u);
  for (const BandRatio& band : verdict.bands) EXPECT_NEAR(band.ratio, 0.6, 0.06) << band.from;
  EXPECT_FALSE(verdict.coupling_ratio);  // the sphere has no room for the largest band
  const std::vector<std::string> said = band_words(verdict, {});
  ASSERT_EQ(said.size(), 3u);
  EXPECT_TRUE(said[0].starts_with("relief at scales of 0.03 to 0.06")) << said[0];
  EXPECT_TRUE(band_words(judge_realism(waves(0.01, 1, 1), waves(0.01, 1, 2), {}), {}).empty());
}

TEST(Realism, CouplingIsComparedAndSaid) {
  SurfaceStatistics a = drawn(1), b = drawn(2);
  a.heights.coupling = 0.6, b.heights.coupling = 0.3;
  const RealismVerdict verdict = judge_realism(a, b, {.permutations = 19});
  EXPECT_EQ(verdict.coupling_ratio, 0.5);
  ASSERT_EQ(band_words(verdict, {}).size(), 1u);
  EXPECT_TRUE(band_words(verdict, {})[0].ends_with("0.50 times the coupling; at least 0.9 wanted"));
}

TEST(Realism, FewFacetsAreTooCoarseToJudge) {
  const WaveHeights height(0.6, 1);
  TriangleMesh rough = testing::icosphere(3);  // 642 vertices
  for (Vec3d& p : rough.vertices) p *= 1 + 0.004 * height(p);
  SurfaceStatisticsOptions options;
  const SurfaceStatistics a = surface_statistics(rough, options),
                          b = surface_statistics(testing::icosphere(3), options);
  const RealismVerdict verdict = judge_realism(a, b, {});
  EXPECT_FALSE(verdict.passes);
  EXPECT_TRUE(verdict.too_coarse);
  EXPECT_EQ(realism_words(verdict, {})[0],
            "too coarse to judge: 640 points; give meshes of at least 2800 facets");
}

TEST(Realism, AClearDifferenceCountsOnCoarseMeshesToo) {
  SurfaceStatistics a = drawn(1), b = drawn(2);
  a.points = b.points = 700;
  EXPECT_TRUE(judge_realism(a, b, {}).too_coarse);
  for (double& value : b.local[0].values) value -= 3;
  const RealismVerdict verdict = judge_realism(a, b, {});
  EXPECT_FALSE(verdict.too_coarse);
  EXPECT_TRUE(says(verdict, "too smooth"));
}

// Bends between 1 and 10 degrees, but for a share of places in flat facets.
SurfaceStatistics with_flat_share(std::uint64_t seed, double share) {
  SurfaceStatistics s = drawn(seed);
  CounterRandom random(seed, 1);
  s.local.push_back({SurfaceQuantity::bend, 0.0, {}});
  for (std::size_t i = 0; i < s.places.size(); ++i) {
    s.local.back().values.push_back(random.uniform() < share ? 0.0 : random.uniform(1, 10));
  }
  return s;
}

TEST(Realism, FlatFacetsOfACoarserMeshAreSeen) {
  const SurfaceStatistics body = with_flat_share(1, 0);
  const RealismVerdict coarse = judge_realism(body, with_flat_share(3, 0.3), {}),
                       remeshed = judge_realism(body, with_flat_share(3, 0.03), {});
  EXPECT_LT(coarse.p, 0.05);
  EXPECT_TRUE(says(coarse, "flat facets of a coarser mesh"));
  EXPECT_EQ(remeshed.statistics[2].distance, 0);
  EXPECT_FALSE(says(remeshed, "flat facets of a coarser mesh"));
}

TEST(Realism, DistancesAloneAreThoseOfTheVerdict) {
  const SurfaceStatistics &a = waves(0.01, 1), &b = waves(0.008, 4);
  const RealismVerdict verdict = judge_realism(a, b, {});
  const auto alone = statistic_distances(a, b);
  ASSERT_EQ(alone.size(), verdict.statistics.size());
  for (std::size_t k = 0; k < alone.size(); ++k) EXPECT_EQ(alone[k].distance, verdict.statistics[k].distance);
  EXPECT_EQ(largest_distance(alone), verdict.largest_distance);
}

TEST(Realism, MediansOfSeveralVerdicts) {
  RealismVerdict low, middle, high;
  low.points = middle.points = high.points = 20000;
  low.p = 0.01, middle.p = 0.2, high.p = 0.9;
  low.largest_distance = 0.3, middle.largest_distance = 0.1, high.largest_distance = 0.05;
  const RealismVerdict verdict = median_verdict(std::vector{high, low, middle});
  EXPECT_EQ(verdict.p, 0.2);
  EXPECT_EQ(verdict.largest_distance, 0.1);
  EXPECT_TRUE(verdict.passes);
}

TEST(Realism, WhatCannotBeComparedIsRefused) {
  const SurfaceStatistics a = drawn(1);
  SurfaceStatistics b = drawn(2);
  EXPECT_THROW(judge_realism(a, b, {.permutations = 18}), InputError);
  EXPECT_THROW(judge_realism(a, b, {}, [](double, std::string_view) { return false; }), WorkError);
  b.points = 19999;
  EXPECT_THROW(statistic_distances(a, b), InputError);
}

}  // namespace
}  // namespace astrolith
