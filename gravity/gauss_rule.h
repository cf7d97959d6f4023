// Gauss' rules on an interval and on a triangle.
#pragma once

#include <vector>

namespace astrolith {

struct TrianglePoint {
  double b, c, weight;  // the point a + b (B - a) + c (C - a) of a triangle a, B, C; the weights sum to one
};

// A rule that is exact for polynomials of this degree on a triangle, degree in [0, 100].
std::vector<TrianglePoint> triangle_rule(int degree);

}  // namespace astrolith
