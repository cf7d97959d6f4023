// The module astrolith._estimation: fits of shapes and photos, classes of shapes. It links FFTW and
// CGAL, which are under the GPL.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cuda/candidates_on_gpu.h"
#include "cuda/device.h"
#include "descriptor/classification/class_folders.h"
#include "descriptor/classification/classifier_file.h"
#include "descriptor/classification/feature_table.h"
#include "estimation/shape/report/fit_report.h"
#include "numerics/errors.h"
#include "numerics/files/output_folder.h"
#include "numerics/files/sha256.h"
#include "numerics/version/code_version.h"
#include "python/bindings/arrays.h"
#include "python/bindings/fit_bindings.h"
#include "python/bindings/job.h"
#include "recipe/recipe_json.h"
#include "tasks/estimation/detail_layers.h"
#include "tasks/estimation/fit_time_limit.h"
#include "tasks/estimation/repaired_target.h"
#include "tasks/estimation/shape_recipe.h"
#include "tasks/repair/repair_words.h"

namespace astrolith::python {

std::string tool_named(const std::string& program) { return program + " " + kCodeVersion.text(); }

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

namespace {

// Layers that are added to the metaballs.
struct DetailArguments {
  bool base_only = false;
  int generations = 100;
  std::string details, micro;  // as fit_shape --details and --micro
  double mm_per_px = 0.0, micro_height = 0.0;
  std::string device;  // "auto", "cpu" or "cuda"

  bool keeps_relief() const { return details == "relief"; }
  // Whether the layers of another recipe are taken.
  bool transfers() const { return !keeps_relief() && details != "thesis"; }
};

struct ShapeArguments {
  std::string name, file;  // `file` is empty for arrays
  ShapeFitOptions fit;
  DetailArguments details;
  double time_limit = 0.0;  // seconds; 0 = none
  std::string unit, checkpoint, report;
  Options options;
  Repair repair;
};

// What a checkpoint knows a mesh by that has no file.
std::string hash_of(const TriangleMesh& mesh) {
  Sha256 hash;
  hash.update(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3d));
  hash.update(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
  return hash.hex();
}

// The GPU's evaluator, or null for the CPU.
std::unique_ptr<CandidateEvaluator> evaluator_on(const std::string& device) {
  const DeviceStatus status = device == "cpu" ? DeviceStatus{} : probe_device();
  if (status.usable) return candidates_on_gpu();
  if (device == "cuda") throw InputError("device: no cuda: " + status.reason + "; leave it out for the CPU");
  return {};
}

// Inputs and results that cannot be used are refused before the work.
void check_files(const ShapeArguments& a) {
  Recipe unused;
  if (a.details.transfers()) unused.layers = read_details(a.details.details).layers;
  if (!a.details.micro.empty() && a.details.micro != "auto") {
    add_micro_layers(a.details.micro, a.details.mm_per_px, a.details.micro_height, unused);
  }
  if (!a.report.empty()) require_folder_can_be_made(a.report);
}

// The images of layers that another recipe gave: their paths become relative to the current folder.
void find_images_from_here(Recipe& recipe) {
  for (Layer& layer : recipe.layers) {
    NamedImage* named = image_of(layer);
    if (named != nullptr && named->pixels != nullptr) {
      named->image = std::filesystem::proximate(named->pixels->file).generic_string();
    }
  }
}

// Adds the layers that the arguments ask for, with their figures.
void add_details(const TargetBody& target, const ShapeArguments& a, FitCheckpoint& checkpoint,
                 TimeLimit& limit, JobState& state, Recipe& recipe, nlohmann::ordered_json& figures) {
  const DetailArguments& wanted = a.details;
  if (wanted.micro == "auto") {
    add_residual_texture(target, a.fit.seed, limit.guard(state.progress("micro"), "micro"), recipe);
  } else if (wanted.base_only) {
    // The micro layers alone.
  } else if (wanted.transfers()) {
    transfer_details(read_details(wanted.details), recipe);
    find_images_from_here(recipe);
  } else if (wanted.keeps_relief()) {
    try {
      figures = relief_json(add_relief(target, limit.guard(state.progress("relief"), "relief"), recipe));
    } catch (const InputError& e) {  // a model of few facets keeps its metaballs alone
      figures = {{"remark", e.what()}};
    }
  } else {
    const std::unique_ptr<CandidateEvaluator> evaluator = evaluator_on(wanted.device);
    const DetailsFitResult found =
        add_searched_details(target, a.fit, wanted.generations, checkpoint.log(), evaluator.get(),
                             checkpoint.guard(limit.guard(state.progress("details"), "details")), recipe);
    checkpoint.save();
    figures = details_json(found);
  }
  if (!wanted.micro.empty() && wanted.micro != "auto") {
    add_micro_layers(wanted.micro, wanted.mm_per_px, wanted.micro_height, recipe);
  }
}

// Ends the preparation of the mesh when the time is over or Ctrl-C was pressed.
Progress preparation(const TimeLimit& limit, const JobState& state) {
  constexpr double kReadShare = 0.2;
  return [&state, timed = limit.preparation(kReadShare)](double fraction, std::string_view words) {
    if (state.stopped()) throw WorkError("stopped while the mesh was checked; nothing was fitted yet");
    return report(timed, fraction, words);
  };
}

Fitted fit_shape(TriangleMesh mesh, const ShapeArguments& arguments, TimeLimit& limit, JobState& state) {
  const std::string array_hash = arguments.file.empty() ? hash_of(mesh) : "";
  const RepairedTarget made =
      repaired_target(std::move(mesh), arguments.name, arguments.unit, arguments.repair.strict,
                      arguments.repair.options(), state.progress("repair"), preparation(limit, state));
  const TargetBody& target = made.target;
  Provenance provenance = provenance_of("fit_shape", arguments.file, arguments.options);
  FitCheckpoint checkpoint(arguments.checkpoint, {provenance.tool, kCodeVersion.changes,
                                                  provenance.input_sha256 + array_hash, arguments.options});
  const auto stage = [&](const std::string& name) { return limit.guard(state.progress(name), name); };
  const auto stopped = [&] { return state.stopped(); };
  ShapeFitResult fit = fit_base(target, arguments.fit, checkpoint, stage, stopped);
  if (fit.interrupted && stopped()) measure_fit(target, arguments.fit, fit);
  Recipe recipe;
  recipe.length_unit = arguments.unit;
  recipe.body = fit.body;
  const bool counts_bytes = arguments.fit.bytes > 0;  // every other field would take some
  if (!counts_bytes) {
    recipe.seed = arguments.fit.seed;
    recipe.provenance = std::move(provenance);
  }
  nlohmann::ordered_json details;
  const bool with_details = !arguments.details.base_only || !arguments.details.micro.empty();
  if (with_details && !stopped() && limit.allows_more()) {
    add_details(target, arguments, checkpoint, limit, state, recipe, details);
    measure_recipe(target, recipe, arguments.fit, fit);
  }
  if (!counts_bytes) note_achieved(fit, recipe);
  if (!arguments.report.empty() && !stopped()) {
    const std::filesystem::path file = arguments.name;
    const TriangleMesh likeness = likeness_for_report(recipe);
    write_fit_report(target, fit, file.filename().string(), arguments.report, nullptr,
                     likeness.triangles.empty() ? nullptr : &likeness);
  }
  nlohmann::ordered_json figures = fit_figures(fit);
  figures["stopped_early"] = stopped() || limit.reached();
  figures["diagonal"] = target.diagonal;
  std::vector<std::string> remarks = made.words;
  remarks.insert(remarks.end(), target.remarks.begin(), target.remarks.end());
  figures["remarks"] = remarks;
  if (!made.figures.is_null()) figures["repair"] = made.figures;
  if (!details.is_null()) figures[arguments.details.keeps_relief() ? "relief" : "details"] = details;
  return {recipe_to_json(recipe), figures.dump()};
}

// `spheres` 0: as many as follow from the bytes.
std::pair<std::string, std::string> fit_shape_in_job(
    const std::string& name, const std::optional<Rows<double>>& vertices,
    const std::optional<Rows<std::uint32_t>>& faces, int spheres, int bytes, double subtract,
    std::int64_t points, double tolerance, const std::string& optimizer, int population, int generations,
    bool base_only, const std::string& details, const std::string& micro, double mm_per_px,
    double micro_height, const std::string& device, double time_limit, const std::string& unit,
    const std::string& checkpoint, const std::string& report, bool strict, bool wrap, bool all_parts,
    const Options& options, std::uint64_t seed, int threads, nb::object progress) {
  const DetailArguments layers{base_only, generations, details, micro, mm_per_px, micro_height, device};
  ShapeArguments arguments{name, vertices ? "" : name, {},     layers,  time_limit,
                           unit, checkpoint,           report, options, {strict, wrap, all_parts}};
  arguments.fit.spheres = spheres > 0 ? spheres : spheres_for_bytes(bytes);
  arguments.fit.bytes = bytes;
  arguments.fit.length_unit = unit;
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
        check_files(arguments);
        TimeLimit limit(arguments.time_limit, "time_limit");
        return fit_shape(mesh ? *mesh : arguments.repair.read(arguments.name), arguments, limit, state);
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

// The repaired vertices and faces, and the figures.
std::tuple<NumpyArray<double>, NumpyArray<std::uint32_t>, std::string> repair_in_job(
    const std::string& name, const Rows<double>& vertices, const Rows<std::uint32_t>& faces, bool wrap,
    bool all_parts, const std::string& unit, nb::object progress) {
  MeshRepair repair =
      run_job(std::move(progress), 0, [=, mesh = mesh_of(vertices, faces, {})](JobState& state) {
        return repair_mesh(mesh, name, Repair{false, wrap, all_parts}.options(), state.progress("repair"));
      });
  nlohmann::ordered_json figures = repair_json(repair);
  figures["words"] = repair_words(repair, unit);
  const std::size_t n = repair.mesh.vertices.size(), m = repair.mesh.triangles.size();
  return {array_of<double>(std::move(repair.mesh.vertices), {n, 3}),
          array_of<std::uint32_t>(std::move(repair.mesh.triangles), {m, 3}), figures.dump()};
}

std::pair<std::vector<std::string>, std::vector<double>> classify(const std::string& model,
                                                                  const Rows<double>& vertices,
                                                                  const Rows<std::uint32_t>& faces,
                                                                  int threads, nb::object progress) {
  return run_job(std::move(progress), threads, [model, mesh = mesh_of(vertices, faces, {})](JobState& state) {
    const ShapeClassifier classifier = read_classifier(model);
    return std::pair(classifier.classes,
                     classifier.votes(shape_features(mesh, classifier.features, state.progress("describe"))));
  });
}

}  // namespace
}  // namespace astrolith::python

NB_MODULE(_estimation, module) {
  using namespace astrolith::python;
  namespace nb = nanobind;
  declare_common(module);
  declare_packing(module);
  declare_texture_fit(module);
  module.def("fit_shape", &fit_shape_in_job, nb::arg("name"), nb::arg("vertices").noconvert().none(),
             nb::arg("faces").noconvert().none(), nb::arg("spheres"), nb::arg("bytes"), nb::arg("subtract"),
             nb::arg("points"), nb::arg("tolerance"), nb::arg("optimizer"), nb::arg("population"),
             nb::arg("generations"), nb::arg("base_only"), nb::arg("details"), nb::arg("micro"),
             nb::arg("mm_per_px"), nb::arg("micro_height"), nb::arg("device"), nb::arg("time_limit"),
             nb::arg("unit"), nb::arg("checkpoint"), nb::arg("report"), nb::arg("strict"), nb::arg("wrap"),
             nb::arg("all_parts"), nb::arg("options"), nb::arg("seed"), nb::arg("threads"),
             nb::arg("progress").none());
  module.def("repair_mesh", &repair_in_job, nb::arg("name"), nb::arg("vertices").noconvert(),
             nb::arg("faces").noconvert(), nb::arg("wrap"), nb::arg("all_parts"), nb::arg("unit"),
             nb::arg("progress").none());
  module.def("train_classifier", &train_classifier_file, nb::arg("folders"), nb::arg("output"),
             nb::arg("kind"), nb::arg("bins"), nb::arg("points"), nb::arg("eigenvalues"), nb::arg("trees"),
             nb::arg("depth"), nb::arg("components"), nb::arg("seed"), nb::arg("threads"),
             nb::arg("progress").none());
  module.def("classify", &classify, nb::arg("model"), nb::arg("vertices").noconvert(),
             nb::arg("faces").noconvert(), nb::arg("threads"), nb::arg("progress").none());
}
