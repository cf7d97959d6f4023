#include "numerics/vec3.h"

#include <gtest/gtest.h>

namespace astrolith {
namespace {

TEST(Vec3, TheLongestAxisIsTheFirstOfEqualOnes) {
  EXPECT_EQ(longest_axis({2.0, 1.0, 2.0}), &Vec3d::x);
  EXPECT_EQ(longest_axis({1.0, 2.0, 2.0}), &Vec3d::y);
  EXPECT_EQ(longest_axis<float>({1.0, 2.0, 3.0}), &Vec3f::z);
}

}  // namespace
}  // namespace astrolith
