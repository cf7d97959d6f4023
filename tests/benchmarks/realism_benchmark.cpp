// Measures the power and the size of the test of realism (descriptor/surface/realism.h). Prints tables in
// Markdown (docs/descriptor.md).
//
//   realism_benchmark --seeds 3 MESH...                          # which impostors of a body it rejects
//   realism_benchmark --facets 1500 3000 6000 --seeds 2 MESH...  # from how many facets on it has power
//   realism_benchmark --equals 100 --points 6000 --places 1500   # how often draws of one kind are rejected
//
// A mesh is a closed body of some ten thousand triangles. A body of few facets is the body decimated, beside
// its relief smoothed away or halved. Equals are spheres with noise of one kind.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "descriptor/surface/realism.h"
#include "geometry/io/mesh_io.h"
#include "geometry/surface/decimated_mesh.h"
#include "tests/benchmarks/impostors.h"
#include "tests/descriptor/surface/rough_spheres.h"

namespace {

using namespace astrolith;
using astrolith::testing::BumpHeights;
using astrolith::testing::rough_sphere;

struct Sampling {
  std::int64_t points = 0,
               places = SurfaceStatisticsOptions{}.places;  // points 0: as many as both meshes allow
};

RealismVerdict judge(const TriangleMesh& a, const TriangleMesh& b, Sampling sampling, std::uint64_t seed) {
  SurfaceStatisticsOptions options;
  options.points = sampling.points > 0 ? sampling.points : common_points(a, b);
  options.places = sampling.places;
  options.seed = 2 * seed + 1;
  const SurfaceStatistics of_a = surface_statistics(a, options);
  options.seed = 2 * seed + 2;
  return judge_realism(of_a, surface_statistics(b, options), {.seed = seed});
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
                 {"one Laplace step", always(laplace_impostor(body))},
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
                 {"one Laplace step", always(laplace_impostor(coarse))}},
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
