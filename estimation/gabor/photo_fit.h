// From a photo's file to Gabor layers: reading, light taken out, channels, a fit and a judgement of each.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/gaussianity.h"
#include "estimation/gabor/image/detrend.h"

namespace astrolith {

struct PhotoFitOptions {
  bool colors = false;     // a layer for each principal component of the colours, instead of one of luma
  int detrend_degree = 0;  // of the trend taken out first, 0 = none
  TrendModel trend = TrendModel::kAdded;
  GaborFitOptions fit;
  std::uint64_t seed = 1;  // of the surrogates that judge
};

struct FittedChannel {
  GreyImage exemplar;
  std::optional<LayerColor> color;  // where colours were fitted; the first channel holds the mean colour
  GaborFit fit;
  Gaussianity gaussianity;

  double variance() const { return fit.exemplar_rms * fit.exemplar_rms; }
};

struct PhotoFit {
  std::vector<FittedChannel> channels;  // at least one, the largest variance first
  std::vector<std::string> remarks;     // of the image reader

  std::size_t lobes() const;
  double relative_gap() const;       // the largest of the channels' certified gaps
  double spectrum_distance() const;  // of all channels' fitted spectra from all estimated ones
  double variance_ratio() const;     // of the lobes over the exemplar's
  // The least plausible channel's judgement; its p-value is multiplied by the number of channels, since the
  // least of several is small more often (Bonferroni).
  Gaussianity gaussianity() const;
};

// Throws InputError as read_grey_image, remove_trend and fit_gabor_lobes do.
PhotoFit fit_photo(const std::filesystem::path& file, const PhotoFitOptions& options,
                   const Progress& progress = {});

// The recipe's layer of a channel without name and physical scale: lengths are pixels, the height is the
// exemplar's own deviation in the first channel and 0 in the others.
GaborLayer layer_of(const FittedChannel& channel, bool first);

}  // namespace astrolith
