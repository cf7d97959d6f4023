#include "descriptor/surflet_pair.h"

#include <array>
#include <optional>

#include "tests/descriptor/surflets.h"

namespace astrolith {
namespace {

using namespace testing;

struct Oriented {
  Vec3d point, normal;
};

Surflet single(const Oriented& s) {
  const auto f = [](const Vec3d& v) {
    return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  return {f(s.point), f(s.normal)};
}

// 0 .. 4 of a value in [-1, 1], or nothing when it is within margin of a border.
std::optional<int> fifth(double value, double margin) {
  const double position = (value + 1) / 2 * 5;
  const double to_border = std::fabs(position - std::round(position));
  const bool at_end = position < 0.5 || position > 4.5;
  if (to_border < 2.5 * margin && !at_end) return {};
  return std::clamp(static_cast<int>(position), 0, 4);
}

// The features word by word in double precision; nothing where rounding may decide.
std::optional<int> bin_by_definition(const Oriented& i, const Oriented& j) {
  const double margin = 1e-5;
  const Vec3d r = j.point - i.point;
  const double a_i = std::fabs(dot(i.normal, r)), a_j = std::fabs(dot(j.normal, r));
  if (std::fabs(a_i - a_j) < margin) return {};
  const Oriented &one = a_i <= a_j ? i : j, &two = a_i <= a_j ? j : i;
  const Vec3d d = normalized(two.point - one.point);
  const Vec3d u = one.normal, d_u = cross(d, u), v = normalized(d_u), w = cross(u, v);
  const double alpha = std::atan2(dot(w, two.normal), dot(u, two.normal));
  const double wide = margin / norm(r) / norm(d_u);
  if (std::fabs(std::fabs(alpha) - kPi) < wide) return {};
  const auto a = fifth(alpha / kPi, wide), b = fifth(dot(v, two.normal), wide), c = fifth(dot(u, d), wide),
             e = fifth(2 * norm(r) - 1, margin);
  if (!a || !b || !c || !e) return {};
  return ((*a * 5 + *b) * 5 + *c) * 5 + *e;
}

TEST(SurfletPair, AgreesWithTheDefinitionInDoublePrecision) {
  CounterRandom random(17);
  int compared = 0;
  std::array<int, kSurfletBins> seen{};
  const int n = 200000;
  for (int k = 0; k < n; ++k) {
    const double length = random.uniform(0.001, 1);
    const Oriented i{0.1 * random_direction(random), random_direction(random)};
    const Oriented j{i.point + length * random_direction(random), random_direction(random)};
    const auto expected = bin_by_definition(i, j);
    if (!expected) continue;
    ++compared;
    ++seen[static_cast<std::size_t>(*expected)];
    ASSERT_EQ(surflet_bin(single(i), single(j)), *expected);
  }
  EXPECT_GT(compared, 0.98 * n);
  // |gamma| > 0.6 leaves no room for some values of beta; all other bins occur.
  EXPECT_GT(std::count_if(seen.begin(), seen.end(), [](int c) { return c > 0; }), 500);
}

TEST(SurfletPair, OrderOfTheTwoDoesNotMatter) {
  CounterRandom random(18);
  for (int k = 0; k < 20000; ++k) {
    // Parallel normals in every fourth pair: both points then qualify as origin.
    const Oriented i{random_direction(random), random_direction(random)};
    const Oriented j{random_direction(random), k % 4 == 0 ? i.normal : random_direction(random)};
    ASSERT_EQ(surflet_bin(single(i), single(j)), surflet_bin(single(j), single(i)));
  }
}

int bin_of(int alpha, int beta, int gamma, int delta) { return ((alpha * 5 + beta) * 5 + gamma) * 5 + delta; }

TEST(SurfletPair, DegeneratePairs) {
  const Surflet up{{0, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(surflet_bin(up, up), bin_of(2, 2, 2, 0));
  // Both normals along the line: one behind the other, face to face, back to back.
  EXPECT_EQ(surflet_bin(up, {{0, 0, 1}, {0, 0, 1}}), bin_of(2, 2, 4, 4));
  EXPECT_EQ(surflet_bin(up, {{0, 0, 1}, {0, 0, -1}}), bin_of(4, 2, 4, 4));
  EXPECT_EQ(surflet_bin(up, {{0, 0, -1}, {0, 0, -1}}), bin_of(4, 2, 0, 4));
  // In one plane.
  EXPECT_EQ(surflet_bin(up, {{0.5, 0, 0}, {0, 0, 1}}), bin_of(2, 2, 2, 2));
}

TEST(SurfletPair, AngleBinsFollowTheArcTangent) {
  for (int k = -1799; k <= 1800; ++k) {
    if ((k + 1800) % 720 == 0) continue;  // a border
    const double angle = kPi * k / 1800;
    const auto y = static_cast<float>(std::sin(angle)), x = static_cast<float>(std::cos(angle));
    ASSERT_EQ(angle_bin(y, x) + 2, (k + 1800) / 720 - (k == 1800)) << k;
  }
}

}  // namespace
}  // namespace astrolith
