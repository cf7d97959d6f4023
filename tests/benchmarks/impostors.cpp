#include "tests/benchmarks/impostors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_normals.h"
#include "geometry/surface/decimated_mesh.h"
#include "geometry/surface/mesh_sampling.h"
#include "geometry/surface/surface_tree.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/benchmarks/spherical_harmonics.h"
#include "tests/support/meshes.h"
#include "tests/synthesis/analytic_field.h"

namespace astrolith {
namespace {

// Each vertex moved by `share` of the way to the mean of its neighbours.
TriangleMesh laplace_step(const TriangleMesh& mesh, double share) {
  std::vector<Vec3d> sums(mesh.vertices.size());
  std::vector<double> counts(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [i, j] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
      sums[i] += mesh.vertices[j], sums[j] += mesh.vertices[i];
      counts[i] += 1, counts[j] += 1;
    }
  }
  TriangleMesh smooth{mesh.vertices, mesh.triangles, {}};
  for (std::size_t v = 0; v < sums.size(); ++v) {
    if (counts[v] > 0) smooth.vertices[v] += share * ((1 / counts[v]) * sums[v] - mesh.vertices[v]);
  }
  return smooth;
}

// Sums of plane waves of one length and rms 1, at every vertex.
std::vector<double> octave_at(const std::vector<Vec3d>& points, double wave, std::uint64_t seed) {
  constexpr int kWaves = 80;
  std::vector<Vec3d> vectors;
  std::vector<double> phases;
  for (std::uint64_t k = 0; k < kWaves; ++k) {
    CounterRandom random(seed, k);
    const Vec3d along = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    vectors.push_back(2 * std::numbers::pi / (wave * (0.75 + 0.5 * random.uniform())) * along);
    phases.push_back(2 * std::numbers::pi * random.uniform());
  }
  std::vector<double> heights(points.size());
  parallel_for(
      0, static_cast<std::int64_t>(points.size()),
      [&](std::int64_t i) {
        double sum = 0;
        for (std::size_t k = 0; k < kWaves; ++k) {
          sum += std::cos(dot(vectors[k], points[static_cast<std::size_t>(i)]) + phases[k]);
        }
        heights[static_cast<std::size_t>(i)] = sum * std::sqrt(2.0 / kWaves);
      },
      256);
  return heights;
}

double mean_roughness(const SurfaceStatistics& surface, double radius) {
  double sum = 0;
  const std::vector<double>& values = surface.find(SurfaceQuantity::roughness, radius)->values;
  for (const double v : values) sum += v / static_cast<double>(values.size());
  return sum;
}

struct MeanRoughness {
  double fine, coarse;  // within 3 and 12 edges, or 6 where 12 are too many
};
MeanRoughness mean_roughness(const TriangleMesh& mesh) {
  SurfaceStatisticsOptions options;
  options.places = 500;
  const SurfaceStatistics s = surface_statistics(mesh, options);
  const bool wide = s.find(SurfaceQuantity::roughness, 12) != nullptr;
  return {mean_roughness(s, 3), mean_roughness(s, wide ? 12 : 6)};
}

}  // namespace

TriangleMesh noise_impostor(const TriangleMesh& body, std::uint64_t seed) {
  constexpr int kSmoothings = 60, kOctaves = 4, kSteps = 5;
  TriangleMesh base = body;
  for (int k = 0; k < kSmoothings; ++k) base = laplace_step(base, 0.5);
  const double edge =
      std::sqrt(4 / std::sqrt(3.0) * surface_area(body) / static_cast<double>(body.triangles.size()));
  const std::vector<Vec3d> normals = vertex_normals(base);
  std::vector<std::vector<double>> octaves;
  for (int o = 0; o < kOctaves; ++o) {
    octaves.push_back(
        octave_at(base.vertices, 24 * edge / std::pow(2.0, o), 100 * seed + static_cast<std::uint64_t>(o)));
  }
  const MeanRoughness wanted = mean_roughness(body);
  double amplitude = 0.3 * edge, gain = 0.5;
  TriangleMesh rough = base;
  for (int step = 0; step < kSteps; ++step) {
    for (std::size_t v = 0; v < rough.vertices.size(); ++v) {
      double height = 0, share = amplitude;
      for (const std::vector<double>& octave : octaves) {
        height += share * octave[v];
        share *= gain;
      }
      rough.vertices[v] = base.vertices[v] + height * normals[v];
    }
    if (step + 1 == kSteps) break;
    const MeanRoughness own = mean_roughness(rough);
    amplitude *= std::exp(wanted.coarse - own.coarse);
    gain *= std::exp(0.5 * ((wanted.fine - own.fine) - (wanted.coarse - own.coarse)));
  }
  return rough;
}

TriangleMesh relief_impostor(const TriangleMesh& body, double share) {
  constexpr int kSmoothings = 60;
  TriangleMesh base = body;
  for (int k = 0; k < kSmoothings; ++k) base = laplace_step(base, 0.5);
  for (std::size_t v = 0; v < base.vertices.size(); ++v) {
    base.vertices[v] += share * (body.vertices[v] - base.vertices[v]);
  }
  return base;
}

TriangleMesh laplace_impostor(const TriangleMesh& body) { return laplace_step(body, 1.0); }

TriangleMesh decimated_impostor(const TriangleMesh& body) {
  return testing::subdivided(decimated(body, body.vertices.size() / 4));
}

TriangleMesh harmonics_impostor(const TriangleMesh& body) {
  constexpr int kDegree = 30;
  constexpr std::int64_t kPoints = 12 * (kDegree + 1) * (kDegree + 1);
  const int rows = static_cast<int>(std::sqrt(static_cast<double>(body.triangles.size()) / 4));
  return harmonics_mesh(
      fit_harmonics(sample_surface(body, kPoints, 7).points, volume_centroid(body), kDegree), rows);
}

TriangleMesh remeshed(const TriangleMesh& body, double triangles) {
  // Marching cubes make about 3 triangles for each squared cell of area.
  const double cell = std::sqrt(3 * surface_area(body) / triangles);
  // The lattice is turned off the coordinate planes by a part of a cell only: bodies are not aligned to it.
  Box bounds = body.bounds();
  bounds.min -= cell * Vec3d{1.71, 1.53, 1.37};
  bounds.max += 2 * cell * Vec3d{1, 1, 1};
  const Vec3d extent = bounds.extent();
  const SurfaceTree tree(body);
  const testing::AnalyticField depth([&](const Vec3d& p) { return tree.signed_distance(p); }, 1.0);
  MeshCollector collector;
  testing::mesh_field(
      depth, bounds, static_cast<int>(std::ceil(std::max({extent.x, extent.y, extent.z}) / cell)), collector);
  return std::move(collector.mesh);
}

}  // namespace astrolith
