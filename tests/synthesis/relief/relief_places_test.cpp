#include "synthesis/relief/relief_places.h"

#include <set>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/relief/relief_tiles.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/reliefs.h"

namespace astrolith {
namespace {

using testing::find_places;
using testing::position;
using testing::potato_recipe;
using testing::sphere_recipe;

TEST(ReliefPlaces, LieOnTheBallWithItsNormals) {
  const double spacing = 0.037;
  const std::vector<ReliefPlace> places = find_places(sphere_recipe(1.0), spacing);
  // A line of every axis crosses the ball twice; crossings with n_a^2 <= 1/5 are left out: a share of 1/5 of
  // the disc.
  const double expected = 3 * 2 * 3.14159265 * (1.0 - kLeastReliefSlant) / (spacing * spacing);
  EXPECT_NEAR(static_cast<double>(places.size()), expected, 0.02 * expected);
  for (const ReliefPlace& p : places) {
    const Vec3d at = position(p, spacing);
    ASSERT_NEAR(norm(at), 1.0, 1e-3);
    const double along[3] = {at.x, at.y, at.z};
    ASSERT_NEAR(static_cast<double>(p.normal.x), along[p.axis], 5e-3);
    ASSERT_NEAR(static_cast<double>(p.normal.y), along[(p.axis + 1) % 3], 5e-3);
    ASSERT_GT(p.normal.x * p.normal.x, kLeastReliefSlant);
  }
}

TEST(ReliefPlaces, AreTheSameForAnyThreadCount) {
  const Recipe potato = potato_recipe(60, 5);
  std::vector<ReliefPlace> places[2];
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    places[threads / 3] = find_places(potato, 0.02);
  }
  ASSERT_EQ(places[0].size(), places[1].size());
  for (std::size_t i = 0; i < places[0].size(); ++i) {
    const ReliefPlace &a = places[0][i], &b = places[1][i];
    ASSERT_TRUE(a.axis == b.axis && a.u == b.u && a.v == b.v && a.w == b.w && a.weight == b.weight) << i;
  }
}

TEST(ReliefPlaces, HaveAPixelEach) {
  const std::vector<ReliefPlace> places = find_places(potato_recipe(60, 5), 0.02);
  const ReliefLayout layout = relief_layout(places);
  const std::set<std::uint32_t> pixels(layout.pixels.begin(), layout.pixels.end());
  EXPECT_EQ(pixels.size(), places.size());
  EXPECT_LT(*pixels.rbegin(), static_cast<std::uint32_t>(layout.width * layout.height));
}

// Every place serves the tiles of all cells whose points lie within two lines of it on its sheet.
TEST(ReliefTiles, HoldEveryPlace) {
  const std::vector<ReliefPlace> places = find_places(potato_recipe(60, 5), 0.02);
  const ReliefTiles tiles = make_relief_tiles(places, "test");
  std::vector<int> uses(places.size(), 0);
  for (const std::uint32_t place : tiles.places) {
    if (place != kNoPlace) ++uses[place];
  }
  EXPECT_GT(*std::min_element(uses.begin(), uses.end()), 0);
}

TEST(ReliefPlaces, RefuseASpacingThatIsTooSmall) {
  EXPECT_THROW(find_places(sphere_recipe(1.0), 1e-7), InputError);
}

}  // namespace
}  // namespace astrolith
