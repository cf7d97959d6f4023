// Measures the power and the size of the test of realism (descriptor/surface/realism.h). Prints tables in
// Markdown (docs/surfaces.md).
//
//   realism_benchmark --seeds 3 MESH...                          # which impostors of a body it rejects
//   realism_benchmark --facets 1500 3000 6000 --seeds 2 MESH...  # from how many facets on it has power
//   realism_benchmark --equals 100 --points 6000 --places 1500   # how often draws of one kind are rejected
//
// A mesh is a closed body of some ten thousand triangles. A body of few facets is the body decimated, beside
// its relief smoothed away or halved. Equals are spheres with noise of one kind.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "descriptor/surface/realism.h"
#include "descriptor/surface/surface_statistics.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/surface/decimated_mesh.h"
#include "geometry/surface/mesh_sampling.h"
#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/benchmarks/spherical_harmonics.h"
#include "tests/descriptor/surface/rough_spheres.h"
#include "tests/support/meshes.h"
#include "tests/synthesis/analytic_field.h"

namespace {

using namespace astrolith;
using astrolith::testing::BumpHeights;
using astrolith::testing::rough_sphere;

// Impostors look like a body and are not: the test has to reject them. It should accept the body's own
// surface with other triangles.

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

// The mesh after sixty half steps.
TriangleMesh smoothed(TriangleMesh mesh) {
  for (int k = 0; k < 60; ++k) mesh = laplace_step(mesh, 0.5);
  return mesh;
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

// The body without what is finer than some 10 edges, with homogeneous fractal noise in its place: octaves of
// random waves of 24, 12, 6 and 3 edges. Amplitude and gain are set so that the means of the logarithm of the
// roughness within 3 and 12 edges are the body's.
TriangleMesh noise_impostor(const TriangleMesh& body, std::uint64_t seed) {
  constexpr int kOctaves = 4, kSteps = 5;
  const TriangleMesh base = smoothed(body);
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

// The body smoothed by sixty half steps of Laplace, with a share of the relief that this took away.
TriangleMesh relief_impostor(const TriangleMesh& body, double share) {
  TriangleMesh base = smoothed(body);
  for (std::size_t v = 0; v < base.vertices.size(); ++v) {
    base.vertices[v] += share * (body.vertices[v] - base.vertices[v]);
  }
  return base;
}

// A quarter of the vertices, chosen by quadric error metrics, and each triangle cut into four.
TriangleMesh decimated_impostor(const TriangleMesh& body) {
  return astrolith::testing::subdivided(decimated(body, body.vertices.size() / 4));
}

// Spherical harmonics of the radius to degree 30, with about as many triangles.
TriangleMesh harmonics_impostor(const TriangleMesh& body) {
  constexpr int kDegree = 30;
  constexpr std::int64_t kPoints = 12 * (kDegree + 1) * (kDegree + 1);
  const int rows = static_cast<int>(std::sqrt(static_cast<double>(body.triangles.size()) / 4));
  return harmonics_mesh(
      fit_harmonics(sample_surface(body, kPoints, 7).points, volume_centroid(body), kDegree), rows);
}

// The zero set of the body's signed distance by marching cubes, with about as many triangles. The body must
// be closed.
TriangleMesh remeshed(const TriangleMesh& body, double triangles) {
  // Marching cubes make about 3 triangles for each squared cell of area.
  const double cell = std::sqrt(3 * surface_area(body) / triangles);
  // The lattice is turned off the coordinate planes by a part of a cell only: bodies are not aligned to it.
  Box bounds = body.bounds();
  bounds.min -= cell * Vec3d{1.71, 1.53, 1.37};
  bounds.max += 2 * cell * Vec3d{1, 1, 1};
  const Vec3d extent = bounds.extent();
  const SurfaceTree tree(body);
  const astrolith::testing::AnalyticField depth([&](const Vec3d& p) { return tree.signed_distance(p); }, 1.0);
  MeshCollector collector;
  astrolith::testing::mesh_field(
      depth, bounds, static_cast<int>(std::ceil(std::max({extent.x, extent.y, extent.z}) / cell)), collector);
  return std::move(collector.mesh);
}

struct Sampling {
  std::int64_t points = 0,
               places = SurfaceStatisticsOptions{}.places;  // points 0: as many as both meshes allow
};

RealismVerdict judge(const TriangleMesh& a, const TriangleMesh& b, Sampling sampling, std::uint64_t seed) {
  SurfaceStatisticsOptions options;
  options.points = sampling.points > 0 ? sampling.points : common_points(a, b);
  options.places = sampling.places;
  options.seed = 2 * seed + 1;
  const SurfaceStatistics statistics_a = surface_statistics(a, options);
  options.seed = 2 * seed + 2;
  return judge_realism(statistics_a, surface_statistics(b, options), {.seed = seed});
}

// The verdicts of one case, over bodies and seeds.
struct Counts {
  int cases = 0, by_p = 0, by_distance = 0, failed = 0;
  std::vector<std::pair<double, double>>
      ranges;  // of the ratios of the bands, and of the coupling at the end

  void add(const RealismVerdict& v) {
    ++cases;
    by_p += v.p < kPassingP ? 1 : 0;
    by_distance += v.largest_distance > kPassingDistance ? 1 : 0;
    failed += v.passes || v.too_coarse ? 0 : 1;
    std::vector<double> ratios;
    for (const BandRatio& band : v.bands) ratios.push_back(band.ratio);
    if (v.coupling_ratio) ratios.push_back(*v.coupling_ratio);
    if (ratios.size() > ranges.size()) ranges.resize(ratios.size(), {1e300, 0.0});
    for (std::size_t k = 0; k < ratios.size(); ++k) {
      ranges[k] = {std::min(ranges[k].first, ratios[k]), std::max(ranges[k].second, ratios[k])};
    }
  }
};

void print(const std::string& heading, const std::map<std::string, Counts>& table) {
  fmt::print(
      "\n| {} | cases | p < .05 | distance > .13 | rejected | bands, coupling |\n|---|---|---|---|---|---|\n",
      heading);
  for (const auto& [name, counts] : table) {
    std::string ranges;
    for (const auto& [least, most] : counts.ranges) ranges += fmt::format("{:.2f} to {:.2f}, ", least, most);
    fmt::print("| {} | {} | {} | {} | {} | {} |\n", name, counts.cases, counts.by_p, counts.by_distance,
               counts.failed, ranges);
  }
  std::fflush(stdout);
}

using Cases = std::vector<std::pair<std::string, std::function<TriangleMesh(std::uint64_t seed)>>>;

void judge_cases(const TriangleMesh& body, const Cases& cases, Sampling sampling, int seeds,
                 std::map<std::string, Counts>& table) {
  for (const auto& [name, mesh] : cases) {
    for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
      table[name].add(judge(body, mesh(seed), sampling, seed));
    }
  }
}

std::function<TriangleMesh(std::uint64_t)> always(TriangleMesh mesh) {
  return [mesh = std::move(mesh)](std::uint64_t) { return mesh; };
}

void judge_impostors(const std::vector<TriangleMesh>& bodies, Sampling sampling, int seeds) {
  std::map<std::string, Counts> table;
  for (const TriangleMesh& body : bodies) {
    const auto triangles = static_cast<double>(body.triangles.size());
    judge_cases(body,
                {{"itself, sampled anew", always(body)},
                 {"itself, other triangles", always(remeshed(body, triangles))},
                 {"itself, twice the triangles", always(remeshed(body, 2 * triangles))},
                 {"fractal noise", [&](std::uint64_t seed) { return noise_impostor(body, seed); }},
                 {"half its relief", always(relief_impostor(body, 0.5))},
                 {"one Laplace step", always(laplace_step(body, 1.0))},
                 {"decimated and refined", always(decimated_impostor(body))},
                 {"harmonics of degree 30", always(harmonics_impostor(body))}},
                sampling, seeds, table);
  }
  print("case", table);
}

void judge_coarse(const std::vector<TriangleMesh>& bodies, std::int64_t facets, Sampling sampling,
                  int seeds) {
  std::map<std::string, Counts> table;
  for (const TriangleMesh& body : bodies) {
    const TriangleMesh coarse = decimated(body, static_cast<std::size_t>(facets / 2));
    judge_cases(coarse,
                {{"itself", always(coarse)},
                 {"half its relief", always(relief_impostor(coarse, 0.5))},
                 {"no relief", always(relief_impostor(coarse, 0))},
                 {"one Laplace step", always(laplace_step(coarse, 1.0))}},
                sampling, seeds, table);
  }
  print(fmt::format("{} facets", facets), table);
}

// Gaussian bumps and pits of height 1 and one size: nearly Gaussian noise whose parts are independent, so
// that one draw is as rough as the next.
class BumpsAndPits {
 public:
  BumpsAndPits(double size, std::uint64_t seed)
      : bumps_(count(size), size, 2 * seed), pits_(count(size), size, 2 * seed + 1) {}
  double operator()(const Vec3d& p) const { return bumps_(p) - pits_(p); }

 private:
  static int count(double size) { return static_cast<int>(6 / (size * size)); }
  BumpHeights bumps_, pits_;
};

using Heights = std::function<double(const Vec3d&)>;

void judge_equals(int pairs, Sampling sampling) {
  const double edge =
      std::sqrt(8 * std::acos(-1.0) / (std::sqrt(3.0) * static_cast<double>(sampling.points)));
  const auto noise = [=](double size) {
    return [=](std::uint64_t seed) -> Heights {
      return [=, height = BumpsAndPits(size * edge, seed)](const Vec3d& p) { return 0.2 * edge * height(p); };
    };
  };
  const auto octaves = [=](std::uint64_t seed) -> Heights {
    return [=, a = BumpsAndPits(1.2 * edge, seed), b = BumpsAndPits(2.5 * edge, seed + 1000),
            c = BumpsAndPits(5 * edge, seed + 2000)](const Vec3d& p) {
      return edge * (0.07 * a(p) + 0.14 * b(p) + 0.28 * c(p));
    };
  };
  const auto boulders = [=](std::uint64_t seed) -> Heights {
    return [=, a = BumpsAndPits(1.5 * edge, seed + 1000), b = BumpHeights(150, 1.5 * edge, seed)](
               const Vec3d& p) { return edge * (0.1 * a(p) + 0.8 * b(p)); };
  };
  const std::vector<std::pair<std::string, std::function<Heights(std::uint64_t)>>> kinds{
      {"bumps and pits of 1.5 edges", noise(1.5)},
      {"of 3 edges", noise(3)},
      {"of 5 edges", noise(5)},
      {"three octaves", octaves},
      {"boulders", boulders}};
  std::map<std::string, Counts> table;
  for (const auto& [name, heights] : kinds) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(pairs); ++seed) {
      table[name].add(
          judge(rough_sphere(heights(2 * seed + 1)), rough_sphere(heights(2 * seed + 2)), sampling, seed));
    }
  }
  print("kind", table);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Power and size of the test of realism."};
  std::vector<std::string> files;
  std::vector<std::int64_t> facets;
  int equals = 0, seeds = 1;
  Sampling sampling;
  app.add_option("meshes", files);
  app.add_option("--facets", facets);
  app.add_option("--equals", equals)->needs(app.add_option("--points", sampling.points));
  app.add_option("--places", sampling.places);
  app.add_option("--seeds", seeds);
  CLI11_PARSE(app, argc, argv);
  std::vector<TriangleMesh> bodies;
  for (const std::string& file : files) bodies.push_back(read_mesh(file));
  for (const std::int64_t count : facets) judge_coarse(bodies, count, sampling, seeds);
  if (facets.empty() && !bodies.empty()) judge_impostors(bodies, sampling, seeds);
  if (equals > 0) judge_equals(equals, sampling);
}
