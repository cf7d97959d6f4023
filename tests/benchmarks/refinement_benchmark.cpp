// The refinement of a base by our own Levenberg-Marquardt beside Ceres on the same residuals.
//
//   refinement_benchmark MESH...
//   refinement_benchmark --variants MESH...    # other settings of Ceres, with one thread
//
// The start is the model that fit_shape has after its last round of growth: the packing, the search of the
// global parameters and six rounds of growth with the refinement between them. Both solvers then refine this
// model on the same points. Ceres gets the residuals and the derivatives of ResidualBlocks, which an
// evaluation callback computes for all blocks at once. A cost function copies its block from there.
//
// The printed cost is half the sum of squares of all residuals, with lists made afresh for the final model.
#include <ceres/ceres.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>

#include "estimation/shape/fit/global_parameter_search.h"
#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/fit/tracked_model_internal.h"
#include "estimation/shape/packing/sphere_packing.h"
#include "estimation/shape/refinement/residual_blocks_internal.h"
#include "geometry/io/mesh_io.h"
#include "numerics/parallel_for.h"
#include "tests/benchmarks/processor_seconds.h"

namespace {

using namespace astrolith;

// The constants of fit_shape.cpp.
constexpr double kContainmentDepth = 0.015;
constexpr int kContainmentPoints = 2000;
constexpr double kShells[] = {0.008, 0.016, 0.032};

// A refinement problem: a start, the points and the options.
struct Body {
  TargetBody target;
  FitPoints points;
  RefinementOptions options;
  MetaballModel start;
};

MetaballModel packed_and_searched(const TargetBody& target, int spheres) {
  PackingOptions packing;
  packing.max_spheres = spheres / 2;
  const std::vector<Sphere> packed = pack_spheres(target.mesh, target.tree, packing).spheres;
  GlobalParameterSearchOptions search;
  search.max_spheres = static_cast<int>(packed.size());
  search.optimize.population = 20;
  search.optimize.max_evaluations = 400;
  return search_global_parameters(packed, sample_poisson_disk(target.surface, 800, 3), search).model;
}

// Grows the start as the adaptive fit does, up to the refinement that follows the last round of growth.
void grow_start(Body& body, const SurfaceSamples& samples, const FitPoints& containment, int spheres) {
  AdaptiveFitOptions options;
  options.spheres = spheres;
  const Progress silent;
  TrackedModel fit(body.target, samples, containment, options, silent);
  fit.start(packed_and_searched(body.target, spheres));
  fit.use_samples(static_cast<std::size_t>(options.samples_per_sphere * spheres));
  fit.refine_for(options.first_iterations);
  for (int left = options.rounds; left > 0; --left) {
    fit.grow(spheres, left, fit.last_distance());
    if (left > 1) fit.refine_for(options.round_iterations);
  }
  body.start = fit.model();
  body.points = fit.points();
  body.options.loss_scale = std::max(options.loss_scale, fit.last_distance());
  body.options.containment_weight = options.containment_weight;
  body.options.keep_centers_inside = &body.target.tree;
}

void make_problem(int spheres, Body& body) {
  const std::int64_t count = std::max(kFewestPoints, kPointsPerSphere * spheres);
  const SurfaceSamples samples =
      sample_poisson_disk(body.target.surface, count, 1, SampleNormals::interpolated);
  FitPoints containment;
  add_containment_points(body.target, kContainmentDepth, kContainmentPoints, 2, containment);
  for (const double distance : kShells) {
    add_shell_points(body.target, distance, static_cast<int>(count / 4), 8, containment);
  }
  grow_start(body, samples, containment, spheres);
}

// Copies one block of ResidualBlocks into Ceres. The parameter blocks are the block's spheres, then the
// sharpness.
class BlockCost : public ceres::CostFunction {
 public:
  explicit BlockCost(const ResidualBlock& block) : block_(block) {
    set_num_residuals(static_cast<int>(block.points.size()));
    mutable_parameter_block_sizes()->assign(block.neighbours.size(), 4);
    mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    std::copy(block_.residuals.begin(), block_.residuals.end(), residuals);
    if (jacobians == nullptr) return true;
    const std::size_t spheres = block_.neighbours.size();
    for (std::size_t k = 0; k < spheres; ++k) {
      if (jacobians[k] == nullptr) continue;
      for (std::size_t j = 0; j < block_.points.size(); ++j) {
        std::copy_n(block_.by_sphere[j * spheres + k].data(), 4, jacobians[k] + 4 * j);
      }
    }
    if (jacobians[spheres] != nullptr) {
      std::copy(block_.by_sharpness.begin(), block_.by_sharpness.end(), jacobians[spheres]);
    }
    return true;
  }

 private:
  const ResidualBlock& block_;
};

// The condition that the centre of one sphere lies inside the target.
class CenterCost : public ceres::SizedCostFunction<1, 4> {
 public:
  CenterCost(const ResidualBlocks& residuals, std::size_t sphere) : residuals_(residuals), sphere_(sphere) {}

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    const CenterCondition& condition = residuals_.center_conditions()[sphere_];
    residuals[0] = condition.residual;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      std::copy_n(condition.derivatives.data(), 4, jacobians[0]);
    }
    return true;
  }

 private:
  const ResidualBlocks& residuals_;
  std::size_t sphere_;
};

// Evaluates all blocks in parallel. Ceres writes its parameters into ours before it calls this.
class EvaluateAll : public ceres::EvaluationCallback {
 public:
  explicit EvaluateAll(ResidualBlocks& residuals) : residuals_(residuals) {}

  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override {
    if (evaluate_jacobians || new_evaluation_point) residuals_.evaluate();
  }

 private:
  ResidualBlocks& residuals_;
};

struct CeresSettings {
  std::string name;
  double radius = 1.0;            // of the trust region at the start; our damping starts at 1 / radius = 1
  int iterations_per_round = 12;  // after which the lists are made anew
  bool box = false;           // bounds of 0.3 radii about each centre and log radius at the start of a round
  bool nonmonotonic = false;  // steps may raise the cost for a while
  ceres::LinearSolverType solver = ceres::SPARSE_NORMAL_CHOLESKY;
  bool one_thread = false;  // in Ceres itself; the residuals are still evaluated by all threads
};

struct Outcome {
  MetaballModel model;
  int iterations = 0;
};

void set_box(ceres::Problem& problem, SphereDerivatives& sphere) {
  for (int k = 0; k < 4; ++k) {
    const double length = 0.3 * (k < 3 ? std::exp(sphere[3]) : 1.0), at = sphere[static_cast<std::size_t>(k)];
    problem.SetParameterLowerBound(sphere.data(), k, at - length);
    problem.SetParameterUpperBound(sphere.data(), k, at + length);
  }
}

ceres::Solver::Summary solve_round(RefinementParameters& parameters, ResidualBlocks& residuals,
                                   const CeresSettings& settings, const ceres::Solver::Options& solver) {
  EvaluateAll evaluation(residuals);
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &evaluation;
  ceres::Problem problem(problem_options);
  for (SphereDerivatives& s : parameters.spheres) problem.AddParameterBlock(s.data(), 4);
  problem.AddParameterBlock(&parameters.sharpness, 1);
  for (const ResidualBlock& block : residuals.blocks()) {
    std::vector<double*> blocks;
    for (const std::int32_t i : block.neighbours) {
      blocks.push_back(parameters.spheres[static_cast<std::size_t>(i)].data());
    }
    blocks.push_back(&parameters.sharpness);
    problem.AddResidualBlock(new BlockCost(block), nullptr, blocks);
  }
  for (std::size_t i = 0; i < parameters.spheres.size(); ++i) {
    problem.AddResidualBlock(new CenterCost(residuals, i), nullptr, parameters.spheres[i].data());
    if (settings.box) set_box(problem, parameters.spheres[i]);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary;
}

Outcome refine_with_ceres(const Body& body, const CeresSettings& settings, int threads) {
  RefinementParameters parameters(body.start);
  ceres::Solver::Options solver;
  solver.linear_solver_type = settings.solver;
  solver.num_threads = settings.one_thread ? 1 : threads;
  solver.use_nonmonotonic_steps = settings.nonmonotonic;
  // As in refine(), the rounds decide when to stop.
  solver.function_tolerance = solver.gradient_tolerance = solver.parameter_tolerance = 0.0;
  solver.logging_type = ceres::SILENT;
  solver.initial_trust_region_radius = settings.radius;
  Outcome outcome;
  while (outcome.iterations < body.options.max_iterations) {
    ResidualBlocks residuals(body.points, body.options, parameters);
    solver.max_num_iterations =
        std::min(settings.iterations_per_round, body.options.max_iterations - outcome.iterations);
    const ceres::Solver::Summary summary = solve_round(parameters, residuals, settings, solver);
    outcome.iterations += static_cast<int>(summary.iterations.size()) - 1;
    solver.initial_trust_region_radius = summary.iterations.back().trust_region_radius;
    if (summary.initial_cost - summary.final_cost <= body.options.relative_decrease * summary.initial_cost) {
      break;
    }
  }
  outcome.model = parameters.model();
  return outcome;
}

double cost_of(const Body& body, const MetaballModel& model) {
  const RefinementParameters parameters(model);
  ResidualBlocks residuals(body.points, body.options, parameters);
  residuals.evaluate();
  return residuals.cost();
}

// FNV-1a over the bits of the sharpness, the centres and the radii.
std::uint64_t hash_of(const MetaballModel& model) {
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&](double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (bits >> (8 * byte) & 0xffu)) * 1099511628211u;
  };
  add(model.sharpness);
  for (const ModelSphere& s : model.spheres) {
    for (const double value : {s.center.x, s.center.y, s.center.z, s.radius}) add(value);
  }
  return hash;
}

// Prints the least times of all repeats. Every repeat starts from the same model.
void measure(const Body& body, const std::string& name, int threads, int repeats, const auto& solve) {
  const ThreadLimit limit(threads);
  Outcome outcome;
  double cpu = std::numeric_limits<double>::infinity(), wall = cpu;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const auto start = std::chrono::steady_clock::now();
    cpu = std::min(cpu, processor_seconds([&] { outcome = solve(threads); }));
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    wall = std::min(wall, spent.count());
  }
  fmt::print("  {:26}{:8}{:9.2f}{:9.2f}{:14.5e}{:12}  {:016x}\n", name, threads, cpu, wall,
             cost_of(body, outcome.model), outcome.iterations, hash_of(outcome.model));
  std::fflush(stdout);
}

void measure_all(const Body& body, const std::vector<CeresSettings>& settings,
                 const std::vector<int>& threads, int repeats) {
  const auto own = [&](int) {
    const RefinementSummary summary = refine(body.start, body.points, body.options);
    return Outcome{summary.model, summary.iterations};
  };
  for (const int count : threads) measure(body, "refine()", count, repeats, own);
  for (const CeresSettings& one : settings) {
    for (const int count : threads) {
      measure(body, one.name, count, repeats, [&](int n) { return refine_with_ceres(body, one, n); });
    }
  }
}

constexpr ceres::LinearSolverType kSparse = ceres::SPARSE_NORMAL_CHOLESKY;

// The settings that did best, with all threads in Ceres and with one.
std::vector<CeresSettings> best_settings() {
  return {{"Ceres"}, {"Ceres, one thread inside", 1.0, 12, false, false, kSparse, true}};
}

std::vector<CeresSettings> other_settings() {
  return {{"Ceres"},
          {"Ceres, radius 100", 100.0},
          {"Ceres, radius 10000", 10000.0},
          {"Ceres, lists every 6", 1.0, 6},
          {"Ceres, lists every 20", 1.0, 20},
          {"Ceres, one list", 1.0, 1000000},
          {"Ceres, nonmonotonic", 1.0, 12, false, true},
          {"Ceres, box", 1.0, 12, true},
          {"Ceres, dense", 1.0, 12, false, false, ceres::DENSE_NORMAL_CHOLESKY}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Our refinement and Ceres on the same residuals."};
  std::vector<std::string> files;
  int spheres = 200, iterations = 60, repeats = 3;
  bool all = false;
  app.add_option("meshes", files)->required();
  app.add_option("--spheres", spheres, "metaballs of the start");
  app.add_option("--iterations", iterations, "of both solvers, at most");
  app.add_option("--repeats", repeats, "of each measurement; the least time counts");
  app.add_flag("--variants", all, "other settings of Ceres, with one thread");
  CLI11_PARSE(app, argc, argv);
  fmt::print("  {:26}{:>8}{:>9}{:>9}{:>14}{:>12}  {}\n", "solver", "threads", "CPU s", "wall s", "cost",
             "iterations", "parameters");
  for (const std::string& file : files) {
    Body body{prepare_target(read_mesh(file), file), {}, {}, {}};
    make_problem(spheres, body);
    body.options.max_iterations = iterations;
    fmt::print("{}: {} metaballs, {} points, cost {:.5e}\n", std::filesystem::path(file).stem().string(),
               body.start.spheres.size(),
               body.points.on_surface.size() + body.points.inside.size() + body.points.outside.size(),
               cost_of(body, body.start));
    if (all) {
      measure_all(body, other_settings(), {1}, 1);
    } else {
      measure_all(body, best_settings(), {1, 2}, repeats);
    }
  }
}
