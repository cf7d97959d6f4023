#include <numbers>
#include <numeric>

#include "descriptor/histogram_distance.h"
#include "descriptor/local_features.h"
#include "descriptor/shape_description.h"
#include "descriptor/surflet_histogram.h"
#include "descriptor/surflet_pair.h"
#include "geometry/surface/sample_curvature.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/descriptor/surflets.h"

namespace astrolith {
namespace {

using namespace testing;

DescriptionOptions make_options(PairFeatures features, std::int64_t points, std::uint64_t seed = 1) {
  DescriptionOptions options;
  options.features = features;
  options.points = points;
  options.seed = seed;
  return options;
}

// The features of all six axes computed from their definitions, one pair at a time, in double precision.
TEST(AhdHistogram, EqualsTheDefinition) {
  const int n = 400;
  const SurfaceSamples s = random_surflets(n, 4);
  CounterRandom random(5);
  std::vector<double> curvatures;
  for (int i = 0; i < n; ++i) curvatures.push_back(10 * random.normal());
  const ShapeHistogram h = ahd_histogram(s.points, s.normals, curvatures);
  ASSERT_EQ(h.counts.size(), 15625u);
  const std::vector<std::int32_t> local = local_codes(s.points, s.normals, curvatures, 5);
  std::vector<double> expected(15625, 0.0);
  const auto fifth = [](double unit) { return std::clamp(static_cast<int>(5 * (unit + 1) / 2), 0, 4); };
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3d r = s.points[j] - s.points[i];
      const bool first = std::fabs(dot(s.normals[i], r)) <= std::fabs(dot(s.normals[j], r));
      const std::size_t one = first ? i : j, two = first ? j : i;
      const Vec3d d = normalized(s.points[two] - s.points[one]), u = s.normals[one],
                  v = normalized(cross(d, u)), w = cross(u, v), m = s.normals[two];
      const int surflet =
          ((fifth(std::atan2(dot(w, m), dot(u, m)) / std::numbers::pi) * 5 + fifth(dot(v, m))) * 5 +
           fifth(dot(u, d))) *
              5 +
          fifth(2 * norm(r) / h.max_distance - 1);
      ++expected[static_cast<std::size_t>(surflet * 25 + local[one])];
    }
  }
  double moved = 0;
  for (std::size_t b = 0; b < expected.size(); ++b) {
    moved += std::fabs(expected[b] - static_cast<double>(h.counts[b])) / 2;
  }
  EXPECT_LE(moved, 3);  // pairs of 79,800 that lie on a border within float32 rounding
}

TEST(AhdHistogram, SumsToWahlsHistogram) {
  const TriangleMesh mesh = torus(1, 0.4);
  const ShapeHistogram ahd = describe_shape(mesh, make_options(PairFeatures::ahd, 900)).histogram;
  const ShapeHistogram wahl = describe_shape(mesh, make_options(PairFeatures::wahl, 900)).histogram;
  ASSERT_EQ(ahd.pairs, wahl.pairs);
  double moved = 0;
  for (std::size_t b = 0; b < 625; ++b) {
    const auto sum =
        std::accumulate(ahd.counts.begin() + static_cast<std::ptrdiff_t>(25 * b),
                        ahd.counts.begin() + static_cast<std::ptrdiff_t>(25 * b + 25), std::uint64_t{0});
    moved += std::fabs(static_cast<double>(sum) - static_cast<double>(wahl.counts[b])) / 2;
  }
  EXPECT_LE(moved, 10);  // pairs come in another order, which may change rounding on a border
}

TEST(AhdHistogram, ThreadsAndOrderChangeNothing) {
  SurfaceSamples s = sample_poisson_disk(torus(1, 0.4), 1200, 7);
  std::vector<double> k = point_curvature(s.points, s.normals).gaussian;
  std::vector<std::uint64_t> one;
  {
    const ThreadLimit limit(1);
    one = ahd_histogram(s.points, s.normals, k).counts;
  }
  EXPECT_EQ(ahd_histogram(s.points, s.normals, k).counts, one);
  std::reverse(s.points.begin(), s.points.end());
  std::reverse(s.normals.begin(), s.normals.end());
  std::reverse(k.begin(), k.end());
  EXPECT_EQ(ahd_histogram(s.points, s.normals, k).counts, one);
}

TEST(AhdHistogram, WrongInput) {
  const std::vector<Vec3d> two = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_THROW(ahd_histogram(two, two, std::vector<double>(1)), InputError);
  EXPECT_THROW(ahd_histogram(two, two, std::vector<double>{0, std::nan("")}), InputError);
}

// The descriptions agree up to sampling: the mesh is moved, turned and scaled, and its vertices and triangles
// are renumbered.
TEST(ShapeDescription, InvariantUpToResampling) {
  const TriangleMesh mesh = torus(1, 0.4, 60, 30);
  TriangleMesh other = mesh;
  std::reverse(other.vertices.begin(), other.vertices.end());
  std::reverse(other.triangles.begin(), other.triangles.end());
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (Triangle& t : other.triangles) t = {last - t[1], last - t[2], last - t[0]};
  for (Vec3d& p : other.vertices) p = 37.0 * rotated(0.5, {0.5, -0.5, 0.5}, p) + Vec3d{100, -2000, 3};
  for (const PairFeatures features : {PairFeatures::wahl, PairFeatures::ahd}) {
    const auto a = describe_shape(mesh, make_options(features, 1500, 1)).histogram;
    const auto again = describe_shape(mesh, make_options(features, 1500, 2)).histogram;
    const auto moved = describe_shape(other, make_options(features, 1500, 1)).histogram;
    EXPECT_GT(similarity(a, again), 0.94);
    EXPECT_GT(similarity(a, moved), 0.94);
    const auto sphere = describe_shape(icosphere(4), make_options(features, 1500)).histogram;
    EXPECT_LT(similarity(a, sphere), 0.6);
  }
}

// A sphere has eta = 0 and kappa = 1/2, so that all pairs are in one of the 25 local bins.
TEST(ShapeDescription, LocalFeaturesOfASphere) {
  const ShapeHistogram h = describe_shape(icosphere(4, 3.0), make_options(PairFeatures::ahd, 800)).histogram;
  std::vector<double> f = h.frequencies();
  EXPECT_NEAR(marginal(f, 5, 4)[0], 1, 1e-12);
  EXPECT_NEAR(marginal(f, 5, 5)[3], 1, 1e-12);
}

TEST(ShapeDescription, PointsAloneAgreeWithTheMesh) {
  const TriangleMesh mesh = torus(1, 0.4, 120, 60);
  const SurfaceSamples s = sample_poisson_disk(mesh, 3000, 9);
  const auto from_points = describe_shape(s.points, s.normals, make_options(PairFeatures::ahd, 3000));
  const auto from_mesh = describe_shape(mesh, make_options(PairFeatures::ahd, 3000));
  EXPECT_GT(similarity(from_points.histogram, from_mesh.histogram), 0.93);
  EXPECT_TRUE(from_points.remarks.empty());
}

TEST(ShapeDescription, SaysWhatIsMissing) {
  const auto open = describe_shape(open_cap(3), make_options(PairFeatures::ahd, 200));
  EXPECT_GT(open.vertices_left_out, 0);
  ASSERT_FALSE(open.remarks.empty());
  EXPECT_NE(open.remarks[0].find("no curvature"), std::string::npos);
  EXPECT_TRUE(describe_shape(open_cap(3), make_options(PairFeatures::wahl, 200)).remarks.empty());

  SurfaceSamples s = sample_poisson_disk(icosphere(2), 100, 1);
  s.points.insert(s.points.end(), s.points.begin(), s.points.begin() + 30);
  s.normals.insert(s.normals.end(), s.normals.begin(), s.normals.begin() + 30);
  const auto repeated = describe_shape(s.points, s.normals, make_options(PairFeatures::ahd, 500));
  EXPECT_EQ(repeated.points, 100);
  ASSERT_EQ(repeated.remarks.size(), 2u);
  EXPECT_EQ(repeated.remarks[0], "30 repeated points were left out");
  EXPECT_EQ(repeated.remarks[1], "only 100 points, 500 were asked for");
  EXPECT_EQ(describe_shape(s.points, s.normals, make_options(PairFeatures::ahd, 50)).points, 50);
}

TEST(ShapeDescription, WrongInput) {
  const std::vector<Vec3d> one = {{0, 0, 1}}, same(5, Vec3d{1, 2, 3}), none(5);
  EXPECT_THROW(describe_shape(one, one, {}), InputError);
  EXPECT_THROW(describe_shape(same, same, {}), InputError);
  EXPECT_THROW(describe_shape(same, none, {}), InputError);  // no normals
  EXPECT_THROW(describe_shape(same, one, {}), InputError);
  EXPECT_THROW(describe_shape(TriangleMesh{}, {}), InputError);
  EXPECT_THROW(describe_shape(icosphere(1), make_options(PairFeatures::ahd, 1)), InputError);
}

TEST(LocalFeatures, NormalPerturbation) {
  const Vec3d center{1, 2, 3};
  for (const double angle : {0.0, 1e-9, 0.3, std::numbers::pi / 2, 3.0, std::numbers::pi}) {
    const Vec3d normal{std::sin(angle), 0, std::cos(angle)};
    EXPECT_NEAR(normal_perturbation(center + Vec3d{0, 0, 7}, normal, center), angle, 1e-15);
  }
  EXPECT_DOUBLE_EQ(normal_perturbation(center, {0, 0, 1}, center), std::numbers::pi / 2);
}

TEST(LocalFeatures, CurvatureIsBoundedAndOdd) {
  EXPECT_EQ(bounded_curvature(0), 0);
  EXPECT_EQ(bounded_curvature(1), 0.5);
  for (const double x : {0.1, 2.0, 1e6, 1e300}) {
    EXPECT_LE(bounded_curvature(x), 1);
    EXPECT_EQ(bounded_curvature(-x), -bounded_curvature(x));
  }
}

TEST(LocalFeatures, SpreadOfASphere) {
  std::vector<Vec3d> points = {{2, 0, 0}, {-2, 0, 0}, {0, 2, 0}, {0, -2, 0}};
  for (Vec3d& p : points) p += Vec3d{5, 6, 7};
  const PointSpread spread = point_spread(points);
  EXPECT_EQ(spread.center, (Vec3d{5, 6, 7}));
  EXPECT_EQ(spread.mean_square, 4);
  EXPECT_EQ(point_spread({}).mean_square, 0);
}

TEST(LocalFeatures, CodesAreEtaThenKappa) {
  const std::vector<Vec3d> points = {{0, 0, 1}, {0, 0, -1}};
  const std::vector<Vec3d> normals = {{0, 0, 1}, {0, 0, 1}};  // eta = 0 and pi
  const std::vector<double> curvatures = {1, -1e9};
  EXPECT_EQ(local_codes(points, normals, curvatures, 5), (std::vector<std::int32_t>{0 * 5 + 3, 4 * 5 + 0}));
  EXPECT_EQ(local_codes(points, normals, curvatures, 10), (std::vector<std::int32_t>{7, 90}));
}

}  // namespace
}  // namespace astrolith
