#include <array>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "descriptor/histogram_distance.h"
#include "descriptor/surflet_histogram.h"
#include "descriptor/surflet_pair.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
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
int join_code(int alpha, int beta, int gamma, int delta) {
  return ((alpha * 5 + beta) * 5 + gamma) * 5 + delta;
}
int bin(const Oriented& i, const Oriented& j) { return surflet_code<5>(single(i), single(j)) % 625; }

TEST(SurfletPair, DegeneratePairs) {
  const Oriented up{{0, 0, 0}, {0, 0, 1}}, down{{0, 0, 0}, {0, 0, -1}};
  EXPECT_EQ(bin(up, up), join_code(2, 2, 2, 0));
  EXPECT_EQ(bin(up, down), join_code(4, 2, 2, 0));
  // Both normals lie along the line: one behind the other, face to face, back to back.
  EXPECT_EQ(bin(up, {{0, 0, 1}, {0, 0, 1}}), join_code(2, 2, 4, 4));
  EXPECT_EQ(bin(up, {{0, 0, 1}, {0, 0, -1}}), join_code(4, 2, 4, 4));
  EXPECT_EQ(bin(down, {{0, 0, 1}, {0, 0, 1}}), join_code(4, 2, 0, 4));
  // Both points lie in one plane.
  EXPECT_EQ(bin(up, {{0.5, 0, 0}, {0, 0, 1}}), join_code(2, 2, 2, 2));
}

// A pair whose frame is known: r along x, u along z, so v = d x u = -y and w = u x v = x.
TEST(SurfletPair, AngleBinsFollowTheArcTangent) {
  for (int k = -1799; k < 1800; ++k) {
    if ((k + 1800) % 720 == 0) continue;  // a border
    const double alpha = std::numbers::pi * k / 1800;
    const Oriented i{{0, 0, 0}, {0, 0, 1}}, j{{0.9, 0, 0}, {std::sin(alpha), 0, std::cos(alpha)}};
    ASSERT_EQ(bin(i, j), join_code((k + 1800) / 720, 2, 2, 4)) << k;
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

ShapeHistogram make_histogram(const SurfaceSamples& s) { return surflet_histogram(s.points, s.normals); }

std::uint64_t total(const ShapeHistogram& h) {
  return std::accumulate(h.counts.begin(), h.counts.end(), std::uint64_t{0});
}

// The number of pairs that changed their bin: half the sum of |differences|.
double moved(const ShapeHistogram& a, const ShapeHistogram& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.counts.size(); ++i) {
    sum += std::fabs(static_cast<double>(a.counts[i]) - static_cast<double>(b.counts[i]));
  }
  return sum / 2;
}

// Surflets as surflet_histogram makes them of points and normals.
std::vector<Surflet> make_surflets(const SurfaceSamples& s, double max_distance) {
  Box box;
  for (const Vec3d& p : s.points) box.extend(p);
  const auto single = [](const Vec3d& v) {
    return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  std::vector<Surflet> surflets;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    surflets.push_back(
        surflet(single((1 / max_distance) * (s.points[i] - box.center())), single(normalized(s.normals[i]))));
  }
  return surflets;
}

// Counts with every vector width, vector end and task edge agree with counting one pair at a time.
template <int kBins>
void expect_one_pair_at_a_time(int n) {
  const SurfaceSamples s = random_surflets(n, 3);
  const ShapeHistogram h = surflet_histogram(s.points, s.normals, kBins);
  ASSERT_EQ(h.counts.size(), static_cast<std::size_t>(bin_count(PairFeatures::wahl, kBins)));
  ASSERT_EQ(h.pairs, static_cast<std::uint64_t>(n) * static_cast<std::uint64_t>(std::max(n - 1, 0)) / 2);
  ASSERT_EQ(total(h), h.pairs);
  const std::vector<Surflet> surflets = make_surflets(s, h.max_distance);
  ShapeHistogram expected = h;
  expected.counts.assign(h.counts.size(), 0);
  for (std::size_t i = 0; i < surflets.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto code = static_cast<std::size_t>(surflet_code<kBins>(surflets[i], surflets[j]));
      ++expected.counts[code % expected.counts.size()];
    }
  }
  // For a pair on the border of a bin it may matter which of the two points comes first.
  ASSERT_LE(moved(h, expected), 1 + 1e-5 * static_cast<double>(h.pairs)) << n;
}

TEST(SurfletHistogram, EqualsOnePairAtATime) {
  for (int n : {0, 1, 2, 3, 15, 16, 17, 18, 63, 64, 65, 66, 79, 80, 81, 511, 512, 513, 700}) {
    expect_one_pair_at_a_time<5>(n);
  }
  expect_one_pair_at_a_time<2>(300);
  expect_one_pair_at_a_time<3>(300);
  expect_one_pair_at_a_time<4>(300);
  expect_one_pair_at_a_time<6>(300);
  expect_one_pair_at_a_time<7>(300);
  expect_one_pair_at_a_time<8>(300);
  expect_one_pair_at_a_time<9>(300);
  expect_one_pair_at_a_time<10>(300);
}

// Histograms agree up to rounding, which moves the few pairs that lie on the border of a bin.
TEST(SurfletHistogram, MovingTurningAndScalingChangeNothing) {
  const SurfaceSamples s = random_surflets(800, 1);
  const ShapeHistogram before = make_histogram(s);
  SurfaceSamples t = s;
  for (Vec3d& p : t.points) p = 1234.5 * rotated(0.5, {0.5, -0.5, 0.5}, p) + Vec3d{1e5, -2e5, 3e4};
  for (Vec3d& n : t.normals) n = 3.0 * rotated(0.5, {0.5, -0.5, 0.5}, n);
  EXPECT_LT(moved(before, make_histogram(t)), 3e-5 * static_cast<double>(before.pairs));
  const double c = std::cos(0.3), q = std::sin(0.3) / std::sqrt(3.0);
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    t.points[i] = rotated(c, {q, q, q}, s.points[i]);
    t.normals[i] = rotated(c, {q, q, q}, s.normals[i]);
  }
  EXPECT_LT(moved(before, make_histogram(t)), 3e-5 * static_cast<double>(before.pairs));
}

TEST(SurfletHistogram, OrderAndThreadsChangeNothing) {
  const SurfaceSamples s = random_surflets(1500, 5);
  ShapeHistogram one;
  {
    const ThreadLimit limit(1);
    one = make_histogram(s);
  }
  SurfaceSamples shuffled = s;
  CounterRandom random(6);
  for (std::size_t i = s.points.size() - 1; i > 0; --i) {
    const std::size_t k = random.below(i + 1);
    std::swap(shuffled.points[i], shuffled.points[k]);
    std::swap(shuffled.normals[i], shuffled.normals[k]);
  }
  const ThreadLimit limit(4);
  EXPECT_EQ(make_histogram(s).counts, one.counts);
  EXPECT_EQ(make_histogram(shuffled).counts, one.counts);
}

// On a sphere a pair at angle theta has alpha = theta, beta = 0, gamma = -sin(theta/2), delta = sin(theta/2),
// and delta^2 is uniform in [0, 1].
TEST(SurfletHistogram, SphereAgainstQuadrature) {
  SurfaceSamples s;
  const int half = 1500;
  for (int k = 0; k < half; ++k) {  // a golden spiral with all antipodes, so that the diameter is 2
    const double z = 1 - (k + 0.5) / half, phi = k * std::numbers::pi * (3 - std::sqrt(5.0)),
                 r = std::sqrt(1 - z * z);
    s.points.push_back({r * std::cos(phi), r * std::sin(phi), z});
    s.points.push_back(-s.points.back());
  }
  s.normals = s.points;
  const auto f = make_histogram(s).frequencies();
  std::vector<double> expected(625, 0.0);
  const int steps = 200000;
  for (int k = 0; k < steps; ++k) {
    const double delta = std::sqrt((k + 0.5) / steps), theta = 2 * std::asin(delta);
    const int a = static_cast<int>((theta / std::numbers::pi + 1) / 2 * 5),
              g = static_cast<int>((1 - delta) / 2 * 5);
    expected[static_cast<std::size_t>(((a * 5 + 2) * 5 + g) * 5 + static_cast<int>(delta * 5))] +=
        1.0 / steps;
  }
  for (std::size_t b = 0; b < f.size(); ++b) ASSERT_NEAR(f[b], expected[b], 1e-3) << b;
}

TEST(SurfletHistogram, TellsShapesApartAndSamplingsNot) {
  const auto sampled = [](const TriangleMesh& mesh, std::uint64_t seed) {
    return make_histogram(sample_poisson_disk(mesh, 2000, seed));
  };
  const auto torus_a = sampled(torus(1, 0.4), 1), torus_b = sampled(torus(1, 0.4), 2);
  EXPECT_GT(similarity(torus_a, torus_b), 0.96);
  EXPECT_LT(similarity(torus_a, sampled(icosphere(4), 1)), 0.7);
  EXPECT_DOUBLE_EQ(similarity(torus_a, torus_a), 1);
}

TEST(SurfletHistogram, CoincidentPointsHaveABin) {
  const std::vector<Vec3d> points(10, Vec3d{1, 2, 3}), normals(10, Vec3d{0, 0, 1});
  EXPECT_EQ(surflet_histogram(points, normals).counts[((2 * 5 + 2) * 5 + 2) * 5], 45u);
}

TEST(SurfletHistogram, WrongInput) {
  const std::vector<Vec3d> two(2), three(3);
  EXPECT_THROW(surflet_histogram(two, three), InputError);
  std::vector<Vec3d> bad(2);
  bad[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(surflet_histogram(bad, two), InputError);
  EXPECT_THROW(surflet_histogram(two, bad), InputError);
  EXPECT_THROW(surflet_histogram(two, two, 1), InputError);
  EXPECT_THROW(surflet_histogram(two, two, 11), InputError);
}

}  // namespace
}  // namespace astrolith
