#include <fmt/format.h>
#include <sys/resource.h>
#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include "estimation/shape/shape_fit.h"
#include "geometry/mesh_io.h"
#include "numerics/parallel_for.h"
using namespace astrolith;
static double cpu() {
  rusage u;
  getrusage(RUSAGE_SELF, &u);
  return u.ru_utime.tv_sec + 1e-6 * u.ru_utime.tv_usec + u.ru_stime.tv_sec + 1e-6 * u.ru_stime.tv_usec;
}
int main(int argc, char** argv) {
  CLI::App app;
  std::vector<std::string> files;
  ShapeFitOptions o;
  bool curve = false;
  int seeds = 1;
  app.add_option("meshes", files);
  app.add_option("--spheres", o.spheres)->take_last();
  app.add_option("--points", o.points)->take_last();
  app.add_option("--generations", o.generations)->take_last();
  app.add_option("--seed", o.seed);
  app.add_option("--seeds", seeds);
  app.add_flag("--curve", curve);
  app.add_option("--check", o.check_resolution)->take_last();
  int threads = 1;
  app.add_option("--threads", threads);
  CLI11_PARSE(app, argc, argv);
  const ThreadLimit limit(threads);
  for (const auto& f : files)
    for (int s = 0; s < seeds; ++s) {
      ShapeFitOptions p = o;
      p.seed += s;
      const TargetBody t = prepare_target(read_mesh(f), f);
      const double c0 = cpu();
      std::string last;
      double at = c0;
      auto start = std::chrono::steady_clock::now();
      auto r = fit_shape(t, p, [&](const std::string& st) {
        if (curve) fmt::print("  {} starts at {:.1f}\n", st, cpu() - c0);
        return Progress();
      });
      const std::chrono::duration<double> w = std::chrono::steady_clock::now() - start;
      (void)at;
      if (curve)
        for (auto& q : r.convergence)
          fmt::print("   it {:4} n {:4} mean {:.4f}\n", q.iterations, q.spheres, 100 * q.mean_distance);
      fmt::print(
          "{:36} seed {} n {:4} mean {:.4f} p99 {:.3f} max {:.3f} parts {}/{} genus {} kappa {:.2f} sim "
          "{:.3f} cpu {:.1f} wall {:.1f}\n",
          std::filesystem::path(f).stem().string(), p.seed, r.body.spheres.size(),
          100 * r.check.distance.mean, 100 * r.check.distance.p99, 100 * r.check.distance.max,
          r.check.topology.components, t.components, r.check.topology.genus, r.body.blend_exponent * r.body.a,
          r.similarity, cpu() - c0, w.count());
      std::fflush(stdout);
    }
}
