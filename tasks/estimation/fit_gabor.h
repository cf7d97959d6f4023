// A photo of rock becomes layers of noise with its spectrum, or an exemplar of itself: the job of the program
// fit_gabor.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimation/gabor/photo_fit.h"
#include "tasks/estimation/texture_fit.h"
#include "tasks/estimation/texture_outputs.h"
#include "tasks/job/job.h"

namespace astrolith {

struct PhotoFitArguments {
  std::string image;                                // the file, or what messages call the photo in memory
  std::optional<std::vector<GreyImage>> in_memory;  // one plane, or red, green and blue, in place of the file
  bool wants_spectra = false;                       // in memory
  std::string image_sha256;                         // before it was read
  std::string output, report_folder, spectrum_file;  // empty: none
  std::string model = "gabor";
  std::string unit = "m";
  std::string channels = "luminance";
  std::string detrend_by = "subtraction";
  double mm_per_px = 0.0;                            // 0 = no physical scale
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
