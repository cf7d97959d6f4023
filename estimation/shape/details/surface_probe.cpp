#include "estimation/shape/details/surface_probe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimation/shape/model/model_evaluation_internal.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/tangent_frame.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kMostTriangles = 50000.0;
constexpr double kFirstLag = 2.0;  // edges
constexpr double kLagRatio = std::numbers::sqrt2;
constexpr std::size_t kFewestLags = 3;
constexpr double kLongestLag = 0.08;  // fraction of the diagonal; longer tangents leave a curved body

double mean_edge_length(double triangle_area) { return std::sqrt(4.0 / std::sqrt(3.0) * triangle_area); }

Vec3d tangent(const Vec3d& n, double angle) {
  const auto [u, v] = crossed_tangents(n);
  return std::cos(angle) * u + std::sin(angle) * v;
}

std::vector<double> choose_lags(double edge, double sphere_distance) {
  const double longest = std::min(sphere_distance, kLongestLag);
  std::vector<double> lags;
  for (double r = kFirstLag * edge; lags.size() < kFewestLags || r <= longest; r *= kLagRatio) {
    lags.push_back(r);
  }
  return lags;
}

// The triangles of marching cubes have on average the area of an equilateral triangle with the edge of a
// cell.
TriangleMesh mesh_base(const MetaballBody& base, double edge) {
  Recipe recipe;
  recipe.body = base;
  const ImplicitField field(recipe);
  const double cells = field.bounds().longest_side() / edge;
  MeshCollector collector;
  mesh_field(field, field.bounds(), std::max(16, static_cast<int>(std::lround(cells))), collector);
  return std::move(collector.mesh);
}

void add_lines(const SurfaceSamples& sites, std::uint64_t seed, ProbeLayout& layout) {
  const SurfaceTree tree(layout.mesh);
  layout.triples.resize(layout.lags.size());
  const auto add = [&](const Vec3d& p) {
    layout.places.push_back(nearest_place(layout.mesh, tree, p));
    return static_cast<std::uint32_t>(layout.places.size() - 1);
  };
  for (std::size_t j = 0; j < sites.points.size(); ++j) {
    CounterRandom random(seed, j);
    const Vec3d& q = sites.points[j];
    const std::uint32_t middle = add(q);
    for (std::size_t k = 0; k < layout.lags.size(); ++k) {
      const Vec3d step = layout.lags[k] * tangent(sites.normals[j], random.uniform(0.0, kTurn));
      const std::uint32_t before = add(q - step), after = add(q + step);
      layout.triples[k].push_back({before, middle, after});
    }
  }
}

// On slopes of a few tens of degrees the error falls by a factor of about four with each step.
constexpr int kSteps = 3;
constexpr int kTargetSteps = 6;

constexpr std::size_t kPointsPerBlock = 256;

// Evaluates F at the points of one block after they have moved by t.
class BlockEvaluation {
 public:
  BlockEvaluation(const PreparedMetaballs& metaballs, const Candidates& layers, std::size_t n)
      : metaballs_(metaballs), layers_(layers) {
    for (auto& a : arrays_) a.resize(n);
  }

  const std::vector<float>& at(const std::array<std::vector<float>, 3>& start,
                               const std::array<std::vector<float>, 3>& direction,
                               const std::vector<float>& t) {
    auto& [x, y, z, f, gx, gy, gz, height] = arrays_;
    for (std::size_t i = 0; i < t.size(); ++i) {
      x[i] = start[0][i] + t[i] * direction[0][i];
      y[i] = start[1][i] + t[i] * direction[1][i];
      z[i] = start[2][i] + t[i] * direction[2][i];
    }
    const int n = static_cast<int>(t.size());
    evaluate_metaballs(metaballs_, n, x.data(), y.data(), z.data(), f.data(), gx.data(), gy.data(),
                       gz.data());
    for (const FractalNoise& noise : layers_.noises) {
      evaluate_heights(noise, layers_.arrays.view(), n, x.data(), y.data(), z.data(), height.data());
      for (std::size_t i = 0; i < t.size(); ++i) f[i] += height[i];
    }
    return f;
  }

 private:
  const PreparedMetaballs& metaballs_;
  const Candidates& layers_;  // of one candidate
  std::array<std::vector<float>, 8> arrays_;
};

}  // namespace

std::vector<ProbePoint> ProbeLayout::vertex_points() const {
  std::vector<ProbePoint> points;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    points.push_back({mesh.vertices[v], mesh.normals[v]});
  }
  return points;
}

std::vector<ProbePoint> ProbeLayout::place_points() const {
  std::vector<ProbePoint> points;
  for (const MeshPlace& place : places) {
    points.push_back({place.interpolate(mesh.triangles, mesh.vertices),
                      normalized(place.interpolate(mesh.triangles, mesh.normals))});
  }
  return points;
}

std::vector<double> ProbeLayout::at_places(const std::vector<double>& vertex_values) const {
  std::vector<double> heights;
  for (const MeshPlace& place : places) heights.push_back(place.interpolate(mesh.triangles, vertex_values));
  return heights;
}

MeshPlace nearest_place(const TriangleMesh& mesh, const SurfaceTree& tree, const Vec3d& p) {
  const ClosestPoint at = tree.closest(p);
  const Triangle& t = mesh.triangles[at.triangle];
  const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const Vec3d n = cross(b - a, c - a);
  const double whole = squared_norm(n);
  if (!(whole > 0.0)) return {at.triangle, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};
  return {
      at.triangle,
      {dot(cross(b - at.point, c - at.point), n) / whole, dot(cross(c - at.point, a - at.point), n) / whole,
       dot(cross(a - at.point, b - at.point), n) / whole}};
}

double facet_edge(const TargetBody& target) {
  return mean_edge_length(target.area / static_cast<double>(target.surface.triangles.size()));
}

double probe_edge(const TargetBody& target) {
  return std::max(facet_edge(target), mean_edge_length(target.area / kMostTriangles));
}

ProbeLayout lay_out_probes(const TargetBody& target, const MetaballBody& base, int lines,
                           std::uint64_t seed) {
  const double edge = probe_edge(target);
  ProbeLayout layout;
  layout.mesh = mesh_base(base, edge);
  layout.lags = choose_lags(edge, std::sqrt(target.area / static_cast<double>(base.num_metaballs())));
  add_lines(sample_surface(layout.mesh, lines, seed, SampleNormals::interpolated), seed, layout);
  return layout;
}

SurfaceProbe::SurfaceProbe(const MetaballBody& base, const std::vector<ProbePoint>& points, double reach)
    : size_(points.size()), reach_(reach) {
  const PreparedMetaballs prepared = prepare_metaballs(base);
  domain_ = support_bounds(prepared);
  std::vector<Vec3d> starts;
  for (const ProbePoint& p : points) starts.push_back(p.start);
  for (PointCluster& cluster : cluster_points(starts, kPointsPerBlock)) {
    add_block(prepared, points, std::move(cluster.points));
    add_lines(blocks_.back());
  }
  lines_.parameters = prepared.parameters;
  lines_.reach = static_cast<float>(reach);
  lines_.steps = kSteps;
}

void SurfaceProbe::add_block(const PreparedMetaballs& base, const std::vector<ProbePoint>& points,
                             std::vector<std::int32_t> indices) {
  Block block;
  Box box;
  for (const std::int32_t i : indices) {
    const ProbePoint& p = points[static_cast<std::size_t>(i)];
    box.extend(p.start);
    const double start[] = {p.start.x, p.start.y, p.start.z};
    const double direction[] = {p.direction.x, p.direction.y, p.direction.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      block.start[axis].push_back(static_cast<float>(start[axis]));
      block.direction[axis].push_back(static_cast<float>(direction[axis]));
    }
  }
  block.metaballs = metaballs_reaching(base, widened(box, reach_));
  block.points = std::move(indices);
  blocks_.push_back(std::move(block));
}

std::vector<double> SurfaceProbe::heights(std::span<const FractalLayer> layers, std::uint64_t seed) const {
  Candidates candidate;
  candidate.add(layers, seed, domain_);
  const float reach = static_cast<float>(reach_);
  std::vector<double> result(size_);
  parallel_for(0, static_cast<std::int64_t>(blocks_.size()), [&](std::int64_t b) {
    const Block& block = blocks_[static_cast<std::size_t>(b)];
    const std::size_t n = block.points.size();
    BlockEvaluation evaluation(block.metaballs, candidate, n);
    std::vector<float> t(n, 0.0f);
    for (int step = 0; step < kSteps; ++step) {
      const std::vector<float>& f = evaluation.at(block.start, block.direction, t);
      for (std::size_t i = 0; i < n; ++i) t[i] = std::clamp(t[i] + f[i], -reach, reach);
    }
    for (std::size_t i = 0; i < n; ++i) result[static_cast<std::size_t>(block.points[i])] = double{t[i]};
  });
  return result;
}

void SurfaceProbe::add_lines(const Block& block) {
  for (std::size_t i = 0; i < block.points.size(); ++i) {
    const auto at = [i](const std::array<std::vector<float>, 3>& v) {
      return Vec3f{v[0][i], v[1][i], v[2][i]};
    };
    lines_.start.push_back(at(block.start));
    lines_.direction.push_back(at(block.direction));
    lines_.block.push_back(static_cast<std::uint32_t>(lines_.first_metaball.size() - 1));
  }
  lines_.metaballs.insert(lines_.metaballs.end(), block.metaballs.spheres.begin(),
                          block.metaballs.spheres.end());
  lines_.first_metaball.push_back(static_cast<std::uint32_t>(lines_.metaballs.size()));
}

std::vector<std::vector<double>> SurfaceProbe::heights(CandidateEvaluator& evaluator,
                                                       std::span<const std::vector<FractalLayer>> candidates,
                                                       std::uint64_t seed) const {
  Candidates all;
  for (const std::vector<FractalLayer>& layers : candidates) all.add(layers, seed, domain_);
  std::vector<std::vector<double>> result;
  for (const std::vector<float>& t : evaluator.heights(lines_, all)) {
    std::vector<double>& heights = result.emplace_back(size_);
    std::size_t line = 0;
    for (const Block& block : blocks_) {
      for (const std::int32_t i : block.points) heights[static_cast<std::size_t>(i)] = double{t[line++]};
    }
  }
  return result;
}

std::vector<double> target_heights(const SurfaceTree& target, std::span<const ProbePoint> points,
                                   double reach) {
  std::vector<double> result(points.size());
  parallel_for(
      0, static_cast<std::int64_t>(points.size()),
      [&](std::int64_t i) {
        const ProbePoint& p = points[static_cast<std::size_t>(i)];
        double t = 0.0;
        for (int step = 0; step < kTargetSteps; ++step) {
          t = std::clamp(t + target.signed_distance(p.start + t * p.direction), -reach, reach);
        }
        result[static_cast<std::size_t>(i)] = t;
      },
      64);
  return result;
}

}  // namespace astrolith
