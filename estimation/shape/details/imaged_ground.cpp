#include "estimation/shape/details/imaged_ground.h"

#include <algorithm>
#include <cstddef>

namespace astrolith {
namespace {

constexpr double kMeanReach = 10.0, kPieceReach = 8.0;  // edges
constexpr double kFarBelow = 2.0;
constexpr double kLeastSmoothShare = 0.03;

// The mean of the values over the places within a distance of each place.
std::vector<double> means_around(const std::vector<Vec3d>& places, const std::vector<double>& values,
                                 double reach) {
  std::vector<double> means;
  for (const Vec3d& p : places) {
    double sum = 0.0, count = 0.0;
    for (std::size_t j = 0; j < places.size(); ++j) {
      if (squared_norm(places[j] - p) > reach * reach) continue;
      sum += values[j];
      count += 1.0;
    }
    means.push_back(sum / count);
  }
  return means;
}

std::vector<char> far_below(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const double limit = sorted[(3 * sorted.size()) / 4] - kFarBelow;
  std::vector<char> below;
  for (const double value : values) below.push_back(value < limit ? 1 : 0);
  return below;
}

// Leaves the largest piece of the marked places, whose neighbours lie within `reach` of each other.
std::vector<char> largest_piece(const std::vector<Vec3d>& places, std::vector<char> marked, double reach) {
  std::vector<std::size_t> largest;
  for (std::size_t first = 0; first < places.size(); ++first) {
    if (marked[first] == 0) continue;
    std::vector<std::size_t> piece{first};
    marked[first] = 0;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      for (std::size_t j = 0; j < places.size(); ++j) {
        if (marked[j] == 0 || squared_norm(places[j] - places[piece[k]]) > reach * reach) continue;
        marked[j] = 0;
        piece.push_back(j);
      }
    }
    if (piece.size() > largest.size()) largest = std::move(piece);
  }
  std::vector<char> in_piece(places.size(), 0);
  for (const std::size_t i : largest) in_piece[i] = 1;
  return in_piece;
}

double marked_share(const std::vector<char>& marked) {
  const auto count = static_cast<double>(std::count(marked.begin(), marked.end(), 1));
  return marked.empty() ? 0.0 : count / static_cast<double>(marked.size());
}

// The places of the largest piece of smooth ground, none where it is no larger than by chance.
std::vector<char> smooth_places(const SurfaceStatistics& target) {
  const LocalStatistic* roughness = target.find(SurfaceQuantity::roughness, 6.0);
  if (roughness == nullptr) return {};
  std::vector<char> smooth = largest_piece(
      target.places, far_below(means_around(target.places, roughness->values, kMeanReach * target.edge)),
      kPieceReach * target.edge);
  return marked_share(smooth) < kLeastSmoothShare ? std::vector<char>() : smooth;
}

}  // namespace

double unseen_share(const SurfaceStatistics& target) { return marked_share(smooth_places(target)); }

}  // namespace astrolith
