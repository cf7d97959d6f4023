#include "synthesis/field/local_weight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "numerics/errors.h"

namespace astrolith {
namespace {

constexpr int kWeightChunk = 256;
using Chunk = std::array<float, kWeightChunk>;

// The spheres that may be nearest to some point of the box. Leaving out all other spheres changes no bit.
void nearest_candidates(std::span<const WeightSphere> spheres, const Box& box,
                        std::vector<WeightSphere>& out) {
  double least = std::numeric_limits<double>::infinity();
  for (const WeightSphere& s : spheres) {
    least = std::min(least, sphere_distances(s, box).high + distance_rounding(s, box));
  }
  out.clear();
  for (const WeightSphere& s : spheres) {
    if (sphere_distances(s, box).low - distance_rounding(s, box) <= least) out.push_back(s);
  }
}

ASTROLITH_SIMD_CLONES void take_nearer(Vec3f center, float radius, int n, const float* __restrict x,
                                       const float* __restrict y, const float* __restrict z,
                                       float* __restrict distance) {
#pragma omp simd
  for (int i = 0; i < n; ++i) distance[i] = nearer_sphere(center, radius, x[i], y[i], z[i], distance[i]);
}

ASTROLITH_SIMD_CLONES void multiply_weights(const float* __restrict group, const float* __restrict others,
                                            float inverse_width, int n, float* __restrict height) {
#pragma omp simd
  for (int i = 0; i < n; ++i) height[i] *= local_weight(group[i], others[i], inverse_width);
}

}  // namespace

LocalWeight make_local_weight(const Locality& locality, const MetaballBody& body, const std::string& layer,
                              ArrayStore& arrays) {
  const SphereGroup* group = body.find_group(locality.group);
  if (group == nullptr) {
    throw InputError(layer + ": locality.group: the body has no group \"" + locality.group +
                     "\"; name one of body.groups");
  }
  std::vector<bool> in_group(body.spheres.size());
  for (const int i : group->spheres) in_group[static_cast<std::size_t>(i)] = true;
  std::vector<WeightSphere> members, others;
  for (std::size_t i = 0; i < body.spheres.size(); ++i) {
    const Sphere& s = body.spheres[i];
    (in_group[i] ? members : others).push_back({to_float(s.center), static_cast<float>(s.radius)});
  }
  return {arrays.add(members), arrays.add(others), static_cast<float>(1.0 / locality.width)};
}

void multiply_by_weight(const LocalWeight& weight, const ArrayView& arrays, int n, const float* x,
                        const float* y, const float* z, float* height) {
  if (weight.others.count == 0) return;
  thread_local std::vector<WeightSphere> candidates;
  Chunk group, others;
  for (int begin = 0; begin < n; begin += kWeightChunk) {
    const int size = std::min(kWeightChunk, n - begin);
    const float *px = x + begin, *py = y + begin, *pz = z + begin;
    Box box;
    for (int i = 0; i < size; ++i) box.extend({double{px[i]}, double{py[i]}, double{pz[i]}});
    for (const bool of_group : {true, false}) {
      Chunk& distance = of_group ? group : others;
      distance.fill(std::numeric_limits<float>::max());
      nearest_candidates(arrays.span(of_group ? weight.group : weight.others), box, candidates);
      for (const WeightSphere& s : candidates) {
        take_nearer(s.center, s.radius, size, px, py, pz, distance.data());
      }
    }
    multiply_weights(group.data(), others.data(), weight.inverse_width, size, height + begin);
  }
}

}  // namespace astrolith
