// The textures of a photo's lobes, and the files that a fit writes beside the recipe.
#pragma once

#include <filesystem>
#include <vector>

#include "estimation/gabor/photo_fit.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

// The recipe's layers at unit variance and the exemplar's size, one for each channel, of the recipe's seed.
std::vector<std::vector<float>> synthesize_channels(const PhotoFit& photo, const Recipe& recipe,
                                                    const Progress& progress);

// Variance that the syntheses have, over that of the photo's pixels, all channels together.
double synthesized_variance_ratio(const PhotoFit& photo, const std::vector<std::vector<float>>& syntheses);

// Writes a figure for each channel. The first channel's figure lies in `folder` itself and shows colours
// where the photo was fitted in colour.
void write_reports(const std::filesystem::path& image, const PhotoFit& photo,
                   const std::vector<std::vector<float>>& syntheses, const std::filesystem::path& folder);

// Power spectra as one array: (height x width), or (channels x height x width) where there are several.
struct SpectraArray {
  std::vector<int> shape;
  std::vector<double> power;
};

// The spectra of the lobes: |DFT|^2 / (width height) on the grid of the image's DFT, frequency 0 first.
SpectraArray fitted_spectra(const PhotoFit& photo);

// Writes the fitted spectra as a .npy file.
void write_spectra(const PhotoFit& photo, const std::filesystem::path& file);

}  // namespace astrolith
