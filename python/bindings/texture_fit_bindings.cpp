// fit_texture(): a photo becomes layers of Gabor noise or an exemplar layer, as fit_gabor does it.
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "estimation/gabor/fit_memory.h"
#include "estimation/gabor/photo_fit.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/files/output_folder.h"
#include "python/bindings/arrays.h"
#include "python/bindings/fit_bindings.h"
#include "python/bindings/job.h"
#include "recipe/recipe_json.h"
#include "tasks/estimation/exemplar_recipe.h"
#include "tasks/estimation/photo_outputs.h"
#include "tasks/estimation/photo_recipe.h"

namespace astrolith::python {
namespace {

struct TextureArguments {
  std::string name;                              // of the file, or "image"
  std::optional<std::vector<GreyImage>> planes;  // in place of the file
  std::string model, output, report;             // output, report: empty for none
  double most_bytes = 0.0;
  bool spectrum = false;  // whether the spectra of the lobes are wanted
  PhotoFitOptions fit;
  PhotoRecipeOptions recipe;
  Options options;
};

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

struct FittedTexture {
  Fitted fitted;
  SpectraArray spectra;  // empty where they were not asked for
};

// Results that cannot be written are refused before the work.
void require_results(const TextureArguments& a) {
  const std::string input = a.planes ? "" : a.name;
  if (!a.output.empty()) {
    require_writable(a.output);
    if (a.model != "gabor") require_writable(exemplar_image_of(a.output));
    if (a.model != "gabor" && !input.empty()) require_other_file(exemplar_image_of(a.output), input);
  }
  if (!a.report.empty()) make_output_folder(a.report);
}

void check_memory(const TextureArguments& a) {
  const ImageSize size =
      a.planes ? ImageSize{a.planes->front().width, a.planes->front().height} : read_image_size(a.name);
  const double bytes = predicted_fit_bytes(size, a.fit, !a.report.empty());
  if (bytes <= a.most_bytes) return;
  throw InputError(
      fmt::format("{}: fitting {} x {} pixels needs {:.2f} GB of memory, more than {:.2f} GB; cut out a "
                  "part, scale it down or raise max_memory",
                  a.name, size.width, size.height, bytes / 1e9, a.most_bytes / 1e9));
}

PreparedExemplar prepare(const TextureArguments& a, JobState& state, std::vector<std::string>& remarks) {
  const PhotoFitOptions& fit = a.fit;
  ColorImageFile photo;
  if (a.planes) {
    photo.planes = *a.planes;
    for (GreyImage& plane : photo.planes) {
      flatten_exemplar_photo(plane, fit.detrend_degree, fit.trend, a.name);
    }
  } else {
    photo = read_exemplar_photo(a.name, fit.colors, fit.detrend_degree, fit.trend);
    remarks = photo.remarks;
  }
  return prepare_photo(photo.planes, a.name, fit.seed, state.progress("exemplar"));
}

void state_origin(const TextureArguments& a, Recipe& recipe) {
  Provenance provenance = provenance_of("fit_gabor", a.planes ? "" : a.name, a.options);
  provenance.achieved = std::move(recipe.provenance.achieved);
  recipe.provenance = std::move(provenance);
}

Fitted written_exemplar(const TextureArguments& a, const PreparedExemplar& prepared,
                        nlohmann::ordered_json figures) {
  Recipe recipe = exemplar_recipe(prepared, a.recipe);
  state_origin(a, recipe);
  write_exemplar_recipe(recipe, a.output);
  figures["model"] = "exemplar";
  return {"", figures.dump()};
}

// The textures of the lobes: for the report, and to tell which model is nearer to the photo. Returns whether
// an exemplar is.
bool compare_textures(const TextureArguments& a, const PhotoFit& photo, const Recipe& recipe,
                      const std::optional<PreparedExemplar>& exemplar, JobState& state,
                      nlohmann::ordered_json& figures) {
  const auto syntheses = synthesize_channels(photo, recipe, state.progress("synthesis"));
  figures["variance_ratio_synthesized"] = synthesized_variance_ratio(photo, syntheses);
  if (!a.report.empty()) write_reports(a.name, photo, syntheses, a.report);
  if (!exemplar) return false;
  const TextureScore lobes = score_of_lobes(photo, syntheses.front());
  figures["gabor"] = {{"values", lobes.values}, {"filters", lobes.filters}};
  return exemplar->scores[static_cast<int>(exemplar->variant)].sum() < lobes.sum();
}

FittedTexture fit(const TextureArguments& a, JobState& state) {
  require_results(a);
  nlohmann::ordered_json figures;
  std::vector<std::string> remarks;
  std::optional<PreparedExemplar> exemplar;
  if (a.model != "gabor") {
    exemplar = prepare(a, state, remarks);
    figures.update(exemplar_figures(*exemplar));
    figures["remarks"] = remarks;
  }
  if (a.model == "exemplar") return {written_exemplar(a, *exemplar, std::move(figures)), {}};
  check_memory(a);
  const Progress pursuit = state.progress("pursuit");
  const PhotoFit photo =
      a.planes ? fit_planes(*a.planes, a.name, a.fit, pursuit) : fit_photo(a.name, a.fit, pursuit);
  Recipe recipe = photo_recipe(photo, a.recipe);
  state_origin(a, recipe);
  figures["model"] = "gabor";
  figures.update(photo_figures(photo));
  figures["remarks"] = photo.remarks;
  SpectraArray spectra;
  if (a.spectrum) spectra = fitted_spectra(photo);
  const bool more = (exemplar || !a.report.empty()) && !state.stopped();
  if (more && compare_textures(a, photo, recipe, exemplar, state, figures)) {
    return {written_exemplar(a, *exemplar, std::move(figures)), std::move(spectra)};
  }
  if (!a.output.empty()) write_recipe(recipe, a.output);
  return {{recipe_to_json(recipe), figures.dump()}, std::move(spectra)};
}

// The spectra as an array of (layers x height x width) or (height x width), or None.
std::optional<NumpyArray<double>> array_of_spectra(SpectraArray&& spectra) {
  if (spectra.power.empty()) return std::nullopt;
  const auto side = [&](std::size_t k) { return static_cast<std::size_t>(spectra.shape[k]); };
  if (spectra.shape.size() == 2) return array_of<double>(std::move(spectra.power), {side(0), side(1)});
  return array_of<double>(std::move(spectra.power), {side(0), side(1), side(2)});
}

// What a fit gives: the recipe, empty for an exemplar layer, whose recipe lies in the file `output`; the
// figures; the spectra where they were asked for.
using TextureResult = std::tuple<std::string, std::string, std::optional<NumpyArray<double>>>;

TextureResult fit_texture(const std::string& name, const std::optional<Planes>& image,
                          const std::string& model, const std::string& output, const std::string& report,
                          double most_bytes, bool spectrum, bool colors, int detrend, bool by_division,
                          int lobes, double mm_per_px, const std::string& unit, double height_rms, bool tiles,
                          bool periodogram, bool fista, double penalty, double gap, const Options& given,
                          std::uint64_t seed, int threads, nb::object progress) {
  TextureArguments arguments{name, {}, model, output, report, most_bytes, spectrum, {}, {}, given};
  PhotoFitOptions& options = arguments.fit;
  options.colors = colors;
  options.detrend_degree = detrend;
  options.trend = by_division ? TrendModel::kMultiplied : TrendModel::kAdded;
  options.fit.target = periodogram ? SpectrumTarget::kPeriodogram : SpectrumTarget::kSmoothed;
  options.fit.solver = fista ? PursuitSolver::kFista : PursuitSolver::kWorkingSet;
  options.fit.max_lobes = lobes;
  options.fit.penalty_ratio = penalty;
  options.fit.relative_gap = gap;
  options.seed = seed;
  if (image) arguments.planes = planes_of(*image);
  const std::string stem = image ? "" : std::filesystem::path(name).stem().string();
  arguments.recipe = {stem,       mm_per_px, unit,
                      height_rms, seed,      tiles ? GaborEvaluation::kTiles : GaborEvaluation::kImpulses};
  FittedTexture made =
      run_job(std::move(progress), threads, [arguments](JobState& state) { return fit(arguments, state); });
  return {made.fitted.json, made.fitted.figures, array_of_spectra(std::move(made.spectra))};
}

}  // namespace

void declare_texture_fit(nb::module_& module) {
  module.def("fit_texture", &fit_texture, nb::arg("name"), nb::arg("image").noconvert().none(),
             nb::arg("model"), nb::arg("output"), nb::arg("report"), nb::arg("most_bytes"),
             nb::arg("spectrum"), nb::arg("colors"), nb::arg("detrend"), nb::arg("by_division"),
             nb::arg("lobes"), nb::arg("mm_per_px"), nb::arg("unit"), nb::arg("height_rms"), nb::arg("tiles"),
             nb::arg("periodogram"), nb::arg("fista"), nb::arg("penalty"), nb::arg("gap"), nb::arg("options"),
             nb::arg("seed"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace astrolith::python
