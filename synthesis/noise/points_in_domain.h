// Copies of points, moved into the domain within which float coordinates resolve the cells of a noise.
#pragma once

#include <vector>

#include "numerics/interval.h"

namespace astrolith {

// Points moved into the box low .. high, stored as three arrays of n floats.
class PointsInDomain {
 public:
  PointsInDomain(const Vec3f& low, const Vec3f& high, int n, const float* x, const float* y, const float* z)
      : size_(n), coordinates_(static_cast<std::size_t>(3 * n)) {
    float *px = coordinates_.data(), *py = px + n, *pz = py + n;
    for (int i = 0; i < n; ++i) {
      px[i] = math::clamp(x[i], low.x, high.x);
      py[i] = math::clamp(y[i], low.y, high.y);
      pz[i] = math::clamp(z[i], low.z, high.z);
    }
  }

  const float* x() const { return coordinates_.data(); }
  const float* y() const { return x() + size_; }
  const float* z() const { return y() + size_; }
  // The bounding box of the moved points.
  Box box() const {
    Box box;
    for (int i = 0; i < size_; ++i) box.extend({x()[i], y()[i], z()[i]});
    return box;
  }

 private:
  int size_;
  std::vector<float> coordinates_;
};

}  // namespace astrolith
