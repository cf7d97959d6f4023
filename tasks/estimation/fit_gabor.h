// A photo of rock becomes layers of noise with its spectrum, or an exemplar of itself: the job of the program
// fit_gabor. It also makes the texture of the fit and the files beside the recipe.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "estimation/gabor/photo_fit.h"
#include "numerics/progress.h"
#include "tasks/estimation/texture_fit.h"
#include "tasks/job/job.h"

namespace astrolith {

// The texture of the recipe's layers at the photo's size and of the recipe's seed.
struct FitTexture {
  // Row-major: of each channel of lobes, of unit variance, or the heights of an image, in grey values of the
  // photo's luma.
  std::vector<std::vector<float>> channels;
  std::vector<float> rgb;  // the colours of an image that paints, full scale = 1; else empty
};
FitTexture synthesize_like_photo(const TextureFit& fit, const Progress& progress);

// Variance that the texture has, over that of the photo's pixels, all channels together.
double synthesized_variance_ratio(const TextureFit& fit, const FitTexture& texture);

// Writes a figure and a page for each channel of lobes, or for the image. Those of the first channel lie in
// `folder` itself and show colours where the photo was fitted in colour. `name` is the photo's.
void write_texture_reports(const std::string& name, const TextureFit& fit, const FitTexture& texture,
                           const std::filesystem::path& folder);

// Power spectra as one array: (height x width), or (channels x height x width) where there are several.
struct SpectraArray {
  std::vector<int> shape;
  std::vector<double> power;
};

// The spectra of the lobes, or the one estimated from the texture of an image: |DFT|^2 / (width height) on
// the grid of the photo's DFT, at most 1024, frequency 0 first.
SpectraArray fitted_spectra(const TextureFit& fit, const FitTexture& texture);

// The files of the reports in these folders.
std::vector<std::filesystem::path> texture_report_files(const std::vector<std::string>& folders);

struct PhotoFitArguments {
  std::string image;                                // the file, or what messages call the photo in memory
  std::optional<std::vector<GreyImage>> in_memory;  // one plane, or red, green and blue, in place of the file
  bool wants_spectra = false;                       // in memory
  std::string image_sha256;                         // before it was read
  std::string output, report_folder, spectrum_file;  // empty: none
  std::string model = "gabor";
  std::string border;  // of an exemplar; empty: the nearest
  std::string unit = "m";
  std::string channels = "luminance";
  std::string detrend_by = "subtraction";
  double mm_per_px = 0.0;                            // 0 = no physical scale
  double mm_per_px_y = 0.0;                          // of the height of a pixel; 0 = its width
  std::string height_unit;                           // empty: as the file says
  std::string raw_size;                              // "WxH" of a file of numbers alone; empty: it is none
  double height_rms = -1.0;                          // negative = the exemplar's own
  bool heights_in_metres = false, has_gaps = false;  // what the file is found to be while it is read
  double max_memory_gb = 0.0;                        // 0 = three quarters of the machine's
  PhotoFitOptions photo;
};

// Declares the options that fill in the arguments.
void declare_photo_fit(Job& job, PhotoFitArguments& arguments);

struct FittedPhoto {
  TextureFit fit;
  SpectraArray spectra;  // where a file or the caller wants them
};

// Fits the photo and writes the files that the arguments name. The summary gets the figures of the fit.
// Throws InputError for arguments that contradict one another, and for a photo that cannot be fitted or needs
// more memory than allowed.
FittedPhoto fit_gabor(Job& job, PhotoFitArguments& arguments);

}  // namespace astrolith
