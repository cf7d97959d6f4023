// Measures the base fit of bodies: distances between the synthesised mesh and the target at fresh samples of
// both, in percent of the bounding-box diagonal, and the cost.
//
//   base_fit_benchmark --spheres 200 --seeds 3 MESH...
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <ctime>
#include <filesystem>

#include "estimation/shape/fit/shape_fit.h"
#include "geometry/io/mesh_io.h"
#include "numerics/parallel_for.h"

namespace {

using namespace astrolith;

Kernel kernel_of(const std::string& word) {
  for (const Kernel kernel : kKernels) {
    if (word == kernel_word(kernel)) return kernel;
  }
  throw CLI::ValidationError("--kernel", "no such kernel");
}

void fit_and_print(const std::string& file, const ShapeFitOptions& options, bool curve) {
  const TargetBody target = prepare_target(read_mesh(file), file);
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  const ShapeFitResult fit = fit_shape(target, options);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const double cpu_seconds = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  if (curve) {
    for (const ConvergencePoint& p : fit.convergence) {
      fmt::print("  {:5} iterations {:5} spheres {:.4f}\n", p.iterations, p.spheres, 100 * p.mean_distance);
    }
  }
  const SurfaceDistanceReport& d = fit.check.distance;
  fmt::print("{:40}{:5}{:8}{:7}{:9.4f}{:8.3f}{:8.3f}{:4}/{}{:7}{:8.2f}{:8.1f}{:8.1f}\n",
             std::filesystem::path(file).stem().string(), options.seed, fit.body.spheres.size(),
             fit.body.subtract.size(), 100 * d.mean, 100 * d.p99, 100 * d.max, fit.check.topology.components,
             target.components, fit.check.topology.genus, fit.body.blend_exponent * fit.body.a, cpu_seconds,
             wall.count());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Distances and cost of the base fit."};
  std::vector<std::string> files;
  ShapeFitOptions options;
  int seeds = 1, threads = 0;
  bool curve = false;
  app.add_option("meshes", files)->required();
  app.add_option("--spheres", options.spheres);
  app.add_option_function<std::string>("--kernel",
                                       [&](const std::string& word) { options.kernel = kernel_of(word); })
      ->type_name("WORD");
  app.add_option("--subtract", options.subtract, "share of the metaballs that may be subtractive");
  app.add_option("--points", options.points, "0 = as fit_shape");
  app.add_option("--generations", options.generations);
  app.add_option("--seed", options.seed, "of the first fit");
  app.add_option("--seeds", seeds, "fits of each body");
  app.add_option("--check", options.check_resolution, "cells along the longest side of the measured mesh");
  app.add_option("--threads", threads, "0 = all");
  app.add_flag("--curve", curve, "print the convergence too");
  CLI11_PARSE(app, argc, argv);
  const ThreadLimit limit(threads);
  fmt::print("{:40}{:>5}{:>8}{:>7}{:>9}{:>8}{:>8}{:>6}{:>7}{:>8}{:>8}{:>8}\n", "body", "seed", "add", "take",
             "mean %", "p99 %", "max %", "parts", "genus", "kappa", "CPU s", "wall s");
  for (const std::string& file : files) {
    for (int k = 0; k < seeds; ++k) {
      ShapeFitOptions own = options;
      own.seed += static_cast<std::uint64_t>(k);
      fit_and_print(file, own, curve);
    }
  }
}
