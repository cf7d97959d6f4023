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

TEST(LengthUnit, IsKnownOrNot) {
  for (const char* unit : {"m", "km", "cm", "mm"}) EXPECT_TRUE(has_known_length(unit)) << unit;
  for (const char* unit : {"", "ft", "px", "body"}) EXPECT_FALSE(has_known_length(unit)) << unit;
}

}  // namespace
}  // namespace astrolith
