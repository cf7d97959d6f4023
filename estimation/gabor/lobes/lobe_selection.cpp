#include "estimation/gabor/lobes/lobe_selection.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "estimation/gabor/pursuit/lobe_overlap.h"
#include "estimation/gabor/pursuit/nonnegative_quadratic.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/reported_loop.h"

namespace astrolith {
namespace {

LobeProfile lobe_profile(const SpectralLobe& lobe, int width, int height, double amplitude) {
  const double deviation = lobe_deviation(lobe.bandwidth);
  return make_lobe_profile(width, height, lobe.x * width, lobe.y * height, deviation * width,
                           deviation * height, amplitude);
}

// The least squares over heights, |sum_j x_j a_j - s|^2 = x'G x - 2 q'x + constant. The norm is weighted, and
// the columns a_j have unit norm.
struct HeightFit {
  std::vector<SpectralLobe> lobes;
  std::vector<double> norms;  // norms of the columns before scaling
  Eigen::MatrixXd G;
  Eigen::VectorXd q;
  Eigen::VectorXd x;

  void keep(const std::vector<Eigen::Index>& kept) {
    HeightFit smaller;
    for (const Eigen::Index i : kept) {
      smaller.lobes.push_back(lobes[static_cast<std::size_t>(i)]);
      smaller.norms.push_back(norms[static_cast<std::size_t>(i)]);
    }
    smaller.G = G(kept, kept);
    smaller.q = q(kept);
    smaller.x = x(kept);
    *this = std::move(smaller);
  }
  void solve_and_drop_zeros(const Progress& progress) {
    minimize_nonnegative_quadratic(G, q, x, std::numeric_limits<int>::max(), at_beginning(progress));
    if (!report(progress, 0.0, "selection")) throw WorkError("selection: stopped");
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      if (x(i) > 0.0) kept.push_back(i);
    }
    if (static_cast<Eigen::Index>(kept.size()) < x.size()) keep(kept);
  }
};

HeightFit set_up(std::vector<SpectralLobe> lobes, const PowerSpectrum& spectrum,
                 const std::vector<double>& weight, const Progress& progress) {
  HeightFit fit;
  const auto n = static_cast<Eigen::Index>(lobes.size());
  std::vector<double> metric(spectrum.power.size());
  std::vector<double> weighted(spectrum.power.size());
  for (std::size_t i = 0; i < metric.size(); ++i) {
    metric[i] = weight[i] * weight[i];
    weighted[i] = metric[i] * spectrum.power[i];
  }
  std::vector<LobeProfile> profiles;
  for (const SpectralLobe& lobe : lobes) {
    profiles.push_back(lobe_profile(lobe, spectrum.width, spectrum.height, 1.0));
    fit.norms.push_back(0.0);
  }
  parallel_for(0, n, [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    fit.norms[k] = std::sqrt(lobe_overlap(metric, profiles[k], profiles[k]));
    profiles[k].amplitude = 1.0 / fit.norms[k];
  });
  fit.G.resize(n, n);
  fit.q.resize(n);
  fit.x.resize(n);
  reported_parallel_for({0, n, n}, at_beginning(progress), "selection", [&](std::int64_t r) {
    const auto k = static_cast<std::size_t>(r);
    fit.q(r) = lobe_sum(weighted, profiles[k]);
    fit.x(r) = lobes[k].height * fit.norms[k];
    for (Eigen::Index c = 0; c <= r; ++c) {
      fit.G(r, c) = fit.G(c, r) =
          r == c ? 1.0 : lobe_overlap(metric, profiles[k], profiles[static_cast<std::size_t>(c)]);
    }
  });
  fit.lobes = std::move(lobes);
  return fit;
}

// The lobes that remain after the least needed ones are removed one by one. The removal of lobe j, with the
// others refitted, raises the sum of squares by x_j^2 / (G^-1)_jj and moves x by -(G^-1)_.j x_j / (G^-1)_jj.
// The inverse for the remaining lobes follows by a rank-one step, so each removal is cheap.
std::vector<Eigen::Index> most_needed(const HeightFit& fit, int count) {
  const Eigen::Index n = fit.x.size();
  const Eigen::MatrixXd ridged = fit.G + 1e-9 * Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd inverse = ridged.llt().solve(Eigen::MatrixXd::Identity(n, n));
  Eigen::VectorXd x = fit.x;
  std::vector<Eigen::Index> kept(static_cast<std::size_t>(n));
  std::iota(kept.begin(), kept.end(), Eigen::Index{0});
  while (static_cast<int>(kept.size()) > count) {
    // A lobe whose height became negative by the refits goes first.
    const auto rise = [&](Eigen::Index j) { return x(j) <= 0.0 ? x(j) : x(j) * x(j) / inverse(j, j); };
    const auto least = std::min_element(kept.begin(), kept.end(),
                                        [&](Eigen::Index a, Eigen::Index b) { return rise(a) < rise(b); });
    const Eigen::Index j = *least;
    const Eigen::VectorXd column = inverse.col(j) / inverse(j, j);
    x -= column * x(j);
    inverse -= column * inverse.row(j).eval();
    kept.erase(least);
  }
  return kept;
}

}  // namespace

std::vector<SpectralLobe> active_lobes(const GaborDictionary& dictionary, const std::vector<double>& x) {
  std::vector<SpectralLobe> lobes;
  for (std::size_t j = 0; j < x.size(); ++j) {
    if (x[j] <= 0.0) continue;
    const GaborAtom& atom = dictionary.atom(j);
    lobes.push_back({atom.bandwidth, static_cast<double>(atom.kx) / dictionary.width(),
                     static_cast<double>(atom.ky) / dictionary.height(), x[j] * dictionary.scale(j)});
  }
  return lobes;
}

std::vector<SpectralLobe> select_lobes(std::vector<SpectralLobe> lobes, const PowerSpectrum& spectrum,
                                       const std::vector<double>& weight, int max_lobes,
                                       const Progress& progress) {
  if (lobes.empty()) return lobes;
  HeightFit fit = set_up(std::move(lobes), spectrum, weight, progress);
  fit.solve_and_drop_zeros(progress);
  if (fit.x.size() > max_lobes) {
    fit.keep(most_needed(fit, max_lobes));
    fit.solve_and_drop_zeros(progress);
  }
  for (std::size_t k = 0; k < fit.lobes.size(); ++k) {
    fit.lobes[k].height = fit.x(static_cast<Eigen::Index>(k)) / fit.norms[k];
  }
  return fit.lobes;
}

std::vector<SpectralLobe> strongest_lobes(std::vector<SpectralLobe> lobes, int max_lobes, int width,
                                          int height) {
  if (static_cast<int>(lobes.size()) <= max_lobes) return lobes;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < lobes.size(); ++i)
    order.emplace_back(-lobe_variance(lobes[i], width, height), i);
  std::sort(order.begin(), order.end());
  std::vector<SpectralLobe> strongest;
  for (int k = 0; k < max_lobes; ++k) strongest.push_back(lobes[order[static_cast<std::size_t>(k)].second]);
  return strongest;
}

double lobe_variance(const SpectralLobe& lobe, int width, int height) {
  const LobeProfile profile = lobe_profile(lobe, width, height, 1.0);
  const double sum_x = std::accumulate(profile.x.begin(), profile.x.end(), 0.0);
  const double sum_y = std::accumulate(profile.y.begin(), profile.y.end(), 0.0);
  return 2.0 * lobe.height * (sum_x / width) * (sum_y / height);
}

PowerSpectrum layer_spectrum(const std::vector<GaborLobe>& lobes, int width, int height) {
  PowerSpectrum spectrum{width, height, {}};
  spectrum.power.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0);
  for (const GaborLobe& lobe : lobes) {
    const SpectralLobe unit{lobe.bandwidth, lobe.frequency_x, lobe.frequency_y, 1.0};
    add_lobe(lobe_profile(unit, width, height, 1.0), lobe.variance / lobe_variance(unit, width, height),
             spectrum.power);
  }
  spectrum.power[0] = 0.0;
  return spectrum;
}

}  // namespace astrolith
