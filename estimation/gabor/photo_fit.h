// From a photo to Gabor layers: removes its trend, and fits and judges each channel.
// Also predicts how much memory a fit takes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/gaussianity.h"
#include "estimation/gabor/image/image_channels.h"
#include "estimation/gabor/image/image_reader.h"

namespace astrolith {

struct PhotoFitOptions {
  bool colors = false;     // fit one layer per principal component of the colours, instead of the luma alone
  int detrend_degree = 0;  // degree of the trend that is removed first, 0 = none
  TrendModel trend = TrendModel::kAdded;
  GaborFitOptions fit;
  std::uint64_t seed = 1;  // seed of the surrogates in the test for Gaussianity
};

struct FittedChannel {
  GreyImage exemplar;
  std::optional<LayerColor> color;  // only where colours were fitted; the first channel holds the mean colour
  GaborFit fit;
  std::optional<Gaussianity> gaussianity;  // none where the fit was stopped

  // The variance that the lobes have, which is that of the periodogram.
  double variance() const { return fit.exemplar_rms * fit.exemplar_rms; }
  // The variance of the exemplar's pixels. It is larger than the above where segments lose wide features.
  double pixel_variance() const;
};

struct PhotoFit {
  std::vector<FittedChannel> channels;  // at least one, the largest variance first

  std::size_t lobes() const;
  // The largest certified gap of the channels' pursuits. Selection and refinement then change the lobes, so
  // it says nothing of the final ones.
  double pursuit_gap() const;
  bool pursuit_reached() const;      // every pursuit ended at the gap that was asked for
  bool refinement_reached() const;   // every refinement ended (GaborFit::refinement_reached)
  double spectrum_distance() const;  // distance of all fitted spectra together from all estimated spectra
  double spectrum_residual() const;  // distance from the photo's spectra (LobeQuality::residual)
  double weak_above() const;         // LobeQuality::weak_above of all channels together
  double band_overlap() const;       // LobeQuality::band_overlap of all channels together
  bool weak() const;                 // the fit of at least one channel is weak
  // The share of the photo's variance that the periodograms hold. Photos above largest_side lose features
  // that are wider than a segment.
  double variance_in_spectrum() const;
  // The judgement of the least plausible channel, with the smallest p-value of all channels. This p-value is
  // multiplied by the number of channels, since the least of several is small more often (Bonferroni). None
  // where the fit was stopped.
  std::optional<Gaussianity> gaussianity() const;
};

// Takes the trend of the options out of every plane. Smaller images than a fit takes stay as they are, since
// the fit refuses them with a better message. Throws as remove_trend does.
void flatten(std::vector<GreyImage>& planes, const std::string& name, const PhotoFitOptions& options);

// Fits an image, which messages call `name`: one plane of grey, or red, green and blue, all of one size. The
// trend is taken out already. Throws as fit_gabor_lobes does.
PhotoFit fit_planes(std::vector<GreyImage> planes, const std::string& name, const PhotoFitOptions& options,
                    const Progress& progress = {});

// The recipe's layer of a channel, without name and physical scale. Lengths are pixels. The height is the
// exemplar's own deviation in the first channel and 0 in the others.
GaborLayer make_gabor_layer(const FittedChannel& channel, bool first);

// The predicted peak memory, in bytes, of a program that fits an image of this size. It is the memory of the
// image while it is read and kept, and the memory of the pursuit for each point of the spectrum's grid. For
// 8-bit images the prediction was within a fifth of the measured peak. Deeper images take up to 20 bytes per
// pixel more while they are read. `report`: pictures of the fit are drawn too. `layer_image`: the layer may
// have an image, of the models phase and exemplar.
double predicted_fit_bytes(const ImageSize& image, const PhotoFitOptions& options, bool report,
                           bool layer_image);

}  // namespace astrolith
