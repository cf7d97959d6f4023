#include "estimation/gabor/exemplar/texture_score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "numerics/portable_double.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

constexpr int kQuantiles = 4096;

// A Gaussian blur, cut at 3 sigma. The borders, where the blur is not whole, go: the result is smaller.
GreyImage blurred_inside(const GreyImage& image, double sigma) {
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<double> weights;
  double total = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    weights.push_back(portable::exp(-0.5 * i * i / (sigma * sigma)));
    total += weights.back();
  }
  const auto sum_at = [&](const GreyImage& of, int x, int y, int step_x, int step_y) {
    double sum = 0.0;
    for (int i = 0; i <= 2 * reach; ++i) {
      sum += weights[static_cast<std::size_t>(i)] * of.at(x + i * step_x, y + i * step_y);
    }
    return sum / total;
  };
  GreyImage rows{image.width - 2 * reach, image.height, {}};
  for (int y = 0; y < rows.height; ++y) {
    for (int x = 0; x < rows.width; ++x) rows.values.push_back(sum_at(image, x, y, 1, 0));
  }
  GreyImage result{rows.width, image.height - 2 * reach, {}};
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x) result.values.push_back(sum_at(rows, x, y, 0, 1));
  }
  return result;
}

// The responses of the three filters after one blur.
std::array<std::vector<double>, 3> responses(const GreyImage& image, double sigma) {
  const GreyImage b = blurred_inside(image, sigma);
  std::array<std::vector<double>, 3> result;
  for (int y = 1; y + 1 < b.height; ++y) {
    for (int x = 1; x + 1 < b.width; ++x) {
      const double left = b.at(x - 1, y), right = b.at(x + 1, y), up = b.at(x, y - 1), down = b.at(x, y + 1);
      result[0].push_back(right - left);
      result[1].push_back(down - up);
      result[2].push_back(left + right + up + down - 4.0 * b.at(x, y));
    }
  }
  return result;
}

}  // namespace

TextureDistributions::Distribution TextureDistributions::sorted_distribution(std::vector<double> values) {
  Distribution result{{}, std::sqrt(sample_variance(values))};
  std::sort(values.begin(), values.end());
  for (int q = 0; q < kQuantiles; ++q) {
    const double at = (q + 0.5) / kQuantiles * static_cast<double>(values.size() - 1);
    const auto i = static_cast<std::size_t>(at);
    const double next = values[std::min(i + 1, values.size() - 1)];
    result.quantiles.push_back(values[i] + (at - static_cast<double>(i)) * (next - values[i]));
  }
  return result;
}

TextureDistributions::TextureDistributions(const GreyImage& image, int side) {
  distributions_.push_back(sorted_distribution(image.values));
  for (const double sigma : {1.0, 2.0, 4.0, 8.0}) {
    if (!(side > 8.0 * sigma)) break;
    for (std::vector<double>& response : responses(image, sigma)) {
      distributions_.push_back(sorted_distribution(std::move(response)));
    }
  }
}

// The Wasserstein-1 distance of two distributions is the mean difference of their quantiles.
TextureScore TextureDistributions::score_against(const TextureDistributions& photo) const {
  constexpr double kNone = 1e-9;  // a response of so little beside the grey values is rounding
  TextureScore score;
  int filters = 0;
  for (std::size_t k = 0; k < distributions_.size(); ++k) {
    const Distribution &a = distributions_[k], &b = photo.distributions_[k];
    if (!(b.deviation > kNone * photo.distributions_[0].deviation)) continue;
    filters += k > 0;
    double sum = 0.0;
    for (std::size_t q = 0; q < a.quantiles.size(); ++q) sum += std::fabs(a.quantiles[q] - b.quantiles[q]);
    (k == 0 ? score.values : score.filters) += sum / kQuantiles / b.deviation;
  }
  score.filters /= std::max(1, filters);
  return score;
}

TextureScore texture_score(const GreyImage& texture, const GreyImage& photo) {
  const int side = std::min({texture.width, texture.height, photo.width, photo.height});
  return TextureDistributions(texture, side).score_against(TextureDistributions(photo, side));
}

}  // namespace astrolith
