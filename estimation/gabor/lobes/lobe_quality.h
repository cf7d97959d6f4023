// How well the final lobes of a fit describe the photo. None of these figures is small by construction.
#pragma once

#include <vector>

#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {

// An octave of frequencies |f|.
struct BandVariance {
  double lowest = 0.0, highest = 0.0;  // cycles per pixel
  double photo = 0.0, noise = 0.0;     // shares of the photo's variance in this octave
};

struct LobeQuality {
  // The optimal-transport distance of the lobes' spectrum from the raw periodogram, and what the true
  // spectrum itself would score: a value of one periodogram is the truth times an exponential variate, so a
  // perfect model is 0.477 away. A mean of several periodograms scatters less.
  double periodogram_distance = 0.0;
  double perfect_distance = 0.0;
  // The distance of the lobes' spectrum from the true one, with the scatter taken out of the distance above.
  // 0: as good as can be told.
  double residual = 0.0;
  // A residual above this makes the fit weak (see judge_lobes).
  double weak_above = 0.0;
  // The octaves in which photo or noise have variance, the lowest first.
  std::vector<BandVariance> bands;
  // The share of the variance that lies in the right octave: the sum over the bands of the smaller share. It
  // is 1 for a perfect fit.
  double band_overlap = 0.0;

  bool weak() const { return residual > weak_above; }
};

// Let I = S g be the periodogram with the true spectrum S, let F be the lobes' spectrum, T the sum of I, and
// c = E sqrt(g), which is sqrt(pi)/2 for one periodogram. The distances d from I and t from S satisfy
//
//   d^2 = sum (sqrt F - sqrt I)^2 / T,    E d^2 = (sum F + T)/T - 2 c sum sqrt(F S) / T,
//   t^2 = (sum F + T)/T - ((sum F + T)/T - d^2) / c,
//
// and the perfect model F = S scores d^2 = 2 - 2 c. t^2 has the standard deviation s = 2 sqrt(2 v n sum F^2)
// / sum F, where v = Var(sqrt(g)/c - g/2) is 0.0232 for one periodogram, the 2 under the root stands for f
// and -f, and n for the correlation of neighbours under a taper.
//
// A perfect fit of lobes still inherits the error e of the estimate that it was fitted to
// (SpectrumEstimate::standard_error). A fit is weak if t^2 is above e^2 + 3 s + kVisibleResidual^2.
inline constexpr double kVisibleResidual = 0.1;  // half a per cent of the variance at wrong frequencies

// `fitted` and `periodogram` have one grid; `estimate_error` is e.
LobeQuality judge_lobes(const PowerSpectrum& fitted, const PowerSpectrum& periodogram, double estimate_error);

// E sqrt(g) for a Gamma variate g of mean 1 and variance `scatter`, (0, 1].
double mean_root(double scatter);

}  // namespace astrolith
