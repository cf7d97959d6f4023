#include "python/bindings/fit_bindings.h"

#include <nanobind/stl/optional.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "python/bindings/arrays.h"
#include "python/bindings/called_job.h"
#include "recipe/recipe_json.h"
#include "tasks/estimation/fit_gabor.h"
#include "tasks/estimation/fit_shape.h"

namespace nb = nanobind;

namespace astrolith::python {
namespace {

static_assert(sizeof(Sphere) == 4 * sizeof(double), "spheres are rows of x, y, z and radius");

// The images of layers that another recipe gave: their paths become relative to the current folder.
void find_images_from_here(Recipe& recipe) {
  for (Layer& layer : recipe.layers) {
    NamedImage* named = find_image(layer);
    if (named != nullptr && named->pixels != nullptr && !named->pixels->file.empty())
      named->image = std::filesystem::proximate(named->pixels->file).generic_string();
  }
}

// A mesh in memory with its unit; absent where the options name a file.
using GivenMesh = std::optional<std::tuple<Rows<double>, Rows<std::uint32_t>, std::string>>;

// The recipe and the figures as JSON; of a packing the (n x 4) centres and radii, and the masses.
using ShapeResult = std::tuple<std::string, std::string, NumpyArray<double>, std::vector<double>, bool>;

ShapeResult call_fit_shape(const GivenMesh& mesh, const GivenOptions& given, int threads,
                           nb::object progress) {
  FitArguments arguments;
  if (mesh) {
    const auto& [vertices, faces, unit] = *mesh;
    arguments.mesh = "mesh";
    arguments.in_memory = mesh_of(vertices, faces, {});
    arguments.unit = unit;
  }
  auto [json, figures, packing] = run_job(
      std::move(progress), threads, [arguments = std::move(arguments), given](JobState& state) mutable {
        CalledJob job("fit_shape", state);
        declare_fit_options(job, arguments);
        job.take(given);
        FittedShape fit = fit_shape(job, arguments);
        find_images_from_here(fit.recipe);
        return std::tuple(arguments.packing_only ? "" : recipe_to_json(fit.recipe), job.figures(),
                          std::move(fit.packing));
      });
  const std::size_t count = packing.spheres.size();
  return {json, figures, array_of<double>(std::move(packing.spheres), {count, 4}), std::move(packing.masses),
          packing.interrupted};
}

using Planes = nb::ndarray<const double, nb::shape<-1, -1, -1>, nb::c_contig, nb::device::cpu>;

std::vector<GreyImage> planes_of(const Planes& image) {
  std::vector<GreyImage> planes;
  const std::size_t pixels = image.shape(1) * image.shape(2);
  for (std::size_t k = 0; k < image.shape(0); ++k) {
    const double* const first = image.data() + k * pixels;
    planes.push_back(
        {static_cast<int>(image.shape(2)), static_cast<int>(image.shape(1)), {first, first + pixels}});
  }
  return planes;
}

// The spectra as an array of (layers x height x width) or (height x width), or None.
std::optional<NumpyArray<double>> array_of_spectra(SpectraArray&& spectra) {
  if (spectra.power.empty()) return std::nullopt;
  const auto side = [&](std::size_t k) { return static_cast<std::size_t>(spectra.shape[k]); };
  if (spectra.shape.size() == 2) return array_of<double>(std::move(spectra.power), {side(0), side(1)});
  return array_of<double>(std::move(spectra.power), {side(0), side(1), side(2)});
}

// The recipe, empty for a layer with an image, whose recipe lies in a file; the figures; the spectra where
// they were asked for.
using PhotoResult = std::tuple<std::string, std::string, std::optional<NumpyArray<double>>>;

PhotoResult call_fit_gabor(const std::optional<Planes>& image, bool spectrum, const GivenOptions& given,
                           int threads, nb::object progress) {
  PhotoFitArguments arguments;
  arguments.wants_spectra = spectrum;
  if (image) arguments.image = "image", arguments.in_memory = planes_of(*image);
  auto [json, figures, spectra] = run_job(
      std::move(progress), threads, [arguments = std::move(arguments), given](JobState& state) mutable {
        CalledJob job("fit_gabor", state);
        declare_photo_fit(job, arguments);
        job.take(given);
        FittedPhoto made = fit_gabor(job, arguments);
        return std::tuple(made.fit.lobes ? recipe_to_json(made.fit.recipe) : "", job.figures(),
                          std::move(made.spectra));
      });
  return {json, figures, array_of_spectra(std::move(spectra))};
}

// The options of the job of this name.
std::vector<OptionDescription> options_of(const std::string& name) {
  JobState unused;
  CalledJob job(name, unused);
  FitArguments shape;
  PhotoFitArguments photo;
  if (name == "fit_shape") declare_fit_options(job, shape);
  if (name == "fit_gabor") declare_photo_fit(job, photo);
  return descriptions_of(job.options);
}

}  // namespace

void declare_fits(nb::module_& module) {
  module.def("fit_shape", &call_fit_shape, nb::arg("mesh").none(), nb::arg("options"), nb::arg("threads"),
             nb::arg("progress").none());
  module.def("fit_gabor", &call_fit_gabor, nb::arg("image").noconvert().none(), nb::arg("spectrum"),
             nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  module.def("options_of", &options_of, nb::arg("job"));
}

}  // namespace astrolith::python
