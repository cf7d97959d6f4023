// Random places at which tests sample noises.
#pragma once

#include <cmath>

#include "numerics/hash_random.h"
#include "numerics/vec3.h"

namespace astrolith::testing {

inline Vec3f random_place(CounterRandom& random, double reach) {
  const auto coordinate = [&] { return static_cast<float>(random.uniform(-reach, reach)); };
  const float x = coordinate(), y = coordinate(), z = coordinate();
  return {x, y, z};
}

struct NoiseStatistics {
  double mean = 0.0, deviation = 0.0, least = 1e300, greatest = -1e300;
};

// The mean, standard deviation and extremes of n values at independent places within 300 cells of the origin.
template <typename Noise>
NoiseStatistics noise_statistics(const Noise& noise, int n) {
  CounterRandom random(1);
  NoiseStatistics s;
  double squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const Vec3f p = random_place(random, 300.0);
    const double v = static_cast<double>(noise(p.x, p.y, p.z, 42u));
    s.mean += v / n;
    squares += v * v / n;
    s.least = std::fmin(s.least, v);
    s.greatest = std::fmax(s.greatest, v);
  }
  s.deviation = std::sqrt(squares - s.mean * s.mean);
  return s;
}

// The largest difference between the gradient that a noise states and the gradient of its values.
template <typename Sampler>
double gradient_error(const Sampler& sampler, int n) {
  CounterRandom random(5);
  constexpr float h = 1.0f / 256;
  double error = 0.0;
  for (int i = 0; i < n; ++i) {
    const Vec3f p = random_place(random, 8.0);
    const Vec3f g = sampler(p.x, p.y, p.z, 7u).gradient;
    const auto slope = [&](float dx, float dy, float dz) {
      const float after = sampler(p.x + dx, p.y + dy, p.z + dz, 7u).value;
      const float before = sampler(p.x - dx, p.y - dy, p.z - dz, 7u).value;
      return static_cast<double>((after - before) / (2.0f * h));
    };
    error = std::fmax(error, std::fabs(slope(h, 0, 0) - static_cast<double>(g.x)));
    error = std::fmax(error, std::fabs(slope(0, h, 0) - static_cast<double>(g.y)));
    error = std::fmax(error, std::fabs(slope(0, 0, h) - static_cast<double>(g.z)));
  }
  return error;
}

}  // namespace astrolith::testing
