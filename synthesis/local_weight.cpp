#include "synthesis/local_weight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "numerics/errors.h"
#include "numerics/scalar_math.h"
#include "synthesis/largest_coordinate.h"

namespace astrolith {
namespace {

constexpr int kChunk = 256;
using Chunk = std::array<float, kChunk>;

// Of the distances from a sphere's surface to the points of a box.
Interval distances(const Sphere& s, const Box& box) {
  const auto near = [](double c, double low, double high) { return std::max({low - c, c - high, 0.0}); };
  const auto far = [](double c, double low, double high) {
    return std::max(std::fabs(c - low), std::fabs(c - high));
  };
  const Vec3d &a = box.min, &b = box.max, &c = s.center;
  return {norm(Vec3d{near(c.x, a.x, b.x), near(c.y, a.y, b.y), near(c.z, a.z, b.z)}) - s.radius,
          norm(Vec3d{far(c.x, a.x, b.x), far(c.y, a.y, b.y), far(c.z, a.z, b.z)}) - s.radius};
}

// Of the distance to the nearest of some spheres; nothing is nearest of none.
Interval least_distance(const std::vector<Sphere>& spheres, const Box& box) {
  Interval least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const Sphere& s : spheres) {
    const Interval d = distances(s, box);
    least = {std::min(least.low, d.low), std::min(least.high, d.high)};
  }
  return least;
}

// How far a distance in float may be from the exact one.
double rounding_of(const Sphere& s, const Box& box) {
  return 2e-6 * (largest_coordinate(box) + norm(s.center) + s.radius);
}

// The spheres that may be the nearest of all to a point of the box. Leaving out the others changes no bit.
void nearest_candidates(const std::vector<Sphere>& spheres, const Box& box, std::vector<Sphere>& out) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& s : spheres) least = std::min(least, distances(s, box).high + rounding_of(s, box));
  out.clear();
  for (const Sphere& s : spheres) {
    if (distances(s, box).low - rounding_of(s, box) <= least) out.push_back(s);
  }
}

Vec3f single(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

ASTROLITH_SIMD_CLONES void take_nearer(Vec3f center, float radius, int n, const float* __restrict x,
                                       const float* __restrict y, const float* __restrict z,
                                       float* __restrict distance) {
#pragma omp simd
  for (int i = 0; i < n; ++i) distance[i] = nearer_sphere(center, radius, x[i], y[i], z[i], distance[i]);
}

ASTROLITH_SIMD_CLONES void multiply_weights(const float* __restrict near, const float* __restrict others,
                                            float inverse_width, int n, float* __restrict height) {
#pragma omp simd
  for (int i = 0; i < n; ++i) height[i] *= local_weight(near[i], others[i], inverse_width);
}

double weight_at(double difference, double width) {
  return 0.5 - std::atan(difference / width) / 3.14159265358979323846;
}

}  // namespace

LocalWeight::LocalWeight(const Locality& locality, const MetaballBody& body, const std::string& layer)
    : inverse_width_(static_cast<float>(1.0 / locality.width)) {
  const SphereGroup* group = body.find_group(locality.group);
  if (group == nullptr) {
    throw InputError(layer + ": locality.group: the body has no group \"" + locality.group +
                     "\"; name one of body.groups");
  }
  std::vector<bool> in_group(body.spheres.size());
  for (const int i : group->spheres) in_group[static_cast<std::size_t>(i)] = true;
  for (std::size_t i = 0; i < body.spheres.size(); ++i) {
    (in_group[i] ? near_ : others_).push_back(body.spheres[i]);
  }
}

void LocalWeight::multiply(int n, const float* x, const float* y, const float* z, float* height) const {
  if (others_.empty()) return;
  thread_local std::vector<Sphere> candidates;
  Chunk near, others;
  for (int begin = 0; begin < n; begin += kChunk) {
    const int size = std::min(kChunk, n - begin);
    const float *px = x + begin, *py = y + begin, *pz = z + begin;
    Box box;
    for (int i = 0; i < size; ++i) box.extend({double{px[i]}, double{py[i]}, double{pz[i]}});
    for (const bool of_group : {true, false}) {
      Chunk& distance = of_group ? near : others;
      distance.fill(std::numeric_limits<float>::max());
      nearest_candidates(of_group ? near_ : others_, box, candidates);
      for (const Sphere& s : candidates) {
        take_nearer(single(s.center), static_cast<float>(s.radius), size, px, py, pz, distance.data());
      }
    }
    multiply_weights(near.data(), others.data(), inverse_width_, size, height + begin);
  }
}

Interval LocalWeight::bound(const Box& box) const {
  if (others_.empty()) return {1.0, 1.0};
  double rounding = 0.0;
  for (const std::vector<Sphere>* spheres : {&near_, &others_}) {
    for (const Sphere& s : *spheres) rounding = std::max(rounding, rounding_of(s, box));
  }
  const Interval d = least_distance(near_, box), e = least_distance(others_, box);
  const double width = 1.0 / static_cast<double>(inverse_width_);
  return {std::max(0.0, weight_at(d.high - e.low + 2.0 * rounding, width) - 1e-6),
          std::min(1.0, weight_at(d.low - e.high - 2.0 * rounding, width) + 1e-6)};
}

}  // namespace astrolith
