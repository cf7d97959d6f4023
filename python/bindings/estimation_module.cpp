// The module astrolith._estimation: fits of shapes and photos, classes of shapes. It links FFTW, which is
// under the GPL.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "descriptor/classification/class_folders.h"
#include "descriptor/classification/classifier_file.h"
#include "descriptor/classification/feature_table.h"
#include "estimation/gabor/photo_fit.h"
#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/version/code_version.h"
#include "python/bindings/arrays.h"
#include "python/bindings/job.h"
#include "recipe/recipe_json.h"
#include "recipe/sha256.h"
#include "tasks/estimation/photo_recipe.h"
#include "tasks/estimation/shape_recipe.h"

namespace astrolith::python {
namespace {

using Options = std::vector<std::pair<std::string, std::string>>;

// A recipe, and the figures of the fit as JSON.
struct Fitted {
  std::string json, figures;
};

std::string tool_named(const std::string& program) { return program + " " + kCodeVersion.text(); }

// The provenance of a fit to a file, or to arrays, which have no name.
Provenance provenance_of(const std::string& program, const std::string& file, const Options& options) {
  Provenance provenance;
  provenance.tool = tool_named(program);
  if (!file.empty()) {
    provenance.input_name = std::filesystem::path(file).filename().string();
    provenance.input_sha256 = sha256_of_file(file);
  }
  provenance.options = options;
  return provenance;
}

struct ShapeArguments {
  std::string name, file;  // `file` is empty for arrays
  ShapeFitOptions fit;
  bool base_only = false;
  int generations = 100;
  std::string unit, checkpoint;
  Options options;
};

// What a checkpoint knows a mesh by that has no file.
std::string hash_of(const TriangleMesh& mesh) {
  Sha256 hash;
  hash.update(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3d));
  hash.update(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
  return hash.hex();
}

Fitted fit_shape(TriangleMesh mesh, const ShapeArguments& arguments, JobState& state) {
  const std::string array_hash = arguments.file.empty() ? hash_of(mesh) : "";
  const TargetBody target = prepare_target(std::move(mesh), arguments.name);
  Provenance provenance = provenance_of("fit_shape", arguments.file, arguments.options);
  FitCheckpoint checkpoint(arguments.checkpoint, {provenance.tool, kCodeVersion.changes,
                                                  provenance.input_sha256 + array_hash, arguments.options});
  const auto stage = [&](const std::string& name) { return state.progress(name); };
  const auto stopped = [&] { return state.stopped(); };
  ShapeFitResult fit = fit_base(target, arguments.fit, checkpoint, stage, stopped);
  if (fit.interrupted && stopped()) measure_fit(target, arguments.fit, fit);
  Recipe recipe;
  recipe.length_unit = arguments.unit;
  recipe.seed = arguments.fit.seed;
  recipe.provenance = std::move(provenance);
  recipe.body = fit.body;
  nlohmann::ordered_json details;
  if (!arguments.base_only && !stopped()) {
    const DetailsFitResult found =
        add_searched_details(target, arguments.fit, arguments.generations, checkpoint.log(), nullptr,
                             checkpoint.guard(stage("details")), recipe);
    checkpoint.save();
    details = details_json(found);
    measure_recipe(target, recipe, arguments.fit, fit);
  }
  note_achieved(fit, recipe);
  nlohmann::ordered_json figures = fit_figures(fit);
  figures["stopped_early"] = stopped();
  figures["diagonal"] = target.diagonal;
  figures["remarks"] = target.remarks;
  if (!details.is_null()) figures["details"] = details;
  return {recipe_to_json(recipe), figures.dump()};
}

std::pair<std::string, std::string> fit_shape_in_job(
    const std::string& name, const std::optional<Rows<double>>& vertices,
    const std::optional<Rows<std::uint32_t>>& faces, const std::string& kernel, int spheres, double subtract,
    std::int64_t points, double tolerance, const std::string& optimizer, int population, int generations,
    bool base_only, const std::string& unit, const std::string& checkpoint, const Options& options,
    std::uint64_t seed, int threads, nb::object progress) {
  ShapeArguments arguments{name, vertices ? "" : name, {}, base_only, generations, unit, checkpoint, options};
  arguments.fit.kernel = *std::find_if(std::begin(kKernels), std::end(kKernels),
                                       [&](Kernel k) { return kernel_word(k) == kernel; });
  arguments.fit.spheres = spheres;
  arguments.fit.subtract = subtract;
  arguments.fit.points = points;
  arguments.fit.tolerance = tolerance;
  arguments.fit.optimizer = optimizer_from_name(optimizer);
  arguments.fit.population = population;
  arguments.fit.seed = seed;
  std::optional<TriangleMesh> mesh;
  if (vertices && faces) mesh = mesh_of(*vertices, *faces, {});
  const Fitted fitted =
      run_job(std::move(progress), threads, [arguments, mesh = std::move(mesh)](JobState& state) {
        return fit_shape(mesh ? *mesh : read_mesh(arguments.name), arguments, state);
      });
  return {fitted.json, fitted.figures};
}

using Planes = nb::ndarray<const double, nb::shape<-1, -1, -1>, nb::c_contig, nb::device::cpu>;

std::vector<GreyImage> planes_of(const Planes& image) {
  std::vector<GreyImage> planes;
  for (std::size_t k = 0; k < image.shape(0); ++k) {
    GreyImage plane{static_cast<int>(image.shape(2)), static_cast<int>(image.shape(1)), {}};
    const std::size_t pixels = image.shape(1) * image.shape(2);
    plane.values.assign(image.data() + k * pixels, image.data() + (k + 1) * pixels);
    planes.push_back(std::move(plane));
  }
  return planes;
}

std::pair<std::string, std::string> fit_texture(const std::string& name, const std::optional<Planes>& image,
                                                bool colors, int detrend, bool by_division, int lobes,
                                                double mm_per_px, const std::string& unit, double height_rms,
                                                bool periodogram, bool fista, double penalty, double gap,
                                                const Options& given, std::uint64_t seed, int threads,
                                                nb::object progress) {
  PhotoFitOptions options;
  options.colors = colors;
  options.detrend_degree = detrend;
  options.trend = by_division ? TrendModel::kMultiplied : TrendModel::kAdded;
  options.fit.target = periodogram ? SpectrumTarget::kPeriodogram : SpectrumTarget::kSmoothed;
  options.fit.solver = fista ? PursuitSolver::kFista : PursuitSolver::kWorkingSet;
  options.fit.max_lobes = lobes;
  options.fit.penalty_ratio = penalty;
  options.fit.relative_gap = gap;
  options.seed = seed;
  std::optional<std::vector<GreyImage>> planes;
  if (image) planes = planes_of(*image);
  const std::string stem = image ? "" : std::filesystem::path(name).stem().string();
  const Fitted fitted = run_job(std::move(progress), threads, [=](JobState& state) {
    const Progress pursuit = state.progress("pursuit");
    const PhotoFit photo =
        planes ? fit_planes(*planes, name, options, pursuit) : fit_photo(name, options, pursuit);
    Recipe recipe = photo_recipe(photo, {stem, mm_per_px, unit, height_rms, seed});
    Provenance provenance = provenance_of("fit_gabor", planes ? "" : name, given);
    provenance.achieved = std::move(recipe.provenance.achieved);
    recipe.provenance = std::move(provenance);
    nlohmann::ordered_json figures = photo_figures(photo);
    figures["remarks"] = photo.remarks;
    return Fitted{recipe_to_json(recipe), figures.dump()};
  });
  return {fitted.json, fitted.figures};
}

// The classifier that `classify train` writes for these folders.
void train_classifier_file(const std::vector<std::string>& folders, const std::string& output,
                           const std::string& kind, int bins, std::int64_t points, int eigenvalues, int trees,
                           int depth, int components, std::uint64_t seed, int threads, nb::object progress) {
  FeatureOptions features{feature_kind_from_name(kind), bins, eigenvalues, points, seed};
  check(features);
  TrainingOptions training;
  training.components = components;
  training.forest = {trees, depth, seed};
  run_job(std::move(progress), threads, [=](JobState& state) {
    const std::vector<std::filesystem::path> paths(folders.begin(), folders.end());
    const LabelledFiles files = find_classes(paths);
    const FeatureTable table = features_of_files(files.files, features, state.progress("describe"));
    if (!table.failures.empty()) throw InputError(table.failures.front());
    const ShapeClassifier classifier = train_classifier(labelled(files, table), features, training);
    if (state.stopped()) throw WorkError("stopped before the classifier was written");
    write_classifier(classifier, tool_named("classify"), output);
    return true;
  });
}

std::pair<std::vector<std::string>, std::vector<double>> classify(const std::string& model,
                                                                  const Rows<double>& vertices,
                                                                  const Rows<std::uint32_t>& faces,
                                                                  int threads, nb::object progress) {
  return run_job(std::move(progress), threads, [model, mesh = mesh_of(vertices, faces, {})](JobState&) {
    const ShapeClassifier classifier = read_classifier(model);
    return std::pair(classifier.classes, classifier.votes(shape_features(mesh, classifier.features)));
  });
}

}  // namespace
}  // namespace astrolith::python

NB_MODULE(_estimation, module) {
  using namespace astrolith::python;
  namespace nb = nanobind;
  declare_common(module);
  module.def("fit_shape", &fit_shape_in_job, nb::arg("name"), nb::arg("vertices").noconvert().none(),
             nb::arg("faces").noconvert().none(), nb::arg("kernel"), nb::arg("spheres"), nb::arg("subtract"),
             nb::arg("points"), nb::arg("tolerance"), nb::arg("optimizer"), nb::arg("population"),
             nb::arg("generations"), nb::arg("base_only"), nb::arg("unit"), nb::arg("checkpoint"),
             nb::arg("options"), nb::arg("seed"), nb::arg("threads"), nb::arg("progress").none());
  module.def("fit_texture", &fit_texture, nb::arg("name"), nb::arg("image").noconvert().none(),
             nb::arg("colors"), nb::arg("detrend"), nb::arg("by_division"), nb::arg("lobes"),
             nb::arg("mm_per_px"), nb::arg("unit"), nb::arg("height_rms"), nb::arg("periodogram"),
             nb::arg("fista"), nb::arg("penalty"), nb::arg("gap"), nb::arg("options"), nb::arg("seed"),
             nb::arg("threads"), nb::arg("progress").none());
  module.def("train_classifier", &train_classifier_file, nb::arg("folders"), nb::arg("output"),
             nb::arg("kind"), nb::arg("bins"), nb::arg("points"), nb::arg("eigenvalues"), nb::arg("trees"),
             nb::arg("depth"), nb::arg("components"), nb::arg("seed"), nb::arg("threads"),
             nb::arg("progress").none());
  module.def("classify", &classify, nb::arg("model"), nb::arg("vertices").noconvert(),
             nb::arg("faces").noconvert(), nb::arg("threads"), nb::arg("progress").none());
}
