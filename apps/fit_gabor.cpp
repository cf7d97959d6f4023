// fit_gabor IMAGE -o RECIPE: a photo of rock becomes a layer of Gabor noise with the photo's spectrum.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "apps/program.h"
#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/gabor_report.h"
#include "estimation/gabor/gaussianity.h"
#include "estimation/gabor/image_reader.h"
#include "estimation/gabor/npy_file.h"
#include "numerics/output_file.h"
#include "recipe/recipe_json.h"
#include "recipe/sha256.h"
#include "synthesis/gabor_texture.h"

namespace astrolith {
namespace {

// Relative distance between fitted and estimated spectrum from which the fit is called poor: a photo of rock
// ends near 0.03, a raw periodogram of the true spectrum is 0.48 from it.
constexpr double kPoorDistance = 0.6;

struct Options {
  std::string image;
  std::string output;
  std::string report_folder;
  std::string spectrum_file;
  std::string target = "smoothed";
  std::string solver = "working-set";
  std::string unit = "m";
  double mm_per_px = 0.0;    // 0 = no physical scale
  double height_rms = -1.0;  // negative = the exemplar's own
  GaborFitOptions fit;
};

void add_options(Program& program, Options& o) {
  CLI::App& app = program.app;
  app.add_option("image", o.image,
                 "photo or height map: PNG, JPEG or TIFF, 8 or 16 bits or float, at least 32 x 32")
      ->required();
  app.add_option("-o,--output", o.output, "recipe to write, with one Gabor layer")->required();
  app.add_option("--lobes", o.fit.max_lobes, "keep at most this many lobes")->check(CLI::Range(1, 1000));
  app.add_option(
         "--mm-per-px", o.mm_per_px,
         "size of an image pixel on the ground in millimetres; without it lengths in the recipe are pixels")
      ->check(CLI::PositiveNumber)
      ->default_str("");
  app.add_option("--unit", o.unit, "length unit of the recipe where --mm-per-px is given")
      ->check(CLI::IsMember({"m", "km"}));
  app.add_option(
         "--height-rms", o.height_rms,
         "standard deviation of the layer's height in the recipe's length unit. Brightness is not height: "
         "without this the layer has the image's own contrast (full scale = 1), which is a height only if "
         "the image is a height map in that unit")
      ->check(CLI::NonNegativeNumber)
      ->default_str("");
  app.add_option(
         "--spectrum-estimate", o.target,
         "what the lobes are fitted to: smoothed (the periodogram smoothed as far as cross-validation "
         "allows, nearest to the true spectrum) or periodogram (raw, as in Galerne et al. 2012)")
      ->check(CLI::IsMember({"smoothed", "periodogram"}));
  app.add_option("--solver", o.solver, "of the basis pursuit; both end with the same certified optimum")
      ->check(CLI::IsMember({"working-set", "fista"}));
  app.add_option("--penalty", o.fit.penalty_ratio,
                 "sparsity penalty over the largest useful one; smaller finds more lobes")
      ->check(CLI::Range(1e-4, 0.99));
  app.add_option("--gap", o.fit.relative_gap, "stop the pursuit at this certified relative duality gap")
      ->check(CLI::Range(1e-8, 0.5));
  app.add_option("--report", o.report_folder,
                 "folder for pictures: exemplar, synthesis, both spectra, lobes, gap")
      ->option_text("DIR");
  app.add_option("--spectrum", o.spectrum_file,
                 "write the fitted power spectrum on the image's DFT grid (.npy, float64, frequency 0 first, "
                 "|DFT|^2 / (width height)); images above 1024 pixels use a grid of at most 1024")
      ->option_text("FILE.npy");
}

GaborLayer make_layer(const Options& o, const GaborFit& fit) {
  GaborLayer layer;
  layer.name = std::filesystem::path(o.image).stem().string();
  const double per_unit = o.unit == "km" ? 1e6 : 1e3;  // millimetres
  layer.pixel_size = o.mm_per_px > 0.0 ? o.mm_per_px / per_unit : 1.0;
  layer.exemplar_mean = fit.exemplar_mean;
  layer.exemplar_rms = fit.exemplar_rms;
  layer.height_rms = o.height_rms >= 0.0 ? o.height_rms : fit.exemplar_rms;
  layer.lobes = fit.lobes;
  return layer;
}

double variance_of(const std::vector<float>& values) {
  double mean = 0.0;
  for (const float v : values) mean += v;
  mean /= static_cast<double>(values.size());
  double square = 0.0;
  for (const float v : values) square += (v - mean) * (v - mean);
  return square / static_cast<double>(values.size());
}

double lobe_variance_ratio(const GaborFit& fit) {
  double sum = 0.0;
  for (const GaborLobe& lobe : fit.lobes) sum += lobe.variance;
  return sum / (fit.exemplar_rms * fit.exemplar_rms);
}

Recipe make_recipe(const Program& program, const Options& o, const GaborFit& fit) {
  Recipe recipe;
  recipe.length_unit = o.mm_per_px > 0.0 ? o.unit : "px";
  recipe.seed = program.seed;
  recipe.provenance.tool = program.tool();
  recipe.provenance.input_name = std::filesystem::path(o.image).filename().string();
  recipe.provenance.input_sha256 = sha256_of_file(o.image);
  recipe.provenance.options = program.given_options();
  recipe.provenance.achieved = {{"relative_duality_gap", fit.pursuit.relative_gap},
                                {"spectrum_distance", fit.spectrum_distance},
                                {"variance_ratio", lobe_variance_ratio(fit)}};
  recipe.layers.push_back(make_layer(o, fit));
  return recipe;
}

void summarize(const GaborFit& fit, const Gaussianity& gaussianity, Program& program) {
  auto& s = program.summary;
  s["lobes"] = fit.lobes.size();
  s["relative_duality_gap"] = fit.pursuit.relative_gap;
  s["spectrum_distance"] = fit.spectrum_distance;
  s["variance_ratio"] = lobe_variance_ratio(fit);
  s["variance_ratio_before_scaling"] = fit.variance_before_scaling;
  s["gaussianity"] = gaussianity.p_value;
  s["gaussianity_details"] = {{"plausible", gaussianity.plausible},
                              {"skewness", gaussianity.skewness},
                              {"excess_kurtosis", gaussianity.excess_kurtosis},
                              {"variance_spread", gaussianity.variance_spread},
                              {"sentence", gaussianity.sentence}};
  s["iterations"] = fit.pursuit.iterations;
  s["pursuit_lobes"] = fit.pursuit_lobes;
}

// The layer at unit variance and the exemplar's size: for pictures, and to measure what synthesis keeps.
std::vector<float> synthesize_like(const GreyImage& exemplar, GaborLayer layer, const Program& program) {
  layer.height_rms = 1.0;
  layer.pixel_size = 1.0;
  return synthesize_texture(layer, exemplar.width, exemplar.height, {program.seed},
                            program.progress("synthesis"));
}

void work(Program& program, Options o) {
  require_other_file(o.output, o.image);
  o.fit.target = o.target == "periodogram" ? SpectrumTarget::kPeriodogram : SpectrumTarget::kSmoothed;
  o.fit.solver = o.solver == "fista" ? PursuitSolver::kFista : PursuitSolver::kWorkingSet;
  require_writable(o.output);
  if (!o.spectrum_file.empty()) require_writable(o.spectrum_file);
  if (!o.report_folder.empty()) make_output_folder(o.report_folder);
  const ImageFile file = read_grey_image(o.image);
  for (const std::string& remark : file.remarks) program.say(o.image + ": " + remark);

  const GaborFit fit = fit_gabor_lobes(file.image, o.image, o.fit, program.progress("pursuit"));
  const Gaussianity gaussianity = test_gaussianity(file.image, program.seed);
  const Recipe recipe = make_recipe(program, o, fit);
  write_recipe(recipe, o.output);
  if (Program::interrupted()) {
    program.say("stopped by Ctrl-C: the recipe holds the best so far; no synthesis, no report");
    return summarize(fit, gaussianity, program);
  }
  const std::vector<float> synthesis =
      synthesize_like(file.image, std::get<GaborLayer>(recipe.layers.front()), program);
  if (!o.spectrum_file.empty())
    write_npy(fit.fitted.power, fit.fitted.height, fit.fitted.width, o.spectrum_file);
  if (!o.report_folder.empty()) write_gabor_report(file.image, synthesis, fit, o.report_folder);
  summarize(fit, gaussianity, program);
  program.summary["variance_ratio_synthesized"] = variance_of(synthesis);
  program.say(fmt::format(
      "{} lobes, certified relative duality gap {:.1e}, distance {:.3f} from the estimated spectrum",
      fit.lobes.size(), fit.pursuit.relative_gap, fit.spectrum_distance));
  if (fit.spectrum_distance > kPoorDistance) {
    program.say("note: the lobes miss much of the spectrum; allow more --lobes or a smaller --penalty");
  }
  program.say(gaussianity.sentence);
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  Program program(
      "fit_gabor",
      "Fits a layer of Gabor noise to a photo of rock: a sparse sum of Gaussians in its power spectrum, by "
      "non-negative basis pursuit with a certified duality gap.");
  Options options;
  add_options(program, options);
  return program.run(argc, argv, [&] { work(program, options); });
}
