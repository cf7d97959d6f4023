#include "synthesis/field/local_weight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "numerics/errors.h"

namespace astrolith {
namespace {

// The spheres that may be nearest to some point of the box. Leaving out all other spheres changes no bit.
void nearest_candidates(const WeightSpheres& set, const ArrayView& arrays, const Box& box,
                        std::vector<WeightSphere>& out) {
  const double rounding = 2.0 * distance_rounding(set, box);
  const std::span<const WeightSphere> spheres = arrays.span(set.spheres);
  double least = std::numeric_limits<double>::infinity();
  thread_local std::vector<std::pair<double, std::uint32_t>> reached;  // least distances and numbers
  reached.clear();
  for_each_near_run(
      arrays[set.runs], set.runs.count, box, [&] { return least; },
      [&](const WeightRun& run) {
        for (std::uint32_t i = run.first; i < run.end; ++i) {
          const Interval d = sphere_distances(spheres[i], box);
          least = std::min(least, d.high + rounding);
          if (d.low <= least) reached.emplace_back(d.low, i);
        }
      });
  out.clear();
  for (const auto& [low, number] : reached) {
    if (low <= least) out.push_back(spheres[number]);
  }
}

// Halves spheres along the longest side of the box of their centres, again and again, until runs of at most
// `most` spheres are left.
void split_into_runs(std::span<WeightSphere> spheres, std::uint32_t first, std::size_t most,
                     std::vector<WeightRun>& runs) {
  WeightRun run{{}, 0.0, first, first + static_cast<std::uint32_t>(spheres.size())};
  for (const WeightSphere& s : spheres) {
    run.centers.extend({double{s.center.x}, double{s.center.y}, double{s.center.z}});
    run.largest_radius = std::max(run.largest_radius, double{s.radius});
  }
  if (spheres.size() <= most) return runs.push_back(run);
  float Vec3f::*const axis = longest_axis<float>(run.centers.extent());
  std::stable_sort(spheres.begin(), spheres.end(), [axis](const WeightSphere& a, const WeightSphere& b) {
    return a.center.*axis < b.center.*axis;
  });
  const std::size_t half = spheres.size() / 2;
  split_into_runs(spheres.first(half), first, most, runs);
  split_into_runs(spheres.subspan(half), first + static_cast<std::uint32_t>(half), most, runs);
}

WeightSpheres make_set(std::vector<WeightSphere> spheres, ArrayStore& arrays) {
  WeightSpheres set;
  for (const WeightSphere& s : spheres) {
    const Vec3d center{double{s.center.x}, double{s.center.y}, double{s.center.z}};
    set.farthest = std::max(set.farthest, norm(center) + double{s.radius});
  }
  std::vector<WeightRun> runs;
  const auto most = static_cast<std::size_t>(std::ceil(std::sqrt(double(spheres.size()))));
  if (!spheres.empty()) split_into_runs(spheres, 0, std::max<std::size_t>(most, 4), runs);
  set.spheres = arrays.add(spheres);
  set.runs = arrays.add(runs);
  return set;
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
  const WeightSpheres group_set = make_set(std::move(members), arrays);
  return {group_set, make_set(std::move(others), arrays), static_cast<float>(1.0 / locality.width)};
}

void multiply_by_weight(const LocalWeight& weight, const ArrayView& arrays, int n, const float* x,
                        const float* y, const float* z, float* height) {
  if (weight.others.spheres.count == 0) return;
  thread_local std::vector<WeightSphere> candidates;
  constexpr int kChunk = 256;
  std::array<float, kChunk> group, others;
  for (int begin = 0; begin < n; begin += kChunk) {
    const int size = std::min(kChunk, n - begin);
    const float *px = x + begin, *py = y + begin, *pz = z + begin;
    Box box;
    for (int i = 0; i < size; ++i) box.extend({double{px[i]}, double{py[i]}, double{pz[i]}});
    for (const bool to_group : {true, false}) {
      std::array<float, kChunk>& distance = to_group ? group : others;
      distance.fill(std::numeric_limits<float>::max());
      nearest_candidates(to_group ? weight.group : weight.others, arrays, box, candidates);
      for (const WeightSphere& s : candidates) {
        take_nearer(s.center, s.radius, size, px, py, pz, distance.data());
      }
    }
    multiply_weights(group.data(), others.data(), weight.inverse_width, size, height + begin);
  }
}

}  // namespace astrolith
