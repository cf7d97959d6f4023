#include "synthesis/noise/coordinate_warp.h"

#include <cmath>
#include <set>

#include "tests/support/points.h"
#include "tests/synthesis/noise_sampling.h"

namespace astrolith {
namespace {

const Box kWarpDomain{{-4, -4, -4}, {4, 4, 4}};

struct LoneWarp {
  LoneWarp(const Warp& warp, std::uint32_t seed)
      : tables(make_coordinate_warp(warp, seed, kWarpDomain, arrays)) {}

  ArrayStore arrays;
  CoordinateWarp tables;
};

Vec3d warped(const LoneWarp& warp, const Vec3f& p) {
  Vec3f w;
  warp_points(warp.tables, warp.arrays.view(), 1, &p.x, &p.y, &p.z, &w.x, &w.y, &w.z);
  const Vec3f alone = warped(warp.tables, warp.arrays.view(), p);
  EXPECT_EQ(w, alone);
  return {w.x, w.y, w.z};
}

Vec3d to_double(const Vec3f& p) { return {p.x, p.y, p.z}; }

TEST(CoordinateWarp, DisplacesEachAxisOnItsOwnWithinItsBound) {
  const LoneWarp warp({0.5, 1.5, 3, 0.5, 2.0}, 7u);
  EXPECT_NEAR(warp.tables.bound, 0.875, 1e-3);
  CounterRandom random(1);
  double xx = 0.0, xy = 0.0, xz = 0.0;
  constexpr int n = 50000;
  for (int i = 0; i < n; ++i) {
    const Vec3f p = testing::random_place(random, 4.0);
    const Vec3d d = warped(warp, p) - to_double(p);
    ASSERT_LE(std::fabs(d.x), warp.tables.bound);
    ASSERT_LE(std::fabs(d.y), warp.tables.bound);
    ASSERT_LE(std::fabs(d.z), warp.tables.bound);
    xx += d.x * d.x / n;
    xy += d.x * d.y / n;
    xz += d.x * d.z / n;
  }
  EXPECT_NEAR(std::sqrt(xx), 0.5 * 0.389 * std::sqrt(1 + 0.25 + 0.0625), 0.02);
  EXPECT_NEAR(xy / xx, 0.0, 0.1);
  EXPECT_NEAR(xz / xx, 0.0, 0.1);
}

TEST(CoordinateWarp, EveryOctaveOfEveryAxisHasASeedOfItsOwn) {
  const LoneWarp warp({0.5, 1.5, 4, 0.5, 2.0}, 7u);
  std::set<std::uint32_t> seeds;
  for (const ArrayRange<NoiseOctave>& octaves : warp.tables.octaves) {
    for (const NoiseOctave& o : warp.arrays.view().span(octaves)) seeds.insert(o.seed);
  }
  EXPECT_EQ(seeds.size(), 12u);
}

TEST(CoordinateWarp, ImagesOfBoxesHoldTheirPoints) {
  CounterRandom random(2);
  int tight = 0;
  for (int k = 0; k < 2000; ++k) {
    const LoneWarp warp({random.uniform(-1, 1), random.uniform(0.1, 3), 1 + k % 4, 0.5, 2.0},
                        static_cast<std::uint32_t>(random.next()));
    const double size = std::pow(10.0, random.uniform(-3.0, 0.3));
    const Vec3d corner = to_double(testing::random_place(random, 6.0));  // some lie outside
    const Box box{corner, corner + Vec3d{size, size, size}};
    const Box image = warped_box(warp.tables, warp.arrays.view(), box);
    for (int i = 0; i < 50; ++i) {
      const Vec3d p = warped(warp, to_float(testing::random_point(random, box)));
      ASSERT_TRUE(p.x >= image.min.x && p.y >= image.min.y && p.z >= image.min.z);
      ASSERT_TRUE(p.x <= image.max.x && p.y <= image.max.y && p.z <= image.max.z);
    }
    tight += image.extent().x < size + warp.tables.bound;
  }
  EXPECT_GT(tight, 500);
}

TEST(CoordinateWarp, KeepsItsLipschitzBound) {
  const LoneWarp warp({0.5, 1.5, 3, 0.5, 2.0}, 7u);
  CounterRandom random(3);
  for (int i = 0; i < 50000; ++i) {
    const Vec3f p = testing::random_place(random, 4.0), q = p + testing::random_place(random, 0.05);
    ASSERT_LE(norm(warped(warp, p) - warped(warp, q)),
              warp.tables.lipschitz_bound * norm(to_double(p) - to_double(q)) + 1e-5);
  }
}

}  // namespace
}  // namespace astrolith
