// fit_texture(): a photo becomes layers of Gabor noise or a layer with an image, as fit_gabor does it.
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
#include "estimation/gabor/image/image_reader.h"
#include "estimation/gabor/photo_fit.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/files/output_folder.h"
#include "python/bindings/arrays.h"
#include "python/bindings/fit_bindings.h"
#include "python/bindings/job.h"
#include "recipe/recipe_json.h"
#include "tasks/estimation/exemplar_recipe.h"
#include "tasks/estimation/texture_fit.h"
#include "tasks/estimation/texture_outputs.h"

namespace astrolith::python {
namespace {

struct TextureArguments {
  std::string name;                              // of the file, or "image"
  std::optional<std::vector<GreyImage>> planes;  // in place of the file
  std::string model, output, report;             // output, report: empty for none
  double most_bytes = 0.0;
  bool spectrum = false;  // whether the spectra are wanted
  TextureFitOptions fit;
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
  const double bytes = predicted_fit_bytes(size, a.fit.photo, !a.report.empty(), a.model != "gabor");
  if (bytes <= a.most_bytes) return;
  throw InputError(
      fmt::format("{}: fitting {} x {} pixels needs {:.2f} GB of memory, more than {:.2f} GB; cut out a "
                  "part, scale it down or raise max_memory",
                  a.name, size.width, size.height, bytes / 1e9, a.most_bytes / 1e9));
}

void state_origin(const TextureArguments& a, Recipe& recipe) {
  Provenance provenance = provenance_of("fit_gabor", a.planes ? "" : a.name, a.options);
  provenance.achieved = std::move(recipe.provenance.achieved);
  recipe.provenance = std::move(provenance);
}

ColorImageFile photo_of(const TextureArguments& a) {
  if (a.planes) return {*a.planes, {}};
  return read_image(a.name, a.fit.photo.colors);
}

FittedTexture fit(const TextureArguments& a, JobState& state) {
  require_results(a);
  check_memory(a);
  ColorImageFile photo = photo_of(a);
  TextureFit fit = fit_texture(std::move(photo.planes), a.name, a.fit,
                               [&](const std::string& stage) { return state.progress(stage); });
  state_origin(a, fit.recipe);
  if (!a.output.empty()) write_texture_recipe(fit, fit.recipe, a.output);
  nlohmann::ordered_json figures = texture_figures(fit);
  figures["remarks"] = photo.remarks;
  SpectraArray spectra;
  const bool with_texture = !fit.lobes || !a.report.empty();
  if (!state.stopped() && (with_texture || a.spectrum)) {
    const FitTexture texture =
        with_texture ? synthesize_like_photo(fit, state.progress("synthesis")) : FitTexture{};
    if (with_texture) figures["variance_ratio_synthesized"] = synthesized_variance_ratio(fit, texture);
    if (!a.report.empty()) write_texture_reports(a.name, fit, texture, a.report);
    if (a.spectrum) spectra = fitted_spectra(fit, texture);
  }
  return {{fit.lobes ? recipe_to_json(fit.recipe) : "", figures.dump()}, std::move(spectra)};
}

// The spectra as an array of (layers x height x width) or (height x width), or None.
std::optional<NumpyArray<double>> array_of_spectra(SpectraArray&& spectra) {
  if (spectra.power.empty()) return std::nullopt;
  const auto side = [&](std::size_t k) { return static_cast<std::size_t>(spectra.shape[k]); };
  if (spectra.shape.size() == 2) return array_of<double>(std::move(spectra.power), {side(0), side(1)});
  return array_of<double>(std::move(spectra.power), {side(0), side(1), side(2)});
}

// What a fit gives: the recipe, empty for a layer with an image, whose recipe lies in the file `output`; the
// figures; the spectra where they were asked for.
using TextureResult = std::tuple<std::string, std::string, std::optional<NumpyArray<double>>>;

TextureResult fit_texture(const std::string& name, const std::optional<Planes>& image,
                          const std::string& model, const std::string& output, const std::string& report,
                          double most_bytes, bool spectrum, bool colors, int detrend, bool by_division,
                          int lobes, double mm_per_px, const std::string& unit, double height_rms, bool tiles,
                          double penalty, double gap, const Options& given, std::uint64_t seed, int threads,
                          nb::object progress) {
  TextureArguments arguments{name, {}, model, output, report, most_bytes, spectrum, {}, given};
  arguments.fit.model = model_named(model);
  PhotoFitOptions& options = arguments.fit.photo;
  options.colors = colors;
  options.detrend_degree = detrend;
  options.trend = by_division ? TrendModel::kMultiplied : TrendModel::kAdded;
  options.fit.max_lobes = lobes;
  options.fit.penalty_ratio = penalty;
  options.fit.relative_gap = gap;
  options.seed = seed;
  if (image) arguments.planes = planes_of(*image);
  const std::string stem = image ? "" : std::filesystem::path(name).stem().string();
  arguments.fit.recipe = {
      stem, mm_per_px, unit, height_rms, seed, tiles ? GaborEvaluation::kTiles : GaborEvaluation::kImpulses};
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
             nb::arg("penalty"), nb::arg("gap"), nb::arg("options"), nb::arg("seed"), nb::arg("threads"),
             nb::arg("progress").none());
}

}  // namespace astrolith::python
