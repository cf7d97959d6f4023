// The module astrolith._estimation: fits of shapes and photos, classes of shapes. It links FFTW and
// CGAL, which are under the GPL.
#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "descriptor/classification/classifier_file.h"
#include "descriptor/classification/feature_table.h"
#include "numerics/errors.h"
#include "numerics/version/code_version.h"
#include "python/bindings/arrays.h"
#include "python/bindings/fit_bindings.h"
#include "python/bindings/job.h"
#include "tasks/repair/mesh_repair.h"

namespace nb = nanobind;

namespace astrolith::python {
namespace {

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
    const FeatureTable table =
        read_features(files.files, features, read_mended_surface, state.progress("describe"));
    if (!table.failures.empty()) throw InputError(table.failures.front());
    const ShapeClassifier classifier = train_classifier(labelled(files, table), features, training);
    if (state.stopped()) throw WorkError("stopped before the classifier was written");
    write_classifier(classifier, "classify " + kCodeVersion.text(), output);
    return true;
  });
}

// The repaired vertices and faces, and the figures.
std::tuple<NumpyArray<double>, NumpyArray<std::uint32_t>, std::string> repair_in_job(
    const std::string& name, const Rows<double>& vertices, const Rows<std::uint32_t>& faces, bool wrap,
    bool fill_unseen, bool unite, bool all_parts, const std::string& unit, nb::object progress) {
  RepairOptions options;
  options.wrap = wrap;
  options.fill_unseen = fill_unseen;
  options.unite = unite;
  options.all_parts = all_parts;
  options.overlap = "rock counts twice, and walls lie inside it; union=True makes one surface of them";
  options.remedy = "repair it, or pass wrap=True";
  MeshRepair repair =
      run_job(std::move(progress), 0, [=, mesh = mesh_of(vertices, faces, {})](JobState& state) {
        // A file of points, too, is read here.
        return repair_mesh(mesh.vertices.empty() ? read_mesh_to_repair(name, wrap) : mesh, name, options,
                           state.progress("repair"));
      });
  nlohmann::ordered_json figures = repair_json(repair);
  figures["words"] = repair_words(repair, unit, options);
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
  declare_programs(module);
  declare_fits(module);
  module.def("repair_mesh", &repair_in_job, nb::arg("name"), nb::arg("vertices").noconvert(),
             nb::arg("faces").noconvert(), nb::arg("wrap"), nb::arg("fill_unseen"), nb::arg("unite"),
             nb::arg("all_parts"), nb::arg("unit"), nb::arg("progress").none());
  module.def("train_classifier", &train_classifier_file, nb::arg("folders"), nb::arg("output"),
             nb::arg("kind"), nb::arg("bins"), nb::arg("points"), nb::arg("eigenvalues"), nb::arg("trees"),
             nb::arg("depth"), nb::arg("components"), nb::arg("seed"), nb::arg("threads"),
             nb::arg("progress").none());
  module.def("classify", &classify, nb::arg("model"), nb::arg("vertices").noconvert(),
             nb::arg("faces").noconvert(), nb::arg("threads"), nb::arg("progress").none());
}
