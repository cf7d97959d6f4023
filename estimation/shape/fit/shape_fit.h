// Fits a body of metaballs to a closed mesh: the whole fit of thesis section 4.3 for the base shape.
//
//   ShapeFitResult fit = fit_shape(prepare_target(read_mesh("bennu.ply"), "bennu.ply"), ShapeFitOptions{});
//   recipe.body = fit.body;
//
// The global parameters of section 4.3.4, the number of spheres, the tensions a and b and the blend exponent
// m, are found with a derivative-free optimiser. A candidate is not meshed. Fixed points of the target's
// surface are projected onto the candidate's surface, and the surflet histogram of the projected points is
// compared with the histogram of the target's points:
//   fitness = 1 - similarity(target, candidate).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "descriptor/surface/evened_surface.h"
#include "estimation/optimize/optimizer.h"
#include "estimation/shape/fit/adaptive_fit.h"
#include "estimation/shape/fit/fit_check.h"
#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/target/target_body.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/progress.h"

namespace astrolith {

struct GlobalParameterSearchOptions {
  int max_spheres = 100;     // upper bound of the number of spheres, > 0
  OptimizeOptions optimize;  // algorithm, population, evaluations, seed
};

struct GlobalParameterSearchSummary {
  MetaballModel model;                            // the best candidate; its radii include sqrt(a/b)
  double a = 1.0, b = 1.0, blend_exponent = 1.0;  // its parameters
  double similarity = 0.0;                        // its similarity to the target, at most 1
  OptimizeResult optimization;
};

// `packing` is ordered by radius, the largest first, and not empty. `samples` are points and normals of the
// target's surface.
GlobalParameterSearchSummary search_global_parameters(const std::vector<Sphere>& packing,
                                                      const SurfaceSamples& samples,
                                                      const GlobalParameterSearchOptions& options,
                                                      const Progress& progress = {});

// The default number of surface samples for each metaball, and the least number in all. With fewer samples
// the fit follows the samples and not the body.
inline constexpr std::int64_t kPointsPerSphere = 120;
inline constexpr std::int64_t kFewestPoints = 4000;

struct ShapeFitOptions {
  int spheres = 200;        // number of metaballs, at most; 1 .. 10000
  double subtract = 0.5;    // share of the metaballs that may be subtractive, 0 .. 0.9
  std::int64_t points = 0;  // surface samples of the refinement, 100 .. 10000000; 0: kPointsPerSphere each
  // The most bytes of the body as a compact recipe without provenance, or 0. The numbers are then rounded to
  // these bytes, instead of seven digits.
  int bytes = 0;
  std::string length_unit = "km";  // of that recipe
  double tolerance = 0.0;          // growth stops at this mean distance, fraction of the diagonal, >= 0
  OptimizerAlgorithm optimizer = OptimizerAlgorithm::pso;
  int population = 20;                  // candidates in a generation of the optimiser, > 0
  int generations = 20;                 // of the optimiser, > 0: population * generations evaluations
  int check_resolution = 256;           // cells along the longest side of the mesh that is measured
  std::int64_t check_samples = 100000;  // fresh points of each surface for the final distances
  std::uint64_t seed = 1;
};

// The number of metaballs with which a compact recipe of so many bytes comes closest to its target, as far as
// this can be said for every body: 1 .. 10000.
int spheres_for_bytes(int bytes);
// The bytes of so many metaballs by the same measure.
int bytes_for_spheres(int spheres);

struct ShapeFitResult {
  MetaballBody body;       // in the file's frame and unit
  FitCheck check;          // measures the body, in the target's frame
  TriangleMesh base_mesh;  // of the metaballs alone where `check` measures details too; else empty
  std::optional<MeasuredSimilarity> similarity;  // of target and fit, where it was measured
  double filling_rate = 0.0;                     // the packing's volume over the target's
  double base_similarity = 0.0;                  // the best candidate of the search, on the search's samples
  int base_spheres = 0;                          // the number of spheres that the search chose
  std::int64_t evaluations = 0;                  // of the search's fitness
  std::vector<double> search_history;            // the least 1 - similarity after each generation
  std::vector<ConvergencePoint> convergence;     // after every refinement
  // Progress asked to stop: the body is the best so far, and nothing has measured it yet (measure_fit).
  bool interrupted = false;
};

// The stages of a fit are "pack", "search" and "refine". Equal targets, options and seeds give the same body
// for every number of threads. Throws InputError "parameter: range" for an option out of range, and
// InputError for a body in which no sphere fits.
ShapeFitResult fit_shape(
    const TargetBody& target, const ShapeFitOptions& options,
    const StageProgress& progress = [](const std::string&) { return Progress(); });

// Measures result.body as fit_shape does at its end: sets `check`.
void measure_fit(const TargetBody& target, const ShapeFitOptions& options, ShapeFitResult& result);

}  // namespace astrolith
