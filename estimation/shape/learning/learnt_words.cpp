#include <fmt/format.h>

#include "estimation/shape/learning/learnt_details.h"

namespace astrolith {
namespace {

std::string noise_words(const SurfaceModel& model, double edge, const std::string& unit) {
  std::string words =
      fmt::format("noise: waves from {:.3g} {} down, gain {:.2g}", model.wavelength * edge, unit, model.gain);
  constexpr double kVisibleContrast = 0.15;
  if (model.contrast < kVisibleContrast) return words + ", alike everywhere";
  return words + fmt::format(", in rough and smooth regions some {:.3g} {} wide",
                             0.5 * model.mask_wavelength * edge, unit);
}

std::string landform_words(const SurfaceModel& model, double edge, const std::string& unit) {
  return fmt::format("{}: {:.0f} of {:.3g} to {:.3g} {}, exponent {:.2g}", name_of(model.landforms),
                     model.count, model.least * edge, model.greatest * edge, unit, model.exponent);
}

}  // namespace

std::vector<std::string> learnt_words(const LearntDetails& learnt, double scale, const std::string& unit) {
  std::vector<std::string> all;
  const double edge = learnt.edge * scale;
  bool landforms = false;
  for (const JudgedCandidate& candidate : learnt.candidates) {
    const bool has_landforms = candidate.model.landforms != LandformKind::none;
    if (!has_landforms && candidate.model.amplitude == 0.0) continue;
    landforms = landforms || has_landforms;
    const std::string words = has_landforms ? landform_words(candidate.model, edge, unit)
                                            : noise_words(candidate.model, edge, unit);
    all.push_back(words + (candidate.kept ? ", kept" : ", not kept, since " + candidate.reason));
  }
  if (!landforms && !learnt.interrupted) {
    all.push_back(
        fmt::format("no boulders and no craters: the target's heights are hardly more skewed than "
                    "the noise's ({:+.2f})",
                    learnt.skewness_lack));
  }
  if (learnt.smooth_share > 0.0) {
    all.push_back(
        fmt::format("{:.0f} % of the target is smooth, as ground that no camera saw, and gets no details",
                    100.0 * learnt.smooth_share));
  }
  return all;
}

}  // namespace astrolith
