#include "estimation/shape/relief/relief_blend.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/mesh_measure.h"
#include "numerics/parallel_for.h"
#include "synthesis/body/ground_points.h"
#include "synthesis/relief/relief_noise.h"

namespace astrolith {
namespace {

constexpr std::size_t kGroup = 512;  // points that share the metaballs that reach them

// A sample, and what it is sorted by.
struct PlacedSample {
  std::uint32_t cell;
  std::array<std::int32_t, 3> tiles;
  ReliefSample sample;
};

// Points of the surface in groups of neighbours: of vertices, then of facets, where these are not small.
class SurfacePoints {
 public:
  SurfacePoints(const TriangleMesh& surface, double spacing)
      : surface_(surface),
        used_(surface.vertices.size(), 0),
        vertex_groups_(groups(surface.vertices.size())),
        facet_groups_(kSmallEdges * spacing < mean_edge(surface) ? groups(4 * surface.triangles.size()) : 0) {
    for (const Triangle& t : surface.triangles) {
      for (const std::uint32_t corner : t) used_[corner] = 1;
    }
  }

  std::size_t count() const { return vertex_groups_ + facet_groups_; }
  std::vector<Vec3d> group(std::size_t number) const {
    return number < vertex_groups_ ? vertices(number * kGroup)
                                   : on_facets((number - vertex_groups_) * (kGroup / 4));
  }

 private:
  static constexpr double kSmallEdges = 0.17;  // spacings

  static std::size_t groups(std::size_t points) { return (points + kGroup - 1) / kGroup; }
  std::vector<Vec3d> vertices(std::size_t first) const {
    std::vector<Vec3d> points;
    for (std::size_t i = first; i < std::min(first + kGroup, used_.size()); ++i) {
      if (used_[i] != 0) points.push_back(surface_.vertices[i]);
    }
    return points;
  }
  std::vector<Vec3d> on_facets(std::size_t first) const {
    std::vector<Vec3d> points;
    for (std::size_t t = first; t < std::min(first + kGroup / 4, surface_.triangles.size()); ++t) {
      const auto& [i, j, k] = surface_.triangles[t];
      const Vec3d &a = surface_.vertices[i], &b = surface_.vertices[j], &c = surface_.vertices[k];
      const Vec3d middle = (a + b + c) * (1.0 / 3.0);
      points.push_back(middle);
      for (const Vec3d& corner : {a, b, c}) points.push_back(0.5 * (middle + corner));
    }
    return points;
  }

  const TriangleMesh& surface_;
  std::vector<char> used_;
  std::size_t vertex_groups_, facet_groups_;
};

class SampleFinder {
 public:
  SampleFinder(const BodyGround& ground, const ReliefSamples& made, double spacing)
      : ground_(ground), made_(made), spacing_(spacing) {}

  std::vector<PlacedSample> find_samples(const std::vector<Vec3d>& points) const {
    std::vector<PlacedSample> samples;
    if (points.empty()) return samples;
    samples.reserve(points.size());
    GroundPoints v(points);
    evaluate(ground_, v);
    project(ground_, v);
    GroundPoints foot = v;
    evaluate(ground_, foot);
    const double inverse = 1.0 / spacing_;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!(std::abs(foot.distance[i]) <= static_cast<float>(0.25 * spacing_))) continue;
      TiledPoint point;
      if (!find_in_tiles(made_.tiles, {v.x[i] * inverse, v.y[i] * inverse, v.z[i] * inverse}, point))
        continue;
      PlacedSample placed{static_cast<std::uint32_t>(point.cell), point.tiles, {}};
      for (std::size_t a = 0; a < 3; ++a) placed.sample.at[a] = static_cast<float>(point.at[a]);
      placed.sample.height = -v.distance[i];
      const float total = weight_around(made_.weights.data(), placed.tiles, placed.sample.at);
      if (!(total > 0.0f)) continue;
      placed.sample.scale = 1.0f / std::max(total, kLeastReliefWeight);
      samples.push_back(placed);
    }
    return samples;
  }

 private:
  const BodyGround& ground_;
  const ReliefSamples& made_;
  double spacing_;
};

// Sorts samples by cells, which a number each counts, then by their tiles and places.
std::vector<PlacedSample> sorted(std::vector<std::vector<PlacedSample>>& groups, std::size_t num_cells) {
  std::vector<std::uint32_t> first(num_cells + 1, 0);
  for (const std::vector<PlacedSample>& group : groups) {
    for (const PlacedSample& s : group) ++first[s.cell + 1];
  }
  for (std::size_t i = 0; i < num_cells; ++i) first[i + 1] += first[i];
  std::vector<PlacedSample> all(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::vector<PlacedSample>& group : groups) {
    for (const PlacedSample& s : group) all[next[s.cell]++] = s;
    std::vector<PlacedSample>().swap(group);
  }
  parallel_for(
      0, static_cast<std::int64_t>(num_cells),
      [&](std::int64_t number) {
        const auto i = static_cast<std::size_t>(number);
        std::stable_sort(all.begin() + first[i], all.begin() + first[i + 1],
                         [](const PlacedSample& a, const PlacedSample& b) {
                           return std::tuple(a.tiles, square_index(a.sample.at)) <
                                  std::tuple(b.tiles, square_index(b.sample.at));
                         });
      },
      4096);
  return all;
}

}  // namespace

ReliefSamples relief_samples(const TriangleMesh& surface, const Recipe& recipe, double spacing,
                             const Progress& progress) {
  ArrayStore arrays;
  const BodyTables body = make_body(*recipe.body, recipe.seed, arrays);
  const ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
  const BodyGround ground{body, arrays.view(), metaballs.lists()};
  ReliefSamples made;
  made.places = find_relief_places(ground, spacing, "relief");
  made.tiles = make_relief_tiles(made.places, "relief");
  made.weights.resize(made.tiles.places.size());
  for (std::size_t i = 0; i < made.weights.size(); ++i) {
    const std::uint32_t place = made.tiles.places[i];
    made.weights[i] = place == kNoPlace ? 0.0f : made.places[place].weight;
  }

  const SurfacePoints points(surface, spacing);
  const SampleFinder finder(ground, made, spacing);
  std::vector<std::vector<PlacedSample>> groups(points.count());
  std::vector<std::size_t> asked(groups.size());
  constexpr std::size_t kTogether = 256;  // groups between two reports
  for (std::size_t first = 0; first < groups.size(); first += kTogether) {
    if (!report(progress, static_cast<double>(first) / static_cast<double>(groups.size()), "samples"))
      return {};
    parallel_for(static_cast<std::int64_t>(first),
                 static_cast<std::int64_t>(std::min(first + kTogether, groups.size())),
                 [&](std::int64_t number) {
                   const auto g = static_cast<std::size_t>(number);
                   const std::vector<Vec3d> group_points = points.group(g);
                   groups[g] = finder.find_samples(group_points);
                   asked[g] = group_points.size() - groups[g].size();
                 });
  }
  for (const std::size_t left_out : asked) made.left_out += left_out;

  const std::vector<PlacedSample> placed = sorted(groups, made.tiles.tiles.size() / 3);
  made.samples.reserve(placed.size());
  std::uint32_t cell = 0xffffffffu;
  for (const PlacedSample& s : placed) {
    const auto number = static_cast<std::uint32_t>(made.samples.size());
    const bool new_cell = s.cell != cell;
    if (new_cell) made.cell_first_run.push_back(static_cast<std::uint32_t>(made.runs.size()));
    if (new_cell || s.tiles != made.runs.back().tiles) made.runs.push_back({s.tiles, number, number});
    cell = s.cell;
    made.samples.push_back(s.sample);
    made.runs.back().end = number + 1;
  }
  made.cell_first_run.push_back(static_cast<std::uint32_t>(made.runs.size()));
  return made;
}

}  // namespace astrolith
