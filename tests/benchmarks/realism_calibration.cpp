// Measures where the test of realism (descriptor/surface/realism.h) can be trusted. Prints tables in Markdown
// (docs/descriptor.md).
//
//   realism_calibration --equals 100 --points 6000 --places 1500   # how often draws of one kind are rejected
//   realism_calibration --facets 1500 3000 6000 12000 MESH...      # from how many facets the test has power
//
// Equals are spheres with noise of one kind. A body of few facets is the body decimated, beside its relief
// smoothed away or halved.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
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

using Heights = std::function<double(const Vec3d&)>;

struct Kind {
  std::string name;
  std::function<Heights(double edge, std::uint64_t seed)> draw;
};

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

std::vector<Kind> kinds() {
  const auto noise = [](double size) {
    return [size](double edge, std::uint64_t seed) -> Heights {
      return
          [height = BumpsAndPits(size * edge, seed), edge](const Vec3d& p) { return 0.2 * edge * height(p); };
    };
  };
  const auto octaves = [](double edge, std::uint64_t seed) -> Heights {
    return [a = BumpsAndPits(1.2 * edge, seed), b = BumpsAndPits(2.5 * edge, seed + 1000),
            c = BumpsAndPits(5 * edge, seed + 2000),
            edge](const Vec3d& p) { return edge * (0.07 * a(p) + 0.14 * b(p) + 0.28 * c(p)); };
  };
  const auto boulders = [](double edge, std::uint64_t seed) -> Heights {
    return [a = BumpsAndPits(1.5 * edge, seed + 1000), b = BumpHeights(150, 1.5 * edge, seed),
            edge](const Vec3d& p) { return edge * (0.1 * a(p) + 0.8 * b(p)); };
  };
  return {{"bumps and pits of 1.5 edges", noise(1.5)},
          {"of 3 edges", noise(3)},
          {"of 5 edges", noise(5)},
          {"three octaves", octaves},
          {"boulders", boulders}};
}

struct Sampling {
  std::int64_t points, places;
};

SurfaceStatistics sampled(const TriangleMesh& mesh, const Sampling& sampling, std::uint64_t seed) {
  SurfaceStatisticsOptions options;
  options.points = sampling.points;
  options.places = sampling.places;
  options.seed = seed;
  return surface_statistics(mesh, options);
}

std::string name_of_statistic(const StatisticComparison& c) {
  const std::string what = c.correlation ? "correlation" : name_of(c.quantity);
  return c.radius > 0 ? fmt::format("{} {:g}", what, c.radius) : what;
}

void judge_equals(int pairs, const Sampling& sampling) {
  const double edge =
      std::sqrt(8 * std::acos(-1.0) / (std::sqrt(3.0) * static_cast<double>(sampling.points)));
  fmt::print("| kind | pairs | p < .05 | by statistic |\n|---|---|---|---|\n");
  for (const Kind& kind : kinds()) {
    int rejected = 0;
    std::map<std::string, int> of_statistic;
    for (int k = 0; k < pairs; ++k) {
      const auto seed = static_cast<std::uint64_t>(k);
      const RealismVerdict verdict = judge_realism(
          sampled(rough_sphere(kind.draw(edge, 2 * seed + 1)), sampling, 2 * seed + 1),
          sampled(rough_sphere(kind.draw(edge, 2 * seed + 2)), sampling, 2 * seed + 2), {.seed = seed});
      if (verdict.p < kPassingP) ++rejected;
      for (const StatisticComparison& c : verdict.statistics) {
        if (c.counts_in_p && c.p < kPassingP) ++of_statistic[name_of_statistic(c)];
      }
    }
    std::string words;
    for (const auto& [name, count] : of_statistic) words += fmt::format("{} {}, ", name, count);
    fmt::print("| {} | {} | {} | {} |\n", kind.name, pairs, rejected, words);
    std::fflush(stdout);
  }
}

struct Power {
  int cases = 0, by_p = 0, by_distance = 0, failed = 0;
};

void judge_coarse(const std::vector<std::string>& files, const std::vector<std::int64_t>& facets, int seeds,
                  std::int64_t places) {
  fmt::print("| facets | case | cases | p < .05 | distance > .13 | rejected |\n|---|---|---|---|---|---|\n");
  std::vector<TriangleMesh> bodies;
  for (const std::string& file : files) bodies.push_back(read_mesh(file));
  for (const std::int64_t count : facets) {
    std::map<std::string, Power> powers;
    for (const TriangleMesh& body : bodies) {
      const TriangleMesh coarse = decimated(body, static_cast<std::size_t>(count / 2));
      const std::vector<std::pair<std::string, TriangleMesh>> cases{
          {"itself", coarse},
          {"half its relief", relief_impostor(coarse, 0.5)},
          {"no relief", relief_impostor(coarse, 0)},
          {"one Laplace step", laplace_impostor(coarse)}};
      for (const auto& [name, mesh] : cases) {
        for (int k = 0; k < seeds; ++k) {
          const auto seed = static_cast<std::uint64_t>(k);
          const std::int64_t points = common_points(coarse, mesh);
          const RealismVerdict v =
              judge_realism(sampled(coarse, {points, places}, 2 * seed + 1),
                            sampled(mesh, {points, places}, 2 * seed + 2), {.seed = seed});
          Power& power = powers[name];
          ++power.cases;
          power.by_p += v.p < kPassingP ? 1 : 0;
          power.by_distance += v.largest_distance > kPassingDistance ? 1 : 0;
          power.failed += v.passes || v.too_coarse ? 0 : 1;
        }
      }
    }
    for (const auto& [name, power] : powers) {
      fmt::print("| {} | {} | {} | {} | {} | {} |\n", count, name, power.cases, power.by_p, power.by_distance,
                 power.failed);
    }
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Size and power of the test of realism at few points."};
  std::vector<std::string> files;
  std::vector<std::int64_t> facets;
  int equals = 0, seeds = 1;
  Sampling sampling{6000, 3000};
  app.add_option("meshes", files);
  app.add_option("--facets", facets);
  app.add_option("--equals", equals);
  app.add_option("--points", sampling.points);
  app.add_option("--places", sampling.places);
  app.add_option("--seeds", seeds);
  CLI11_PARSE(app, argc, argv);
  if (equals > 0) judge_equals(equals, sampling);
  if (!facets.empty()) judge_coarse(files, facets, seeds, sampling.places);
}
