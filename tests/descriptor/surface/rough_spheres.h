// Unit spheres with heights of known kinds, and a flat sheet of waves.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/meshes.h"
#include "tests/support/points.h"

namespace astrolith::testing {

// Homogeneous, nearly Gaussian heights of rms 1: 60 plane waves with lengths of `wave` to 2 `wave`.
class WaveHeights {
 public:
  WaveHeights(double wave, std::uint64_t seed) {
    for (std::uint64_t k = 0; k < kWaves; ++k) {
      CounterRandom random(seed, k);
      const double length = wave * (1 + random.uniform());
      waves_.push_back({2 * std::numbers::pi / length * random_direction(random), 7 * random.uniform()});
    }
  }
  double operator()(const Vec3d& p) const {
    double sum = 0;
    for (const auto& [vector, phase] : waves_) sum += std::cos(dot(vector, p) + phase);
    return sum * std::sqrt(2.0 / kWaves);
  }

 private:
  static constexpr int kWaves = 60;
  struct Wave {
    Vec3d vector;
    double phase;
  };
  std::vector<Wave> waves_;
};

// Sum of Gaussian bumps of height 1 and one size at random places of the unit sphere.
class BumpHeights {
 public:
  BumpHeights(int count, double size, std::uint64_t seed) : size_(size) {
    for (int k = 0; k < count; ++k) {
      CounterRandom random(seed, static_cast<std::uint64_t>(k));
      centers_.push_back(random_direction(random));
    }
  }
  double operator()(const Vec3d& p) const {
    double sum = 0;
    for (const Vec3d& c : centers_) sum += std::exp(-squared_norm(p - c) / (2 * size_ * size_));
    return sum;
  }

 private:
  double size_;
  std::vector<Vec3d> centers_;
};

// A unit sphere of 20 * 4^levels triangles, each vertex moved outwards by its height.
template <int levels = 5, typename Heights>
TriangleMesh rough_sphere(const Heights& height) {
  static const TriangleMesh sphere = icosphere(levels);
  TriangleMesh mesh = sphere;
  for (Vec3d& p : mesh.vertices) p *= 1 + height(p);
  return mesh;
}

// An open sheet of side x side squares of length 1, with heights z(x, y).
template <typename Heights>
TriangleMesh sheet(int side, const Heights& height) {
  TriangleMesh mesh;
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x <= side; ++x) mesh.vertices.push_back({1.0 * x, 1.0 * y, height(1.0 * x, 1.0 * y)});
  }
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto at = static_cast<std::uint32_t>(y * (side + 1) + x),
                 above = at + static_cast<std::uint32_t>(side) + 1;
      mesh.triangles.push_back({at, at + 1, above + 1});
      mesh.triangles.push_back({at, above + 1, above});
    }
  }
  return mesh;
}

inline double mean_value(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

}  // namespace astrolith::testing
