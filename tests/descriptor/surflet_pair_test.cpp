#include "descriptor/surflet_pair.h"

#include <array>
#include <numbers>
#include <optional>

#include "tests/descriptor/surflets.h"

namespace astrolith {
namespace {

using namespace testing;

struct Oriented {
  Vec3d point, normal;
};

Surflet single(const Oriented& s) { return surflet(to_float(s.point), to_float(s.normal)); }

// The bin 0 .. bins - 1 of a value in [-1, 1], or nothing when the value is within margin of a border.
std::optional<int> bin_unless_at_border(double value, int bins, double margin) {
  const double position = (value + 1) / 2 * bins;
  const double to_border = std::fabs(position - std::round(position));
  const bool at_end = position < 0.5 || position > bins - 0.5;
  if (to_border < bins / 2.0 * margin && !at_end) return {};
  return std::clamp(static_cast<int>(position), 0, bins - 1);
}

struct Expected {
  int bin;
  bool origin_is_j;
};

// The bin computed from the definitions in double precision, or nothing where rounding may decide.
std::optional<Expected> bin_by_definition(const Oriented& i, const Oriented& j, int bins) {
  const double margin = 1e-5;
  const Vec3d r = j.point - i.point;
  const double a_i = std::fabs(dot(i.normal, r)), a_j = std::fabs(dot(j.normal, r));
  if (std::fabs(a_i - a_j) < margin) return {};
  const Oriented &one = a_i <= a_j ? i : j, &two = a_i <= a_j ? j : i;
  const Vec3d d = normalized(two.point - one.point);
  const Vec3d u = one.normal, d_u = cross(d, u), v = normalized(d_u), w = cross(u, v);
  const double alpha = std::atan2(dot(w, two.normal), dot(u, two.normal));
  const double wide = margin / norm(r) / norm(d_u);
  if (std::fabs(std::fabs(alpha) - std::numbers::pi) < wide) return {};
  const auto a = bin_unless_at_border(alpha / std::numbers::pi, bins, wide),
             b = bin_unless_at_border(dot(v, two.normal), bins, wide),
             c = bin_unless_at_border(dot(u, d), bins, wide),
             e = bin_unless_at_border(2 * norm(r) - 1, bins, margin);
  if (!a || !b || !c || !e) return {};
  return Expected{((*a * bins + *b) * bins + *c) * bins + *e, a_i > a_j};
}

template <int kBins>
void expect_definition() {
  constexpr int kAll = kBins * kBins * kBins * kBins;
  CounterRandom random(17 + kBins);
  int compared = 0;
  std::array<int, kAll> seen{};
  const int n = 50000;
  for (int k = 0; k < n; ++k) {
    const double length = random.uniform(0.001, 1);
    const Oriented i{0.1 * random_direction(random), random_direction(random)};
    const Oriented j{i.point + length * random_direction(random), random_direction(random)};
    const auto expected = bin_by_definition(i, j, kBins);
    if (!expected) continue;
    ++compared;
    ++seen[static_cast<std::size_t>(expected->bin)];
    const int code = surflet_code<kBins>(single(i), single(j));
    ASSERT_EQ(code % kAll, expected->bin);
    ASSERT_EQ(code / kAll, expected->origin_is_j ? 1 : 0);
  }
  EXPECT_GT(compared, 0.97 * n);
  // With |gamma| > 0.6 some values of beta are impossible; all other bins of five occur.
  const auto occurring = std::count_if(seen.begin(), seen.end(), [](int c) { return c > 0; });
  EXPECT_GT(occurring, kBins == 5 ? 480 : 0);
}

TEST(SurfletPair, AgreesWithTheDefinitionInDoublePrecision) {
  expect_definition<2>();
  expect_definition<3>();
  expect_definition<4>();
  expect_definition<5>();
  expect_definition<6>();
  expect_definition<7>();
  expect_definition<8>();
  expect_definition<9>();
  expect_definition<10>();
}

TEST(SurfletPair, OrderOfTheTwoDoesNotMatter) {
  CounterRandom random(18);
  int other_bins = 0;
  for (int k = 0; k < 20000; ++k) {
    // Every fourth pair has parallel normals, and both points then qualify as origin.
    const Oriented i{0.5 * random_direction(random), random_direction(random)};
    const Oriented j{0.5 * random_direction(random), k % 4 == 0 ? i.normal : random_direction(random)};
    const int one = surflet_code<5>(single(i), single(j)), two = surflet_code<5>(single(j), single(i));
    other_bins += one % 625 != two % 625 ? 1 : 0;
    EXPECT_NE(one / 625, two / 625);
  }
  EXPECT_LE(other_bins, 1);  // rounding may decide on a border
}

// Splits a code into alpha, beta, gamma, delta and the origin.
int code_of(int alpha, int beta, int gamma, int delta) {
  return ((alpha * 5 + beta) * 5 + gamma) * 5 + delta;
}
int bin(const Oriented& i, const Oriented& j) { return surflet_code<5>(single(i), single(j)) % 625; }

TEST(SurfletPair, DegeneratePairs) {
  const Oriented up{{0, 0, 0}, {0, 0, 1}}, down{{0, 0, 0}, {0, 0, -1}};
  EXPECT_EQ(bin(up, up), code_of(2, 2, 2, 0));
  EXPECT_EQ(bin(up, down), code_of(4, 2, 2, 0));
  // Both normals lie along the line: one behind the other, face to face, back to back.
  EXPECT_EQ(bin(up, {{0, 0, 1}, {0, 0, 1}}), code_of(2, 2, 4, 4));
  EXPECT_EQ(bin(up, {{0, 0, 1}, {0, 0, -1}}), code_of(4, 2, 4, 4));
  EXPECT_EQ(bin(down, {{0, 0, 1}, {0, 0, 1}}), code_of(4, 2, 0, 4));
  // Both points lie in one plane.
  EXPECT_EQ(bin(up, {{0.5, 0, 0}, {0, 0, 1}}), code_of(2, 2, 2, 2));
}

// A pair whose frame is known: r along x, u along z, so v = d x u = -y and w = u x v = x.
TEST(SurfletPair, AngleBinsFollowTheArcTangent) {
  for (int k = -1799; k < 1800; ++k) {
    if ((k + 1800) % 720 == 0) continue;  // a border
    const double alpha = std::numbers::pi * k / 1800;
    const Oriented i{{0, 0, 0}, {0, 0, 1}}, j{{0.9, 0, 0}, {std::sin(alpha), 0, std::cos(alpha)}};
    ASSERT_EQ(bin(i, j), code_of((k + 1800) / 720, 2, 2, 4)) << k;
  }
}

TEST(SurfletPair, BordersAreWhereTheyBelong) {
  constexpr PairBorders<5> odd;
  EXPECT_FLOAT_EQ(odd.unit[0], 0.04f);
  EXPECT_FLOAT_EQ(odd.unit[1], 0.36f);
  EXPECT_FLOAT_EQ(odd.tangent[0], static_cast<float>(std::pow(std::tan(std::numbers::pi / 5), 2)));
  EXPECT_FLOAT_EQ(odd.tangent[1], static_cast<float>(std::pow(std::tan(3 * std::numbers::pi / 5), 2)));
  constexpr PairBorders<4> even;
  EXPECT_FLOAT_EQ(even.unit[0], 0.25f);
  EXPECT_TRUE(even.right[0]);
  constexpr PairBorders<10> fine;
  EXPECT_FLOAT_EQ(fine.tangent[3], static_cast<float>(std::pow(std::tan(4 * std::numbers::pi / 5), 2)));
  EXPECT_TRUE(fine.obtuse[3]);
}

}  // namespace
}  // namespace astrolith
