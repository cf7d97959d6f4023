#include "estimation/gabor/image/missing_ground.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "numerics/errors.h"

namespace astrolith {
namespace {

// The sum of term(value) over the known pixels, and their number.
template <typename Term>
std::pair<double, double> known_sum(const GreyImage& image, const Term& term) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (!image.missing.empty() && image.missing[i]) continue;
    sum += term(image.values[i]);
    count += 1.0;
  }
  return {sum, std::max(1.0, count)};
}

// An image of half the size, whose pixels are the means of the known ones among four.
GreyImage halved(const GreyImage& image) {
  GreyImage half{(image.width + 1) / 2, (image.height + 1) / 2, {}};
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      double sum = 0.0;
      int count = 0;
      for (int k = 0; k < 4; ++k) {
        const int px = 2 * x + k % 2, py = 2 * y + k / 2;
        if (px >= image.width || py >= image.height || std::isnan(image.at(px, py))) continue;
        sum += image.at(px, py);
        ++count;
      }
      half.values.push_back(count > 0 ? sum / count : std::nan(""));
    }
  }
  return half;
}

// Gauss-Seidel over the pixels of the list, in its order and then in reverse.
void relax(GreyImage& image, const std::vector<std::size_t>& pixels, const Repeats& repeats) {
  const auto width = static_cast<std::size_t>(image.width), all = image.values.size();
  std::vector<double>& v = image.values;
  const auto smooth = [&](std::size_t i) {
    double sum = 0.0;
    int count = 0;
    const auto add = [&](std::size_t neighbour) { sum += v[neighbour], ++count; };
    const std::size_t column = i % width;
    if (column > 0 || repeats.x) add(column > 0 ? i - 1 : i + width - 1);
    if (column + 1 < width || repeats.x) add(column + 1 < width ? i + 1 : i + 1 - width);
    if (i >= width || repeats.y) add(i >= width ? i - width : i + all - width);
    if (i + width < all || repeats.y) add(i + width < all ? i + width : i + width - all);
    v[i] = sum / count;
  };
  for (const std::size_t i : pixels) smooth(i);
  for (auto i = pixels.rbegin(); i != pixels.rend(); ++i) smooth(*i);
}

// Replaces every NaN.
void fill(GreyImage& image, const Repeats& repeats, const Progress& progress) {
  constexpr int kTurns = 8;
  constexpr double kNearlyRead = 0.99;
  std::vector<std::size_t> holes;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (std::isnan(image.values[i])) holes.push_back(i);
  }
  if (holes.empty()) return;
  GreyImage coarse = halved(image);
  fill(coarse, repeats, progress);
  const auto width = static_cast<std::size_t>(image.width);
  for (const std::size_t i : holes)
    image.values[i] = coarse.at(static_cast<int>(i % width) / 2, static_cast<int>(i / width) / 2);
  for (int turn = 0; turn < kTurns; ++turn) {
    if (!report(progress, kNearlyRead, "gaps"))
      throw WorkError("stopped while missing pixels were continued; nothing is written");
    relax(image, holes, repeats);
  }
}

// The missing pixels that lie in a square of 3 x 3 missing ones.
std::vector<bool> find_gaps(const GreyImage& image) {
  std::vector<bool> gaps(image.missing.size(), false);
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
  };
  for (int y = 1; y + 1 < image.height; ++y) {
    for (int x = 1; x + 1 < image.width; ++x) {
      bool whole = true;
      for (int k = 0; whole && k < 9; ++k) whole = image.missing[index(x + k % 3 - 1, y + k / 3 - 1)];
      for (int k = 0; whole && k < 9; ++k) gaps[index(x + k % 3 - 1, y + k / 3 - 1)] = true;
    }
  }
  return gaps;
}

}  // namespace

double missing_share(const GreyImage& image) {
  if (image.missing.empty()) return 0.0;
  const auto count = std::count(image.missing.begin(), image.missing.end(), true);
  return static_cast<double>(count) / static_cast<double>(image.missing.size());
}

double known_mean(const GreyImage& image) {
  const auto [sum, count] = known_sum(image, [](double v) { return v; });
  return sum / count;
}

double known_variance(const GreyImage& image) {
  const double mean = known_mean(image);
  const auto [sum, count] = known_sum(image, [&](double v) { return (v - mean) * (v - mean); });
  return sum / count;
}

void fill_missing(GreyImage& image, const Repeats& repeats, const Progress& progress) {
  const auto is_missing = [](double v) { return std::isnan(v); };
  if (std::none_of(image.values.begin(), image.values.end(), is_missing)) return;
  image.missing.resize(image.values.size());
  std::transform(image.values.begin(), image.values.end(), image.missing.begin(), is_missing);
  fill(image, repeats, progress);
}

// The rectangles that end at a row stand on a skyline of known pixels above it; a stack holds its steps.
GreyImage largest_whole_part(const GreyImage& image) {
  if (image.missing.empty()) return image;
  struct Step {
    int left, height;
  };
  struct Rectangle {
    int left = 0, top = 0, width = 0, height = 0;
    std::int64_t area() const { return std::int64_t{width} * height; }
  } best;
  const std::vector<bool> gaps = find_gaps(image);
  std::vector<int> known(static_cast<std::size_t>(image.width) + 1, 0);  // the last column ends every step
  for (int y = 0; y < image.height; ++y) {
    std::vector<Step> steps;
    for (int x = 0; x <= image.width; ++x) {
      int& tall = known[static_cast<std::size_t>(x)];
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
      tall = x == image.width || gaps[i] ? 0 : tall + 1;
      int left = x;
      while (!steps.empty() && steps.back().height >= tall) {
        const Step step = steps.back();
        steps.pop_back();
        const Rectangle found{step.left, y - step.height + 1, x - step.left, step.height};
        if (found.area() > best.area()) best = found;
        left = step.left;
      }
      steps.push_back({left, tall});
    }
  }
  GreyImage part = image.part(best.left, best.top, best.width, best.height);
  part.missing.clear();
  return part;
}

}  // namespace astrolith
