// Which model of a photo's texture is taken: judged on squares of the photo that the model has not seen.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "estimation/gabor/exemplar/texture_score.h"
#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/image/grey_image.h"
#include "numerics/progress.h"

namespace astrolith {

// The models, the simplest first:
//   kGabor     Gabor noise of a few lobes
//   kPhase     random-phase noise with the photo's whole spectrum (phase_exemplar.h)
//   kExemplar  the photo itself, tiled and blended (exemplar_preparation.h)
enum class TextureModel { kGabor, kPhase, kExemplar };
inline constexpr TextureModel kTextureModels[] = {TextureModel::kGabor, TextureModel::kPhase,
                                                  TextureModel::kExemplar};
// "gabor", "phase", "exemplar".
std::string_view model_word(TextureModel model);

struct HeldOutScore {
  TextureScore mean;     // over the squares
  double scatter = 0.0;  // standard error of the mean of TextureScore::sum()
};

struct ModelChoice {
  TextureModel taken = TextureModel::kGabor;
  int squares = 0;  // that were compared; 0: too few with texture, and the simplest model is taken
  int side = 0;     // of a square, pixels; 0 where none was compared
  std::array<HeldOutScore, 3> scores;  // by the number of the model
  HeldOutScore photo;                  // of each square against the others, as if it were a texture
};

// Cuts a square of at most 256 pixels out of the middle of each quarter of the photo. Each model is fitted to
// each square, and two textures of it are scored against all other squares. Of the models whose scores are,
// in the mean of the logarithms of their ratios square by square, worse than the best one's by no more than
// the standard error, the simplest is taken. A score on the seen square itself would favour the model that
// copies it. Throws WorkError when `progress` asks to stop.
ModelChoice choose_model(const GreyImage& photo, const std::string& name, const GaborFitOptions& options,
                         std::uint64_t seed, const Progress& progress = {});

}  // namespace astrolith
