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

using Distribution = TextureDistributions::Distribution;

Distribution sorted_distribution(std::vector<double> values) {
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

// The Wasserstein-1 distance is the mean difference of the quantiles, here over the deviation of `b`.
double distance_over_deviation(const Distribution& a, const Distribution& b) {
  double sum = 0.0;
  for (std::size_t q = 0; q < a.quantiles.size(); ++q) sum += std::fabs(a.quantiles[q] - b.quantiles[q]);
  return sum / kQuantiles / b.deviation;
}

// The blurs that count for images of this side.
std::vector<double> blurs(int side) {
  std::vector<double> sigmas;
  for (const double sigma : {1.0, 2.0, 4.0, 8.0}) {
    if (side > 8.0 * sigma) sigmas.push_back(sigma);
  }
  return sigmas;
}

}  // namespace

TextureDistributions::TextureDistributions(const GreyImage& image, int side) {
  distributions_.push_back(sorted_distribution(image.values));
  for (const double sigma : blurs(side)) {
    for (std::vector<double>& response : responses(image, sigma)) {
      distributions_.push_back(sorted_distribution(std::move(response)));
    }
  }
}

TextureScore TextureDistributions::score_against(const TextureDistributions& photo) const {
  constexpr double kNone = 1e-9;  // a response of so little beside the grey values is rounding
  TextureScore score;
  int filters = 0;
  for (std::size_t k = 0; k < distributions_.size(); ++k) {
    const Distribution &a = distributions_[k], &b = photo.distributions_[k];
    if (!(b.deviation > kNone * photo.distributions_[0].deviation)) continue;
    filters += k > 0;
    (k == 0 ? score.values : score.filters) += distance_over_deviation(a, b);
  }
  score.filters /= std::max(1, filters);
  return score;
}

OrientedSlopes::OrientedSlopes(const GreyImage& image, int side) {
  for (const double sigma : blurs(side)) {
    const GreyImage b = blurred_inside(image, sigma);
    std::vector<double> falling, rising;
    double xx = 0.0, yy = 0.0, xy = 0.0;
    for (int y = 1; y + 1 < b.height; ++y) {
      for (int x = 1; x + 1 < b.width; ++x) {
        const double along_x = b.at(x + 1, y) - b.at(x - 1, y), along_y = b.at(x, y + 1) - b.at(x, y - 1);
        xx += along_x * along_x, yy += along_y * along_y, xy += along_x * along_y;
        falling.push_back(b.at(x + 1, y + 1) - b.at(x - 1, y - 1));
        rising.push_back(b.at(x + 1, y - 1) - b.at(x - 1, y + 1));
      }
    }
    blurs_.push_back({xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0,
                      sorted_distribution(std::move(falling)), sorted_distribution(std::move(rising))});
  }
}

double OrientedSlopes::difference_from(const OrientedSlopes& photo) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < blurs_.size(); ++k) {
    const Blur &a = blurs_[k], &b = photo.blurs_[k];
    sum += std::fabs(a.correlation - b.correlation);
    if (b.falling.deviation > 0.0) sum += 0.5 * distance_over_deviation(a.falling, b.falling);
    if (b.rising.deviation > 0.0) sum += 0.5 * distance_over_deviation(a.rising, b.rising);
  }
  return sum / static_cast<double>(std::max<std::size_t>(blurs_.size(), 1));
}

TextureScore texture_score(const GreyImage& texture, const GreyImage& photo) {
  const int side = std::min({texture.width, texture.height, photo.width, photo.height});
  return TextureDistributions(texture, side).score_against(TextureDistributions(photo, side));
}

}  // namespace astrolith
