#include "estimation/shape/relief/relief_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/parallel_for.h"
#include "synthesis/body/surface_projection.h"
#include "synthesis/relief/relief_tiles.h"

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

// The body at points, evaluated as the synthesis does it.
class BaseField {
 public:
  BaseField(const BodyGround& ground) : ground_(ground) {}

  struct Values {
    std::vector<float> x, y, z, distance, gx, gy, gz;
    explicit Values(std::size_t n) : x(n), y(n), z(n), distance(n), gx(n), gy(n), gz(n) {}
  };
  void evaluate(Values& v) const {
    Box box;
    for (std::size_t i = 0; i < v.x.size(); ++i) box.extend({v.x[i], v.y[i], v.z[i]});
    const ReachingMetaballs reaching =
        metaballs_reaching(ground_.body, ground_.arrays, ground_.metaballs, box);
    evaluate_body(ground_.body, ground_.arrays, reaching.lists(), static_cast<int>(v.x.size()), v.x.data(),
                  v.y.data(), v.z.data(), v.distance.data(), v.gx.data(), v.gy.data(), v.gz.data());
  }
  // Moves the points to their projections on the bare surface. Their distances stay.
  void project(Values& v) const {
    const BodyLeaf& leaf = ground_.arrays[ground_.body.leaves][0];
    for (std::size_t i = 0; i < v.x.size(); ++i) {
      const float length = gradient_length(v.gx[i], v.gy[i], v.gz[i], leaf.metaballs.gradient_floor);
      const auto along = [&](float p, float g) {
        return projected_coordinate(p, g, length, v.distance[i], std::numeric_limits<float>::max());
      };
      v.x[i] = along(v.x[i], v.gx[i]);
      v.y[i] = along(v.y[i], v.gy[i]);
      v.z[i] = along(v.z[i], v.gz[i]);
    }
  }

 private:
  BodyGround ground_;
};

// What a point takes from the places around it: shares that sum to 1, as height_at() (relief_noise.h) blends
// them.
class ReliefShares {
 public:
  ReliefShares(const std::vector<ReliefPlace>& places, double spacing)
      : places_(places), tiles_(make_relief_tiles(places, "relief")), inverse_spacing_(1.0 / spacing) {}

  void add(const Vec3f& p, std::vector<std::uint32_t>& places, std::vector<float>& shares) const {
    const std::array<double, 3> at{p.x * inverse_spacing_, p.y * inverse_spacing_, p.z * inverse_spacing_};
    std::array<std::int64_t, 3> cell;
    std::array<double, 3> local;
    for (std::size_t a = 0; a < 3; ++a) {
      const double number = std::floor(at[a] / kReliefCell);
      cell[a] = static_cast<std::int64_t>(number) - tiles_.low[a];
      if (cell[a] < 0 || cell[a] >= tiles_.count[a]) return;
      local[a] = at[a] - number * kReliefCell;
    }
    const std::int64_t slot = 3 * (cell[0] + tiles_.count[0] * (cell[1] + tiles_.count[1] * cell[2]));
    const std::size_t begin = shares.size();
    double total = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double u = local[(a + 1) % 3], v = local[(a + 2) % 3], w = local[a];
      std::int32_t tile = tiles_.tiles[static_cast<std::size_t>(slot) + a];
      if (tile < 0) {
        const ReliefSplit& s = tiles_.splits[static_cast<std::size_t>(-1 - tile)];
        tile = w > s.at + s.of_u * u + s.of_v * v ? s.upper : s.lower;
      }
      if (tile != 0) total += add_tile(static_cast<std::size_t>(tile), u, v, places, shares);
    }
    if (!(total > 0.0)) {
      places.resize(begin), shares.resize(begin);
      return;
    }
    for (std::size_t i = begin; i < shares.size(); ++i) shares[i] = static_cast<float>(shares[i] / total);
  }

 private:
  static std::array<double, 4> spline(double t) {
    const double s = 1.0 - t;
    return {s * s * s / 6.0, 2.0 / 3.0 + t * t * (0.5 * t - 1.0), 2.0 / 3.0 + s * s * (0.5 * s - 1.0),
            t * t * t / 6.0};
  }
  double add_tile(std::size_t tile, double u, double v, std::vector<std::uint32_t>& places,
                  std::vector<float>& shares) const {
    const int i = std::min(static_cast<int>(u), kReliefCell - 1),
              j = std::min(static_cast<int>(v), kReliefCell - 1);
    const std::array<double, 4> wu = spline(u - i), wv = spline(v - j);
    double total = 0.0;
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t column = 0; column < 4; ++column) {
        const std::size_t at =
            (static_cast<std::size_t>(j) + row) * kReliefTileSide + static_cast<std::size_t>(i) + column;
        const std::uint32_t number = tiles_.places[tile * kReliefTileSize + at];
        if (number == kNoPlace) continue;
        const double share = wu[column] * wv[row] * places_[number].weight;
        places.push_back(number);
        shares.push_back(static_cast<float>(share));
        total += share;
      }
    }
    return total;
  }

  const std::vector<ReliefPlace>& places_;
  ReliefTiles tiles_;
  double inverse_spacing_;
};

// The samples of one group of points.
ReliefSamples samples_of(std::span<const Vec3d> points, const BaseField& base, const ReliefShares& shares,
                         float most_missed) {
  BaseField::Values v(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    v.x[i] = static_cast<float>(points[i].x);
    v.y[i] = static_cast<float>(points[i].y);
    v.z[i] = static_cast<float>(points[i].z);
  }
  base.evaluate(v);
  base.project(v);
  BaseField::Values foot = v;
  base.evaluate(foot);
  ReliefSamples samples;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(std::abs(foot.distance[i]) <= most_missed)) continue;
    const std::size_t before = samples.shares.size();
    shares.add({v.x[i], v.y[i], v.z[i]}, samples.places, samples.shares);
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
  const BaseField base(ground);
  const std::vector<Vec3d> points = sample_points(surface);
  const std::size_t num_groups = (points.size() + kGroup - 1) / kGroup;
  std::vector<ReliefSamples> groups(num_groups);
  parallel_for(0, static_cast<std::int64_t>(num_groups), [&](std::int64_t g) {
    const std::size_t first = static_cast<std::size_t>(g) * kGroup,
                      count = std::min<std::size_t>(kGroup, points.size() - first);
    groups[static_cast<std::size_t>(g)] =
        samples_of(std::span(points).subspan(first, count), base, shares, static_cast<float>(0.25 * spacing));
  });
  for (const ReliefSamples& group : groups) append(group, equations.samples);
  return equations;
}

}  // namespace astrolith
