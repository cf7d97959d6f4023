// The texture of a fitted photo, and the files that a fit writes beside the recipe.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "numerics/progress.h"
#include "tasks/estimation/texture_fit.h"

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

}  // namespace astrolith
