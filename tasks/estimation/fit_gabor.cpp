#include "tasks/estimation/fit_gabor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "estimation/gabor/image/image_reader.h"
#include "estimation/gabor/image/missing_ground.h"
#include "estimation/gabor/image/square_pixels.h"
#include "estimation/gabor/photo_fit.h"
#include "estimation/gabor/spectrum/photo_period.h"
#include "numerics/errors.h"
#include "numerics/files/npy_file.h"
#include "numerics/files/output_file.h"
#include "numerics/files/sha256.h"
#include "numerics/length_unit.h"
#include "numerics/memory_use.h"
#include "numerics/process_limits.h"
#include "numerics/sample_statistics.h"
#include "tasks/estimation/photo_recipe.h"
#include "tasks/job/output_names.h"
#include "tasks/job/pixel_size.h"
#include "tasks/job/words.h"

namespace astrolith {
namespace {

// Photos whose spectrum holds less than this share of their variance get a note.
constexpr double kMostVariance = 0.95;

// The photo, and the preparation of its colours and its brightness.
void add_photo_options(OptionTable& app, PhotoFitArguments& o) {
  app.add_option(
         "image", o.image,
         "photo (PNG, JPEG, WebP) or raster (TIFF, GeoTIFF, JPEG 2000, ISIS cube, PDS image and others), at "
         "least 32 x 32. Alpha is ignored, of several pages or frames the first is taken. A height map "
         "states "
         "the size of its pixels, its heights and what is missing, and then needs no --mm-per-px and no "
         "--height-rms")
      .required()
      .reads();
  app.add_option(
         "-o,--output", o.output,
         "recipe to write, with one Gabor layer (up to three with --channels pca) or, of the models phase "
         "and exemplar, one layer whose image becomes RECIPE_exemplar.png beside it")
      .required()
      .writes([](const auto& words) {
        return std::vector<std::filesystem::path>{words.front(), exemplar_image_path(words.front())};
      });
  app.add_option(
         "--model", o.model,
         "how the texture is made: gabor (noise with the photo's spectrum in a few lobes), phase (an image "
         "of noise with the whole spectrum), exemplar (the photo itself, tiled and blended) or auto (the "
         "simplest of those whose textures are nearest to squares of the photo that the model has not "
         "seen, by the distributions of values and of up to 12 filter responses)")
      .check(one_of({"gabor", "phase", "exemplar", "auto"}));
  app.add_option(
         "--border", o.border,
         "how an exemplar goes on beyond the photo's border: periodic (without light from one side, which "
         "does not repeat), matched (the same, in the photo's own grey values) or mirrored (the photo "
         "itself; a texture that runs at a slant then runs both ways, and light comes from four sides); "
         "without it the one whose textures are nearest to the photo in values, filters and direction")
      .check(one_of({"periodic", "matched", "mirrored"}))
      .default_text("");
  app.add_option(
         "--channels", o.channels,
         "what is fitted: luminance (one layer; of colours the luma 0.2126 R + 0.7152 G + 0.0722 B of "
         "the values as stored, gamma-encoded) or pca (a layer for each principal axis of the "
         "colours; synth --texture then paints in colour). With pca an exemplar keeps the colours of "
         "its image, and its height is that of their luma")
      .check(one_of({"luminance", "pca"}));
  Option detrend =
      app.add_option(
             "--detrend", o.photo.detrend_degree,
             "first take out slow changes of brightness, such as light from one side: a polynomial of "
             "this degree in x and y, fitted to all pixels; 0 = none")
          .check(in_range(0, kLargestTrendDegree));
  app.add_option("--detrend-by", o.detrend_by,
                 "how slow changes are taken out: subtraction (v - t + mean, for height maps) or division (v "
                 "mean / t, for photos whose "
                 "contrast falls off with the light)")
      .check(one_of({"subtraction", "division"}))
      .needs(detrend);
}

// The size of the layer and of its recipe.
void add_layer_options(OptionTable& app, PhotoFitArguments& o) {
  app.add_option("--lobes", o.photo.fit.max_lobes, "keep at most this many lobes in a layer")
      .check(in_range(1, 1000));
  const Option width =
      app.add_option("--mm-per-px", o.mm_per_px,
                     "size of an image pixel on the ground in millimetres; without it the size that the file "
                     "states, else "
                     "lengths in the recipe are pixels")
          .check(above_zero())
          .default_text("");
  app.add_option(
         "--mm-per-px-y", o.mm_per_px_y,
         "height of a pixel where it is not its width; pixels then become square ones with the longer side")
      .check(above_zero())
      .default_text("")
      .needs(width);
  app.add_option(
         "--height-unit", o.height_unit,
         "the values of the file are heights in this unit, such as ft, dm or US survey foot, whatever the "
         "file says")
      .placeholder("UNIT")
      .default_text("");
  app.add_option(
         "--raw-size", o.raw_size,
         "the file holds numbers alone, in so many columns and rows: floats of 32 bits (.r32), or whole "
         "numbers of 16 or 8 bits, the lowest byte first")
      .placeholder("WxH")
      .default_text("");
  app.add_option("--unit", o.unit, "length unit of the recipe where the size of pixels is known")
      .check(one_of({"m", "km"}));
  app.add_option(
         "--height-rms", o.height_rms,
         "standard deviation of the layer's height in the recipe's length unit. Brightness is not height: "
         "without this the layer has the heights of a height map, and of another image its own contrast "
         "(full "
         "scale = 1)")
      .check(zero_or_more())
      .default_text("");
}

void add_pursuit_options(OptionTable& app, PhotoFitArguments& o) {
  app.add_option("--penalty", o.photo.fit.penalty_ratio,
                 "sparsity penalty over the largest useful one; smaller finds more lobes")
      .check(in_range(1e-4, 0.99));
  app.add_option(
         "--gap", o.photo.fit.relative_gap,
         "stop the pursuit at this certified relative duality gap; selection and refinement then change "
         "the lobes")
      .check(in_range(1e-8, 0.5));
}

// The limit of memory, and the files that can be written beside the recipe.
void add_output_options(OptionTable& app, PhotoFitArguments& o) {
  app.add_option("--max-memory", o.max_memory_gb,
                 "refuse fits that are predicted to need more gigabytes of memory; without it three quarters "
                 "of the machine's")
      .check(above_zero())
      .default_text("");
  app.add_option(
         "--report", o.report_folder,
         "folder for a page, index.html, with photo and texture as reliefs to turn; for a figure, "
         "report.png and report.svg, of both and their spectra, of the lobes and the gap of the pursuit, "
         "or of the grey values and the layer's image; and for its pictures pixel by pixel")
      .placeholder("DIR")
      .writes(texture_report_files);
  app.add_option(
         "--spectrum", o.spectrum_file,
         "write the power spectrum of the lobes, or of a texture of another model, on the image's DFT grid "
         "(.npy, float64, frequency 0 first, |DFT|^2 / (width height)); images above 1024 pixels use a "
         "grid of at most 1024; with several layers an array (layers, height, width)")
      .placeholder("FILE.npy")
      .writes();
}

// What the options say of the file that the file does not say. Throws InputError for an unknown unit.
ImageWords image_words(const PhotoFitArguments& o) {
  ImageWords words{o.height_unit, {}};
  if (!o.height_unit.empty() && !(unit_metres(o.height_unit) > 0.0))
    throw InputError("--height-unit: \"" + o.height_unit +
                     "\" is no unit of length; write m, km, cm, ft, ftUS, in ...");
  if (o.raw_size.empty()) return words;
  constexpr int kMostSide = 1 << 20;
  const PixelSize size = parse_pixel_size("--raw-size", o.raw_size, 1, kMostSide);
  words.raw_size = ImageSize{size.width, size.height};
  return words;
}

// Predicts the memory of the fit before the image is decoded. Throws InputError where the fit needs more than
// allowed.
void predict_memory(Job& job, const PhotoFitArguments& o, const PhotoFitOptions& photo) {
  const ImageSize size = o.in_memory ? ImageSize{o.in_memory->front().width, o.in_memory->front().height}
                                     : read_image_size(o.image, image_words(o));
  const double predicted = predicted_fit_bytes(size, photo, !o.report_folder.empty(), o.model != "gabor");
  job.summary["predicted"] = {{"peak_bytes", predicted}};
  if (predicted > memory_limit(o.max_memory_gb)) {
    throw InputError(
        fmt::format("{}: fitting {} x {} pixels needs {:.2f} GB of memory, more than {:.2f} GB; "
                    "cut out a part, scale it down or raise --max-memory",
                    o.image, size.width, size.height, predicted / 1e9, memory_limit(o.max_memory_gb) / 1e9));
  }
  constexpr double kWorthSaying = 1e9;
  if (predicted > kWorthSaying) {
    job.say(fmt::format("{}: {} x {} pixels, about {:.1f} GB of memory", o.image, size.width, size.height,
                        predicted / 1e9));
  }
}

// A photo that repeats itself is one period as often as it has room for. Its spectrum has lines and nothing
// between them, which no few lobes resemble.
void take_one_period(const PhotoFitArguments& o, Job& job, std::vector<GreyImage>& planes) {
  if (o.has_gaps) return;  // gaps break the repetition
  const PhotoPeriod period = find_period(planes, job.progress("photo"));
  if (!period.found()) return;
  planes = one_period(std::move(planes), period, kSmallestExemplarSide);
  job.summary["period"] = {{"x_px", period.x}, {"y_px", period.y}};
  const std::string words = period.x == period.y ? fmt::format("every {} pixels along x and y", period.x)
                            : period.y == 0      ? fmt::format("every {} pixels along x", period.x)
                            : period.x == 0      ? fmt::format("every {} pixels along y", period.y)
                                                 : fmt::format("every {} x {} pixels", period.x, period.y);
  job.say(fmt::format("{}: repeats itself {}; {} x {} pixels of it are fitted", o.image, words,
                      planes.front().width, planes.front().height));
}

PhotoRecipeOptions recipe_options(const Job& job, const PhotoFitArguments& o) {
  const bool in_metres = o.heights_in_metres && o.mm_per_px > 0.0;
  return {o.in_memory ? "" : std::filesystem::path(o.image).stem().string(),
          o.mm_per_px,
          o.unit,
          o.height_rms,
          job.seed,
          in_metres ? 1.0 / metres_per_unit(o.unit) : 1.0};
}

// Ground that would be steeper than this, on average, is in another unit than its pixels.
constexpr double kSteepest = 5.0;

double mean_step(const GreyImage& image) {
  double sum = 0.0;
  for (std::size_t i = 1; i < image.values.size(); ++i)
    sum += std::abs(image.values[i] - image.values[i - 1]);
  return sum / static_cast<double>(image.values.size());
}

// Refuses a size of pixels that the file states and no program should guess.
void require_known_sides(const StatedScale& scale, const GreyImage& heights, const std::string& name) {
  if (scale.unknown) {
    throw InputError(name +
                     ": PROJ cannot tell how large its pixels are on the ground; set PROJ_DATA to the folder "
                     "of proj.db if that is missing, or give --mm-per-px");
  }
  const bool steep = scale.heights && mean_step(heights) > kSteepest * scale.pixel_width;
  if (scale.like_degrees || (scale.perhaps_degrees && steep)) {
    throw InputError(fmt::format(
        "{}: its pixels of {:.4g} may be degrees, and no frame says so; give --mm-per-px, or state a frame "
        "(gdal_edit.py -a_srs)",
        name, scale.pixel_width));
  }
  if (scale.sheared) {
    throw InputError(
        fmt::format("{}: its pixels are {:.4g} m wide and {:.4g} m high, and slanted; project it to square "
                    "ones (gdalwarp), or "
                    "give --mm-per-px",
                    name, scale.pixel_width, scale.pixel_height));
  }
  constexpr double kSmallest = 1e-6, kLargest = 1e6;
  const double side = std::sqrt(scale.pixel_width * scale.pixel_height);
  if (side >= kSmallest && side <= kLargest) return;
  throw InputError(
      fmt::format("{}: states pixels of {:.4g} m, which no map has; give --mm-per-px", name, side));
}

// The side in metres of the square pixels that the planes then have.
double make_square(std::vector<GreyImage>& planes, double width, double height,
                   std::vector<std::string>& words) {
  constexpr double kNearlySquare = 1.05;
  const auto [less, more] = std::minmax(width, height);
  if (more <= kNearlySquare * less) return std::sqrt(less * more);
  for (GreyImage& plane : planes) plane = with_square_pixels(plane, width, height);
  words.push_back(fmt::format("pixels of {:.5g} x {:.5g} m become square ones of {:.5g} m, {} x {} of them",
                              width, height, more, planes.front().width, planes.front().height));
  return more;
}

std::string in_brackets(const std::string& words) { return words.empty() ? "" : " (" + words + ")"; }

// What the file states of its scale is taken where no option gives it, and said.
void take_stated_scale(Job& job, ImageFile& photo, PhotoFitArguments& o) {
  const double missing = missing_share(photo.planes.front());
  o.has_gaps = missing > 0.0;
  std::vector<std::string> words;
  if (photo.scale && photo.scale->pixel_width > 0.0) {
    const StatedScale& s = *photo.scale;
    if (o.mm_per_px > 0.0) {
      words.push_back(fmt::format("--mm-per-px {:g} counts, and not the file's pixels of {:.7g} m{}",
                                  o.mm_per_px, s.pixel_width, in_brackets(s.pixel_source)));
    } else {
      require_known_sides(s, photo.planes.front(), o.image);
      const double side = make_square(photo.planes, s.pixel_width, s.pixel_height, words);
      o.mm_per_px = 1e3 * side;
      words.push_back(fmt::format("pixels of {:.7g} m{}", side, in_brackets(s.pixel_source)));
    }
  }
  if (o.mm_per_px_y > 0.0)
    o.mm_per_px = 1e3 * make_square(photo.planes, 1e-3 * o.mm_per_px, 1e-3 * o.mm_per_px_y, words);
  if (photo.scale && photo.scale->heights) {
    o.heights_in_metres = true;
    const double rms = std::sqrt(known_variance(photo.planes.front()));
    job.summary["image"]["height_rms"] = rms;
    words.push_back(fmt::format(
        "heights in metres{} of rms {:.4g} m{}", in_brackets(photo.scale->height_source), rms,
        o.height_rms >= 0.0 ? fmt::format(", where --height-rms {:g} counts", o.height_rms) : ""));
  }
  job.summary["image"]["missing"] = missing;
  if (o.mm_per_px > 0.0) job.summary["image"]["metres_per_pixel"] = 1e-3 * o.mm_per_px;
  if (missing > 0.0) words.push_back(fmt::format("{:.2g} % of the pixels are missing", 100.0 * missing));
  if (!words.empty()) job.say(fmt::format("{}: {}", o.image, fmt::join(words, "; ")));
  if (o.heights_in_metres && !(o.mm_per_px > 0.0) && !(o.height_rms >= 0.0))
    job.say(
        "note: the file states no size of pixels, so lengths are pixels and a height of 1 m is one; give "
        "--mm-per-px");
}

void set_provenance(const Job& job, const PhotoFitArguments& o, Recipe& recipe) {
  recipe.provenance.tool = job.tool();
  if (!o.in_memory) {
    recipe.provenance.input_name = std::filesystem::path(o.image).filename().string();
    recipe.provenance.input_sha256 = o.image_sha256;
  }
  recipe.provenance.options = job.options.given();
}

PhotoFitOptions photo_options(const Job& job, const PhotoFitArguments& o) {
  PhotoFitOptions photo = o.photo;
  photo.colors = o.channels == "pca";
  photo.trend = o.detrend_by == "division" ? TrendModel::kMultiplied : TrendModel::kAdded;
  photo.seed = job.seed;
  return photo;
}

// Options that are about lobes say nothing of the models without any.
void check_model(const Job& job, const PhotoFitArguments& o) {
  if (!o.border.empty() && o.model != "exemplar" && o.model != "auto") {
    throw InputError(
        fmt::format("--border: is of an exemplar, and --model {} has none; leave it out, or take "
                    "--model exemplar",
                    o.model));
  }
  if (o.model != "phase" && o.model != "exemplar") return;
  for (const char* name : {"--lobes", "--penalty", "--gap"}) {
    if (job.options.option(name).count() > 0) {
      throw InputError(
          fmt::format("{}: is about lobes, which --model {} has none of; leave it out", name, o.model));
    }
  }
}

void require_outputs(const PhotoFitArguments& o) {
  if (!o.output.empty()) {
    require_extension(o.output, {".json", ".astro"});
    require_writable(o.output);
    if (o.model != "gabor") require_writable(exemplar_image_path(o.output));
  } else if (o.model != "gabor") {
    throw InputError(
        "--output: is missing; a layer with an image wants a recipe's file, beside which the image lies");
  }
  if (!o.spectrum_file.empty()) require_extension(o.spectrum_file, {".npy"});
  if (!o.spectrum_file.empty()) require_writable(o.spectrum_file);
  if (!o.report_folder.empty()) make_output_folder(o.report_folder);
}

// What may mend a weak fit.
std::string remedy(const PhotoFit& photo, const PhotoFitArguments& o) {
  const bool full = std::any_of(photo.channels.begin(), photo.channels.end(), [&](const FittedChannel& c) {
    return static_cast<int>(c.fit.lobes.size()) >= o.photo.fit.max_lobes;
  });
  if (full) return fmt::format("allow more than {} --lobes", o.photo.fit.max_lobes);
  return o.photo.detrend_degree == 0 ? "try a smaller --penalty, or --detrend 2 against uneven light"
                                     : "try a smaller --penalty";
}

void say_lobes(const PhotoFit& photo, const PhotoFitArguments& o, const Job& job) {
  const std::size_t layers = photo.channels.size();
  job.say(fmt::format(
      "{}{}; pursuit gap {:.1e}; their spectrum is {:.3f} from the smoothed one of the photo and, speckle "
      "aside, "
      "{:.3f} from the photo's own (weak above {:.3f}), {:.1f} % of the variance in the right octave",
      counted(photo.lobes(), "lobe"), layers > 1 ? fmt::format(" in {} layers", layers) : "",
      photo.pursuit_gap(), photo.spectrum_distance(), photo.spectrum_residual(), photo.weak_above(),
      100.0 * photo.band_overlap()));
  if (photo.weak()) {
    job.say("note: weak fit: a good one would be nearer to the photo's spectrum; " + remedy(photo, o));
  }
  if (!photo.pursuit_reached()) job.say("note: the pursuit ended before the --gap asked for");
  const double held = photo.variance_in_spectrum();
  if (held < kMostVariance) {
    const GreyImage& image = photo.channels.front().exemplar;
    const bool cut = std::max(image.width, image.height) > o.photo.fit.largest_side;
    job.say(fmt::format(
        "note: {:.0f} % of the photo's variance lies in features wider than {}, which the noise lacks{}",
        100.0 * (1.0 - held),
        cut ? fmt::format("{} pixels", o.photo.fit.largest_side) : "it, or in light from one side",
        cut ? "; scale the photo down to that size to keep them" : ""));
  }
  job.say(photo.gaussianity().value().sentence);
}

// Names a slow change of brightness, which an exemplar repeats in each of its copies.
void say_uneven_light(const TextureFit& fit, const PhotoFitArguments& o, const Job& job) {
  constexpr double kWorthSaying = 0.1;
  const GreyImage photo = fit.luma();
  const double all = sample_variance(photo.values);
  const auto share = [&](int degree) {
    GreyImage rest = photo;
    remove_trend(rest, degree, TrendModel::kAdded, o.image);
    return 1.0 - sample_variance(rest.values) / all;
  };
  const double plane = share(1), bowl = share(2) - plane;
  if (o.heights_in_metres || plane + bowl < kWorthSaying) return;
  job.say(
      fmt::format("note: {:.0f} % of the photo's variance is {}; --detrend {} takes it out before the fit",
                  100.0 * (plane + bowl),
                  plane > bowl ? "a gradient of light, brighter on one side"
                               : "a vignette, or a light spot in the middle",
                  plane > bowl ? 1 : 2));
}

void say_exemplar(const PreparedExemplar& exemplar, const Job& job) {
  const TextureScore& score = exemplar.score();
  job.say(
      fmt::format("exemplar: {}; a texture of it differs from the photo itself by {:.3f} in values, {:.3f} "
                  "in filters and "
                  "{:.3f} in direction",
                  variant_word(exemplar.variant), score.values, score.filters, score.direction));
}

void say_phases(const TextureFit& fit, const Job& job) {
  const ExemplarImage& image = *fit.image->pixels;
  job.say(fmt::format("random phases: an image of {} x {} pixels with the photo's spectrum", image.width,
                      image.height));
  const double held = variance_in_phases(fit);
  if (held < kMostVariance) {
    job.say(fmt::format(
        "note: {:.0f} % of the photo's variance lies in features wider than it, or in light from one side, "
        "which random phases lack",
        100.0 * (1.0 - held)));
  }
  job.say(fit.gaussianity.value().sentence);
}

void say_gaps(const TextureFit& fit, const Job& job) {
  const GreyImage& part = fit.photo.front();
  job.say(fit.exemplar
              ? fmt::format("missing pixels: the exemplar is the largest part without gaps, {} x {} pixels",
                            part.width, part.height)
              : "missing pixels: for the spectrum, noise with the spectrum of the others stands in for them");
}

void say_result(const TextureFit& fit, const PhotoFitArguments& o, const Job& job) {
  if (o.mm_per_px > 0.0 && o.height_rms < 0.0 && !o.heights_in_metres) {
    job.say(fmt::format(
        "note: without --height-rms white is a height of 1 {}; half a pixel is --height-rms {:.3g}", o.unit,
        0.5e-3 * o.mm_per_px / metres_per_unit(o.unit)));
  }
  if (o.has_gaps) say_gaps(fit, job);
  if (fit.lobes) say_lobes(*fit.lobes, o, job);
  if (fit.model == TextureModel::kPhase) say_phases(fit, job);
  if (fit.exemplar) {
    say_exemplar(*fit.exemplar, job);
    say_uneven_light(fit, o, job);
  }
}

// Returns the spectra where they are wanted.
SpectraArray write_beside(const TextureFit& fit, const PhotoFitArguments& o, Job& job) {
  const FitTexture texture = synthesize_like_photo(fit, job.progress("synthesis"));
  job.summary["variance_ratio_synthesized"] = synthesized_variance_ratio(fit, texture);
  if (!o.report_folder.empty()) {
    write_texture_reports(std::filesystem::path(o.image).filename().string(), fit, texture, o.report_folder);
  }
  if (o.spectrum_file.empty() && !o.wants_spectra) return {};
  SpectraArray spectra = fitted_spectra(fit, texture);
  if (!o.spectrum_file.empty()) write_npy(spectra.power, spectra.shape, o.spectrum_file);
  return spectra;
}

}  // namespace

void declare_photo_fit(Job& job, PhotoFitArguments& o) {
  add_photo_options(job.options, o);
  add_layer_options(job.options, o);
  add_pursuit_options(job.options, o);
  add_output_options(job.options, o);
}

FittedPhoto fit_gabor(Job& job, PhotoFitArguments& o) {
  if (o.model == "gabor") job.keep_best_so_far();
  check_model(job, o);
  require_outputs(o);
  if (!o.in_memory) o.image_sha256 = file_sha256(o.image);
  predict_memory(job, o, photo_options(job, o));
  ImageFile photo;
  if (o.in_memory) {
    photo.planes = *o.in_memory;
    complete_planes(photo.planes, o.image, job.progress("photo"));
  } else {
    photo = read_image(o.image, o.channels == "pca", job.progress("photo"), image_words(o));
  }
  for (const std::string& remark : photo.remarks) job.say(o.image + ": " + remark);
  take_stated_scale(job, photo, o);
  const TextureFitOptions options{model_named(o.model), variant_named(o.border), photo_options(job, o),
                                  recipe_options(job, o)};
  if (!report(job.progress("photo"), 0.0, "read")) throw WorkError(o.image + ": stopped; nothing is written");
  flatten(photo.planes, o.image, options.photo);
  take_one_period(o, job, photo.planes);
  FittedPhoto result{fit_texture(std::move(photo.planes), o.image, options, job.stages()), {}};
  TextureFit& fit = result.fit;
  set_provenance(job, o, fit.recipe);
  if (!o.output.empty()) write_texture_recipe(fit, fit.recipe, o.output);
  job.summary.update(texture_figures(fit));
  if (fit.choice) job.say(choice_sentence(fit));
  if (job.stopped()) {
    job.say(std::string("stopped by ") + job.stopped_by() +
            ": the recipe holds the best so far; no synthesis, no report");
    return result;
  }
  result.spectra = write_beside(fit, o, job);
  job.summary["peak_bytes"] = peak_bytes();
  say_result(fit, o, job);
  return result;
}

}  // namespace astrolith
