#include "estimation/shape/relief/relief_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/parallel_for.h"
#include "synthesis/body/ground_points.h"
#include "synthesis/relief/relief_shares.h"

namespace astrolith {
namespace {

constexpr int kGroup = 512;  // samples that share the metaballs that reach them

// Samples follow the facets, so that those of a group lie close together.
std::vector<Vec3d> sample_points(const TriangleMesh& surface) {
  std::vector<Vec3d> points;
  points.reserve(5 * surface.triangles.size());
  std::vector<bool> used(surface.vertices.size(), false);
  for (const auto& [i, j, k] : surface.triangles) {
    const Vec3d &a = surface.vertices[i], &b = surface.vertices[j], &c = surface.vertices[k];
    for (const std::uint32_t corner : {i, j, k}) {
      if (!used[corner]) points.push_back(surface.vertices[corner]);
      used[corner] = true;
    }
    const Vec3d middle = (a + b + c) * (1.0 / 3.0);
    points.push_back(middle);
    for (const Vec3d& corner : {a, b, c}) points.push_back(0.5 * (middle + corner));
  }
  return points;
}

// The samples of one group of points.
ReliefSamples samples_of(const std::vector<Vec3d>& points, const BodyGround& ground,
                         const ReliefShares& shares, float most_missed) {
  GroundPoints v(points);
  evaluate(ground, v);
  project(ground, v);
  GroundPoints foot = v;
  evaluate(ground, foot);
  ReliefSamples samples;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(std::abs(foot.distance[i]) <= most_missed)) continue;
    const std::size_t before = samples.shares.size();
    shares.add(v.at(i), samples.places, samples.shares);
    if (samples.shares.size() == before) continue;
    samples.height.push_back(-v.distance[i]);
    samples.first.push_back(static_cast<std::uint32_t>(samples.shares.size()));
  }
  return samples;
}

void append(const ReliefSamples& group, ReliefSamples& all) {
  const std::uint32_t before = all.first.back();
  all.height.insert(all.height.end(), group.height.begin(), group.height.end());
  all.places.insert(all.places.end(), group.places.begin(), group.places.end());
  all.shares.insert(all.shares.end(), group.shares.begin(), group.shares.end());
  for (std::size_t i = 1; i < group.first.size(); ++i) all.first.push_back(before + group.first[i]);
}

}  // namespace

ReliefEquations relief_equations(const TriangleMesh& surface, const Recipe& recipe, double spacing) {
  ArrayStore arrays;
  const BodyTables body = make_body(*recipe.body, recipe.seed, arrays);
  const ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
  const BodyGround ground{body, arrays.view(), metaballs.lists()};
  ReliefEquations equations{find_relief_places(ground, spacing, "relief"), {}};
  const ReliefShares shares(equations.places, spacing);
  const std::vector<Vec3d> points = sample_points(surface);
  const std::size_t num_groups = (points.size() + kGroup - 1) / kGroup;
  std::vector<ReliefSamples> groups(num_groups);
  parallel_for(0, static_cast<std::int64_t>(num_groups), [&](std::int64_t g) {
    const std::size_t first = static_cast<std::size_t>(g) * kGroup,
                      count = std::min<std::size_t>(kGroup, points.size() - first);
    groups[static_cast<std::size_t>(g)] =
        samples_of({points.begin() + static_cast<std::ptrdiff_t>(first),
                    points.begin() + static_cast<std::ptrdiff_t>(first + count)},
                   ground, shares, static_cast<float>(0.25 * spacing));
  });
  for (const ReliefSamples& group : groups) append(group, equations.samples);
  return equations;
}

}  // namespace astrolith
