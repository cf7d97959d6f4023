#include "numerics/tangent_frame.h"

#include <gtest/gtest.h>

#include "tests/support/points.h"

namespace astrolith {
namespace {

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

}  // namespace
}  // namespace astrolith
