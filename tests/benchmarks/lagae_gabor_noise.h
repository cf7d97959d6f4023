// The peer of Gabor noise: sparse convolution evaluated point by point as Lagae et al. 2009 describe it
// ("Procedural noise using sparse Gabor convolution"). It has a grid of cells as wide as the radius of a
// kernel, a linear congruential generator and a Poisson number of impulses for each cell, and exp and cos of
// the standard library.
#pragma once

#include <cmath>
#include <cstdint>

namespace astrolith::testing {

class CellRandom {
 public:
  explicit CellRandom(std::uint32_t seed) : state_(seed * 2654435761u + 1u) {}
  float uniform() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<float>(state_) * 0x1p-32f;
  }
  int poisson(float mean) {
    const float limit = std::exp(-mean);
    int count = 0;
    for (float product = uniform(); product > limit; product *= uniform()) ++count;
    return count;
  }

 private:
  std::uint32_t state_;
};

// One band of kernels exp(-pi a^2 r^2) cos(2 pi (f.p) + phase), cut off at 5 % of their peak. On average
// `impulses` lie under one kernel: under its disc in the plane, within its ball on a surface.
class LagaeGaborNoise {
 public:
  LagaeGaborNoise(float a, float frequency_x, float frequency_y, float impulses)
      : a_(a), fx_(frequency_x), fy_(frequency_y), radius_(std::sqrt(2.99573227f / 3.14159265f) / a) {
    plane_density_ = impulses / 3.14159265f;                  // impulses per cell
    space_density_ = impulses / (4.0f / 3.0f * 3.14159265f);  // impulses per cell
  }

  float on_plane(float x, float y) const {
    const float cx = std::floor(x / radius_), cy = std::floor(y / radius_);
    const float fx = x / radius_ - cx, fy = y / radius_ - cy;
    float sum = 0.0f;
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        CellRandom random(seed_of(static_cast<int>(cx) + i, static_cast<int>(cy) + j, 0));
        const int count = random.poisson(plane_density_);
        for (int k = 0; k < count; ++k) {
          const float dx = fx - static_cast<float>(i) - random.uniform(),
                      dy = fy - static_cast<float>(j) - random.uniform();
          const float phase = random.uniform();
          if (dx * dx + dy * dy < 1.0f) sum += kernel(dx * radius_, dy * radius_, phase);
        }
      }
    }
    return sum;
  }

  // The noise at a point with tangent axes u and v. Impulses within the ball are projected onto the tangent
  // plane.
  float on_surface(const float p[3], const float u[3], const float v[3]) const {
    float cell[3], fraction[3];
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = std::floor(p[axis] / radius_);
      fraction[axis] = p[axis] / radius_ - cell[axis];
    }
    float sum = 0.0f;
    for (int c = 0; c < 27; ++c) {
      const int step[3] = {c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1};
      CellRandom random(seed_of(static_cast<int>(cell[0]) + step[0], static_cast<int>(cell[1]) + step[1],
                                static_cast<int>(cell[2]) + step[2]));
      const int count = random.poisson(space_density_);
      for (int k = 0; k < count; ++k) sum += projected_kernel(fraction, step, random, u, v);
    }
    return sum;
  }

 private:
  static std::uint32_t seed_of(int x, int y, int z) {
    return static_cast<std::uint32_t>(x) * 73856093u ^ static_cast<std::uint32_t>(y) * 19349663u ^
           static_cast<std::uint32_t>(z) * 83492791u;
  }
  float kernel(float x, float y, float phase) const {
    return std::exp(-3.14159265f * a_ * a_ * (x * x + y * y)) *
           std::cos(6.28318531f * (fx_ * x + fy_ * y + phase));
  }
  float projected_kernel(const float* fraction, const int* step, CellRandom& random, const float* u,
                         const float* v) const {
    float d[3], r2 = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      d[axis] = fraction[axis] - static_cast<float>(step[axis]) - random.uniform();
      r2 += d[axis] * d[axis];
    }
    const float phase = random.uniform();
    if (!(r2 < 1.0f)) return 0.0f;
    const float along_u = u[0] * d[0] + u[1] * d[1] + u[2] * d[2],
                along_v = v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
    return kernel(along_u * radius_, along_v * radius_, phase);
  }

  float a_, fx_, fy_, radius_, plane_density_, space_density_;
};

}  // namespace astrolith::testing
