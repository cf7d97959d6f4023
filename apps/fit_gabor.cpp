// fit_gabor: a photo of rock becomes the layers of a recipe.
#include "tasks/estimation/fit_gabor.h"

#include "apps/program.h"

int main(int argc, char** argv) {
  astrolith::Program program(
      "fit_gabor",
      "Fits the texture of a photo of rock: Gabor noise, a sparse sum of Gaussians in its power spectrum, by "
      "non-negative basis pursuit with a certified duality gap; noise with its whole spectrum; or the photo "
      "itself as an exemplar. Of lobes the summary says how far their spectrum is from the photo's "
      "(spectrum_residual; 0: as good as can be told, above weak_above: weak), the share of the variance in "
      "the right octave (band_overlap) and the variance of a texture made of them over that of the photo's "
      "pixels (variance_ratio_synthesized).");
  astrolith::PhotoFitArguments arguments;
  astrolith::declare_photo_fit(program, arguments);
  return program.run(argc, argv, [&] { astrolith::fit_gabor(program, arguments); });
}
