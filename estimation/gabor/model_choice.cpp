#include "estimation/gabor/model_choice.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <span>
#include <string_view>
#include <vector>

#include "estimation/gabor/exemplar/exemplar_preparation.h"
#include "estimation/gabor/exemplar/phase_exemplar.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "numerics/progress.h"
#include "numerics/sample_statistics.h"
#include "synthesis/gabor/gabor_texture.h"

namespace astrolith {
namespace {

// Calls work(heed) on a thread of its own, and reports to `progress` from the caller's thread twenty times a
// second meanwhile. `heed` is a Progress that any thread may call: it keeps the fraction for the next report
// and returns false once progress has asked to stop. What work throws is thrown here. Without a progress the
// work is called at once, with none.
template <typename Work>
void watched_work(const Progress& progress, std::string_view words, const Work& work) {
  if (!progress) {
    work(Progress{});
    return;
  }
  std::atomic<bool> goes_on{true};
  std::atomic<double> fraction{0.0};
  std::future<void> done = std::async(std::launch::async, [&] {
    work([&](double done_so_far, std::string_view) {
      fraction = done_so_far;
      return goes_on.load();
    });
  });
  while (done.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
    if (!report(progress, fraction, words)) goes_on = false;
  }
  done.get();
}

constexpr int kMostSide = 256, kTextures = 2;
constexpr int kLeastSquares = 2;

// Whether a model can be fitted to a square: it has a tenth of the photo's contrast, and texture.
bool has_texture(const GreyImage& square, double photo_variance) {
  const double variance = sample_variance(square.values);
  return variance > 0.01 * photo_variance &&
         exemplar_periodogram(square).variance() > kLeastTexture * variance;
}

// The squares in the middles of the quarters that have texture.
std::vector<GreyImage> quarter_squares(const GreyImage& photo, int side) {
  std::vector<GreyImage> squares;
  const double variance = sample_variance(photo.values);
  for (const int row : {1, 3}) {
    for (const int column : {1, 3}) {
      const int left = column * photo.width / 4 - side / 2, top = row * photo.height / 4 - side / 2;
      GreyImage square = photo.part(std::clamp(left, 0, photo.width - side),
                                    std::clamp(top, 0, photo.height - side), side, side);
      if (has_texture(square, variance)) squares.push_back(std::move(square));
    }
  }
  return squares;
}

// A texture of lobes like the square that they were fitted to.
GreyImage lobe_texture(const GaborFit& fit, const GreyImage& square, std::uint64_t seed) {
  GaborLayer layer;
  layer.exemplar_rms = layer.height_rms = fit.exemplar_rms;
  layer.lobes = fit.lobes;
  const double mean = sample_mean(square.values);
  GreyImage texture{square.width, square.height, {}};
  for (const float v : synthesize_texture(layer, square.width, square.height, {seed, 0})) {
    texture.values.push_back(mean + double{v});
  }
  return texture;
}

std::vector<GreyImage> make_textures(TextureModel model, const GreyImage& square, const std::string& name,
                                     const GaborFitOptions& options, std::uint64_t seed,
                                     const Progress& heed) {
  std::vector<GreyImage> textures;
  if (model == TextureModel::kGabor) {
    const GaborFit fit = fit_gabor_lobes(square, name, options, heed);
    for (int t = 0; t < kTextures; ++t)
      textures.push_back(lobe_texture(fit, square, seed + static_cast<std::uint64_t>(t)));
    return textures;
  }
  const ExemplarLayer layer = model == TextureModel::kPhase
                                  ? phase_exemplar({square}, name, seed, heed)
                                  : prepare_exemplar(square, name, seed, heed).layer;
  for (int t = 0; t < kTextures; ++t)
    textures.push_back(exemplar_texture_like(layer, square, seed + static_cast<std::uint64_t>(t)));
  return textures;
}

std::vector<TextureDistributions> find_distributions(const std::vector<GreyImage>& images, int side) {
  std::vector<TextureDistributions> distributions;
  for (const GreyImage& image : images) distributions.emplace_back(image, side);
  return distributions;
}

// The mean score of textures of square `seen` against all other squares.
TextureScore held_out_score(std::span<const TextureDistributions> textures,
                            std::span<const TextureDistributions> squares, std::size_t seen) {
  TextureScore sum;
  int count = 0;
  for (const TextureDistributions& texture : textures) {
    for (std::size_t k = 0; k < squares.size(); ++k) {
      if (k == seen) continue;
      const TextureScore score = texture.score_against(squares[k]);
      sum.values += score.values;
      sum.filters += score.filters;
      ++count;
    }
  }
  return {sum.values / count, sum.filters / count};
}

double standard_error(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  return std::sqrt(sample_variance(values) / (n - 1.0));
}

using Scores = std::array<std::vector<TextureScore>, 3>;  // of each model, by the seen square

HeldOutScore summarize(const std::vector<TextureScore>& scores) {
  std::vector<double> values, filters, sums;
  for (const TextureScore& s : scores) {
    values.push_back(s.values);
    filters.push_back(s.filters);
    sums.push_back(s.sum());
  }
  return {{sample_mean(values), sample_mean(filters)}, standard_error(sums)};
}

// How far the squares are from each other: a texture of one square rarely comes nearer to the others.
HeldOutScore score_squares(std::span<const TextureDistributions> squares) {
  std::vector<TextureScore> scores;
  for (std::size_t k = 0; k < squares.size(); ++k)
    scores.push_back(held_out_score(squares.subspan(k, 1), squares, k));
  return summarize(scores);
}

// The logarithms of the scores of each model. Models are compared by ratios of scores, since a square unlike
// the others has scores that are larger for every model, and would outweigh them.
std::array<std::vector<double>, 3> log_scores(const Scores& scores) {
  std::array<std::vector<double>, 3> logs;
  for (std::size_t m = 0; m < scores.size(); ++m) {
    for (const TextureScore& s : scores[m]) logs[m].push_back(portable::log(std::max(s.sum(), 1e-9)));
  }
  return logs;
}

TextureModel simplest_best_model(const Scores& scores) {
  const std::array<std::vector<double>, 3> logs = log_scores(scores);
  const auto& best = *std::min_element(
      logs.begin(), logs.end(), [](const auto& a, const auto& b) { return sample_mean(a) < sample_mean(b); });
  const auto is_near = [&](const std::vector<double>& model) {
    std::vector<double> worse;
    for (std::size_t k = 0; k < model.size(); ++k) worse.push_back(model[k] - best[k]);
    return sample_mean(worse) <= standard_error(worse);
  };
  const auto simplest = std::find_if(logs.begin(), logs.end(), is_near);
  const auto* const taken = simplest == logs.end() ? &best : &*simplest;
  return static_cast<TextureModel>(taken - logs.data());
}

}  // namespace

std::string_view model_word(TextureModel model) {
  constexpr std::string_view kWords[] = {"gabor", "phase", "exemplar"};
  return kWords[static_cast<int>(model)];
}

ModelChoice choose_model(const GreyImage& photo, const std::string& name, const GaborFitOptions& options,
                         std::uint64_t seed, const Progress& progress) {
  ModelChoice choice;
  const int side = std::min(kMostSide, std::min(photo.width, photo.height) / 2);
  if (side < kSmallestExemplarSide) return choice;
  const std::vector<GreyImage> squares = quarter_squares(photo, side);
  if (static_cast<int>(squares.size()) < kLeastSquares) return choice;
  choice.squares = static_cast<int>(squares.size());
  choice.side = side;
  const std::vector<TextureDistributions> distributions = find_distributions(squares, side);
  choice.photo = score_squares(distributions);
  Scores scores;
  for (std::vector<TextureScore>& model_scores : scores) model_scores.resize(squares.size());
  const std::size_t all = scores.size() * squares.size();
  std::atomic<std::size_t> done{0};
  watched_work(progress, "comparing models", [&](const Progress& heed) {
    const auto part = [&](double, std::string_view words) {
      if (report(heed, static_cast<double>(done) / static_cast<double>(all), words)) return true;
      throw WorkError(name + ": stopped before a model was chosen; nothing is written");
    };
    parallel_for(0, static_cast<std::int64_t>(all), [&](std::int64_t i) {
      const std::size_t m = static_cast<std::size_t>(i) / squares.size(),
                        k = static_cast<std::size_t>(i) % squares.size();
      const std::vector<GreyImage> textures =
          make_textures(kTextureModels[m], squares[k], name, options, seed, part);
      scores[m][k] = held_out_score(find_distributions(textures, side), distributions, k);
      ++done;
    });
  });
  for (std::size_t m = 0; m < scores.size(); ++m) choice.scores[m] = summarize(scores[m]);
  choice.taken = simplest_best_model(scores);
  return choice;
}

}  // namespace astrolith
