#include "synthesis/picture/surface_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "numerics/parallel_for.h"
#include "numerics/scalar_math.h"

namespace astrolith {
namespace {

// The heights at pixels that may lie beyond the border.
class GridReader {
 public:
  explicit GridReader(const HeightGrid& grid) : grid_(grid) {}

  bool holds(int x, int y) const {
    return grid_.repeats || (x >= 0 && x < grid_.width && y >= 0 && y < grid_.height);
  }
  // Expects a pixel that the grid holds.
  float at(int x, int y) const {
    if (grid_.repeats) x = within(x, grid_.width), y = within(y, grid_.height);
    return grid_.heights[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.width) +
                         static_cast<std::size_t>(x)];
  }
  // The rise per pixel along (dx, dy), which is one step along an axis.
  float slope(int x, int y, int dx, int dy) const {
    const int after = holds(x + dx, y + dy) ? 1 : 0, before = holds(x - dx, y - dy) ? 1 : 0;
    if (after + before == 0) return 0.0f;  // a map of one pixel along this axis
    return (at(x + after * dx, y + after * dy) - at(x - before * dx, y - before * dy)) /
           static_cast<float>(after + before);
  }

 private:
  static int within(int i, int side) {
    const int rest = i % side;
    return rest < 0 ? rest + side : rest;
  }
  const HeightGrid& grid_;
};

// Calls visit(x, y) for every pixel, rows in parallel.
template <class Visit>
void for_each_pixel(const HeightGrid& grid, const Progress& progress, std::string_view stage,
                    const Visit& visit) {
  constexpr int kBandRows = 64;  // between two reports of progress
  for (int first = 0; first < grid.height; first += kBandRows) {
    if (!report(progress, static_cast<double>(first) / grid.height, stage)) return;
    parallel_for(first, std::min(grid.height, first + kBandRows), [&](std::int64_t row) {
      for (int x = 0; x < grid.width; ++x) visit(x, static_cast<int>(row));
    });
  }
  report(progress, 1.0, stage);
}

// Pixels to look at along an azimuth, at distances that grow by a quarter.
struct HorizonStep {
  int dx, dy;
  float per_distance;  // 1 / distance, per length unit
};
using HorizonSteps = std::array<std::vector<HorizonStep>, kOcclusionAzimuths>;

HorizonSteps horizon_steps(double pixel_size) {
  HorizonSteps steps;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const float turn = static_cast<float>(k) / static_cast<float>(kOcclusionAzimuths);
    const float c = math::cos_turns(turn), s = math::sin_turns(turn);
    for (float r = 1.0f; r <= static_cast<float>(kOcclusionReach); r = std::max(r + 1.0f, 1.25f * r)) {
      const int dx = static_cast<int>(math::floor(r * c + 0.5f)),
                dy = static_cast<int>(math::floor(r * s + 0.5f));
      const double distance = pixel_size * std::sqrt(static_cast<double>(dx * dx + dy * dy));
      steps[k].push_back({dx, dy, static_cast<float>(1.0 / distance)});
    }
  }
  return steps;
}

// The share of the light of an even sky at a pixel.
float open_sky(const GridReader& reader, const HorizonSteps& steps, int x, int y) {
  const float here = reader.at(x, y);
  float sum = 0.0f;
  for (const std::vector<HorizonStep>& azimuth : steps) {
    float steepest = 0.0f;  // tangent of the horizon's elevation
    for (const HorizonStep& step : azimuth) {
      if (!reader.holds(x + step.dx, y + step.dy)) break;
      steepest = math::max(steepest, (reader.at(x + step.dx, y + step.dy) - here) * step.per_distance);
    }
    sum += 1.0f / math::fma(steepest, steepest, 1.0f);
  }
  return sum / static_cast<float>(kOcclusionAzimuths);
}

}  // namespace

std::vector<float> normal_map(const HeightGrid& grid, const Progress& progress) {
  const GridReader reader(grid);
  std::vector<float> normals(3 * grid.heights.size());
  const auto per_length = static_cast<float>(1.0 / grid.pixel_size);
  for_each_pixel(grid, progress, "normals", [&](int x, int y) {
    const float along_x = per_length * reader.slope(x, y, 1, 0), up = per_length * reader.slope(x, y, 0, -1);
    const float scale = 1.0f / math::sqrt(math::fma(along_x, along_x, math::fma(up, up, 1.0f)));
    float* normal = &normals[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width) +
                                  static_cast<std::size_t>(x))];
    normal[0] = -along_x * scale;
    normal[1] = -up * scale;
    normal[2] = scale;
  });
  return normals;
}

std::vector<float> occlusion_map(const HeightGrid& grid, const Progress& progress) {
  const GridReader reader(grid);
  const HorizonSteps steps = horizon_steps(grid.pixel_size);
  std::vector<float> occlusion(grid.heights.size());
  for_each_pixel(grid, progress, "occlusion", [&](int x, int y) {
    occlusion[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width) +
              static_cast<std::size_t>(x)] = open_sky(reader, steps, x, y);
  });
  return occlusion;
}

}  // namespace astrolith
