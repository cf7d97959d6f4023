#include "numerics/length_unit.h"

#include <gtest/gtest.h>

namespace astrolith {
namespace {

TEST(LengthUnit, HasMetres) {
  EXPECT_EQ(metres_of("km"), 1e3);
  EXPECT_EQ(metres_of("m"), 1.0);
  EXPECT_EQ(metres_of("cm"), 1e-2);
  EXPECT_EQ(metres_of("mm"), 1e-3);
  EXPECT_EQ(metres_of("px"), 1.0);
}

}  // namespace
}  // namespace astrolith
