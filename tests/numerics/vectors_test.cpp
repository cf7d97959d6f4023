#include <limits>
#include <vector>

#include "numerics/box_tree.h"
#include "numerics/hash_random.h"
#include "numerics/jacobi_rotation.h"
#include "numerics/tangent_frame.h"
#include "numerics/vec3.h"
#include "tests/support/points.h"

namespace astrolith {
namespace {

TEST(Vec3, TheLongestAxisIsTheFirstOfEqualOnes) {
  EXPECT_EQ(longest_axis({2.0, 1.0, 2.0}), &Vec3d::x);
  EXPECT_EQ(longest_axis({1.0, 2.0, 2.0}), &Vec3d::y);
  EXPECT_EQ(longest_axis<float>({1.0, 2.0, 3.0}), &Vec3f::z);
}

// A double must be rounded to float whatever the optimiser makes of neighbouring statements. g++ 12.2 drops
// the rounding without -fno-tree-slp-vectorize.
__attribute__((noinline)) void round_to_float(std::vector<Vec3d>& points) {
  for (Vec3d& p : points) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

TEST(Rounding, OfNeighbouringComponentsIsKept) {
  std::vector<Vec3d> points(5, Vec3d{0.1, 0.2, 0.3});
  round_to_float(points);
  for (const Vec3d& p : points) {
    EXPECT_EQ(p.x, static_cast<double>(0.1f));
    EXPECT_EQ(p.y, static_cast<double>(0.2f));
    EXPECT_EQ(p.z, static_cast<double>(0.3f));
  }
}

struct Eigen3 {
  Matrix3 values, vectors = kIdentity3;
};
Eigen3 diagonalised(const Matrix3& m) {
  Eigen3 result{m};
  for (int sweep = 0; sweep < 6; ++sweep) {
    rotate_to_diagonal(result.values, result.vectors, 0, 1);
    rotate_to_diagonal(result.values, result.vectors, 0, 2);
    rotate_to_diagonal(result.values, result.vectors, 1, 2);
  }
  return result;
}

TEST(JacobiRotation, GivesEigenvectors) {
  const Matrix3 m{{{4.0, 1.0, -2.0}, {1.0, 2.0, 0.5}, {-2.0, 0.5, -3.0}}};
  const auto [values, v] = diagonalised(m);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double product = m[i][0] * v[0][k] + m[i][1] * v[1][k] + m[i][2] * v[2][k];
      EXPECT_NEAR(product, values[k][k] * v[i][k], 1e-14);
      EXPECT_NEAR(v[0][k] * v[0][i] + v[1][k] * v[1][i] + v[2][k] * v[2][i], i == k ? 1.0 : 0.0, 1e-14);
    }
  }
}

// The cotangent of twice the angle is so large here that its square is infinite.
TEST(JacobiRotation, DoesNotOverflow) {
  const auto [values, vectors] = diagonalised({{{1.0, 1e-200, 0.0}, {1e-200, 2.0, 0.0}, {0.0, 0.0, 3.0}}});
  EXPECT_EQ(vectors[0][1], 1e-200);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(values[k][k], static_cast<double>(k + 1));
}

template <typename T>
void expect_right_handed_frame(const Tangents<T>& t, const Vec3<T>& n, T tolerance) {
  EXPECT_NEAR(norm(t.first), 1, tolerance);
  EXPECT_NEAR(norm(t.second), 1, tolerance);
  EXPECT_NEAR(dot(t.first, n), 0, tolerance);
  EXPECT_NEAR(norm(cross(t.first, t.second) - n), 0, tolerance);
}

TEST(TangentFrame, IsRightHandedAboutAnyNormal) {
  CounterRandom random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d n = testing::random_direction(random);
    const Vec3f f = to_float(n);
    const float sign = f.z < 0.0f ? -1.0f : 1.0f;
    expect_right_handed_frame(duff_tangents<SumRounding::kFused>(f, sign), f, 1e-6f);
    expect_right_handed_frame(duff_tangents<SumRounding::kTwice>(f, sign), f, 1e-6f);
    expect_right_handed_frame(crossed_tangents(n), n, 1e-14);
  }
}

// At n.z = 0 either sign gives a frame, and the poles are no exception.
TEST(TangentFrame, HoldsAtTheEquatorAndThePoles) {
  for (const float sign : {-1.0f, 1.0f}) {
    expect_right_handed_frame(duff_tangents<SumRounding::kFused>({0.6f, -0.8f, 0.0f}, sign),
                              {0.6f, -0.8f, 0.0f}, 1e-6f);
    expect_right_handed_frame(duff_tangents<SumRounding::kTwice>({0, 0, sign}, sign), {0, 0, sign}, 1e-6f);
  }
  for (const Vec3d& n : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, -1}}) {
    expect_right_handed_frame(crossed_tangents(n), n, 1e-15);
  }
}

TEST(Box, HoldsItsPointsButNoneThatIsNoNumber) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Box box;
  for (const Vec3d& p : {Vec3d{1, 5, -2}, Vec3d{kNan, kNan, kNan}, Vec3d{-1, 2, 1}}) box.extend(p);
  EXPECT_EQ(box.min, (Vec3d{-1, 2, -2}));
  EXPECT_EQ(box.max, (Vec3d{1, 5, 1}));
  EXPECT_EQ(box.longest_side(), 3.0);
  const Box other{{0, 0, 0}, {4, 4, 4}};
  EXPECT_EQ(united(box, other).max, (Vec3d{4, 5, 4}));
  EXPECT_EQ(common_part(box, other).min, (Vec3d{0, 2, 0}));
}

Box random_box(CounterRandom& random, double largest) {
  const Vec3d corner{random.uniform(), random.uniform(), random.uniform()};
  return {corner, corner + Vec3d{largest * random.uniform(), largest * random.uniform(), 0.1 * largest}};
}

TEST(BoxTree, FindsWhatASearchOfAllFinds) {
  CounterRandom random(1);
  for (const int n : {0, 1, 4, 5, 37, 1000}) {
    std::vector<Box> boxes;
    for (int i = 0; i < n; ++i) boxes.push_back(random_box(random, i % 10 == 0 ? 0.5 : 0.05));
    if (n == 37) boxes.assign(37, boxes.front());  // all boxes in one place
    const BoxTree tree(boxes);
    for (int k = 0; k < 50; ++k) {
      const Box query = random_box(random, 0.3);
      std::vector<std::uint32_t> expected;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (boxes_touch(boxes[i], query)) expected.push_back(static_cast<std::uint32_t>(i));
      }
      ASSERT_EQ(tree.touching(query), expected);
      ASSERT_EQ(tree.any_touching(query), !expected.empty());
    }
  }
}

}  // namespace
}  // namespace astrolith
