#include "geometry/atlas/texture_atlas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>

#include "geometry/atlas/surface_charts.h"
#include "geometry/mesh_measure.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

// The outline of what has been placed: steps from left to right, each up to where the next begins.
class Skyline {
 public:
  explicit Skyline(int side) : side_(side), steps_{{0, 0}} {}

  std::optional<RectanglePlace> place(const RectangleSize& size) {
    std::size_t best = steps_.size();
    RectanglePlace at;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (steps_[i].x + size.width > side_) break;
      const int y = top_over(i, size.width);
      if (y + size.height > side_ || (best < steps_.size() && y >= at.y)) continue;
      best = i, at = {steps_[i].x, y};
    }
    if (best == steps_.size()) return std::nullopt;
    raise(best, at, size);
    return at;
  }

 private:
  struct Step {
    int x, y;
  };

  int step_end(std::size_t i) const { return i + 1 < steps_.size() ? steps_[i + 1].x : side_; }

  int top_over(std::size_t first, int width) const {
    int top = 0;
    const int end = steps_[first].x + width;
    for (std::size_t i = first; i < steps_.size() && steps_[i].x < end; ++i) top = std::max(top, steps_[i].y);
    return top;
  }

  void raise(std::size_t first, const RectanglePlace& at, const RectangleSize& size) {
    const int end = at.x + size.width;
    std::size_t last = first;  // the first step that reaches beyond the rectangle
    while (last < steps_.size() && step_end(last) <= end) ++last;
    std::vector<Step> made{{at.x, at.y + size.height}};
    if (last < steps_.size()) made.push_back({end, steps_[last].y});
    const auto from = steps_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto to = steps_.begin() + static_cast<std::ptrdiff_t>(std::min(last + 1, steps_.size()));
    steps_.insert(steps_.erase(from, to), made.begin(), made.end());
  }

  int side_;
  std::vector<Step> steps_;
};

// The rectangles of charts in their planes, length units.
struct ChartExtents {
  std::vector<double> left, top, width, height;  // (#charts) top: the greatest coordinate along the axis's up
};

ChartExtents chart_extents(const TriangleMesh& mesh, const SurfaceCharts& charts) {
  const std::size_t count = charts.chart_axis.size();
  std::vector<double> x0(count, 1e300), x1(count, -1e300), y0(count, 1e300), y1(count, -1e300);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const std::uint32_t c = charts.triangle_chart[f];
    const ChartAxis& axis = kChartAxes[charts.chart_axis[c]];
    for (const std::uint32_t v : mesh.triangles[f]) {
      const double x = dot(mesh.vertices[v], axis.right), y = dot(mesh.vertices[v], axis.up);
      x0[c] = std::min(x0[c], x), x1[c] = std::max(x1[c], x);
      y0[c] = std::min(y0[c], y), y1[c] = std::max(y1[c], y);
    }
  }
  ChartExtents extents{x0, y1, {}, {}};
  for (std::size_t c = 0; c < count; ++c) {
    extents.width.push_back(x1[c] - x0[c]);
    extents.height.push_back(y1[c] - y0[c]);
  }
  return extents;
}

std::vector<RectangleSize> sizes_at(const ChartExtents& extents, double texels_per_length) {
  constexpr double kMost = 1e6;  // beyond any image
  const auto texels = [&](double length) {
    return static_cast<int>(std::min(std::ceil(length * texels_per_length), kMost)) + 1 + 2 * kChartPadding;
  };
  std::vector<RectangleSize> sizes;
  for (std::size_t c = 0; c < extents.width.size(); ++c)
    sizes.push_back({texels(extents.width[c]), texels(extents.height[c])});
  return sizes;
}

// The largest scale at which the charts fit, and their places; no places where even `least` is too large.
struct AtlasLayout {
  double texels_per_length = 0.0;
  std::vector<RectanglePlace> places;
};
AtlasLayout largest_layout(const ChartExtents& extents, int side, double least) {
  constexpr int kHalvings = 12;
  AtlasLayout best;
  const auto fits = [&](double scale) {
    std::optional<std::vector<RectanglePlace>> places = pack_rectangles(sizes_at(extents, scale), side);
    if (places) best = {scale, std::move(*places)};
    return best.texels_per_length == scale;
  };
  double low = least, high = least;
  while (fits(high)) low = high, high *= 2.0;
  if (best.places.empty()) return best;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  return best;
}

TextureCoordinates texture_coordinates(const TriangleMesh& mesh, const SurfaceCharts& charts,
                                       const ChartExtents& extents, const AtlasLayout& layout, int side) {
  TextureCoordinates made;
  std::unordered_map<std::uint64_t, std::uint32_t> known;  // by chart and vertex
  known.reserve(mesh.vertices.size() + mesh.vertices.size() / 4);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const std::uint32_t c = charts.triangle_chart[f];
    const ChartAxis& axis = kChartAxes[charts.chart_axis[c]];
    Triangle& out = made.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[f][k];
      const auto [found, is_new] =
          known.try_emplace((std::uint64_t{c} << 32) | v, static_cast<std::uint32_t>(made.uv.size()));
      out[k] = found->second;
      if (!is_new) continue;
      const Vec3d& p = mesh.vertices[v];
      const double x = (dot(p, axis.right) - extents.left[c]) * layout.texels_per_length,
                   y = (extents.top[c] - dot(p, axis.up)) * layout.texels_per_length;
      made.mesh_vertex.push_back(v);
      made.uv.push_back({static_cast<float>((layout.places[c].x + kChartPadding + x) / side),
                         static_cast<float>((layout.places[c].y + kChartPadding + y) / side)});
    }
  }
  return made;
}

// The singular values of the map from a triangle in space to its image, times one number.
std::array<double, 2> singular_values(const std::array<Vec3d, 3>& p, const std::array<TexturePoint, 3>& t) {
  const Vec3d along = p[1] - p[0], other = p[2] - p[0];
  const double length = norm(along), area = norm(cross(along, other));
  if (!(area > 0.0)) return {0.0, 0.0};
  const double x = dot(other, along) / length, y = area / length;
  const double u1 = double{t[1][0]} - t[0][0], v1 = double{t[1][1]} - t[0][1];
  const double u2 = double{t[2][0]} - t[0][0], v2 = double{t[2][1]} - t[0][1];
  const double a = u1 / length, b = (u2 - u1 * x / length) / y;
  const double c = v1 / length, d = (v2 - v1 * x / length) / y;
  const double sum = a * a + b * b + c * c + d * d, product = std::fabs(a * d - b * c);
  const double root = std::sqrt(std::max(sum * sum - 4.0 * product * product, 0.0));
  const double large = std::sqrt(0.5 * (sum + root));
  return {large, large > 0.0 ? product / large : 0.0};
}

}  // namespace

std::optional<std::vector<RectanglePlace>> pack_rectangles(std::span<const RectangleSize> sizes, int side) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sizes[a].height != sizes[b].height ? sizes[a].height > sizes[b].height
                                              : sizes[a].width > sizes[b].width;
  });
  Skyline skyline(side);
  std::vector<RectanglePlace> places(sizes.size());
  for (const std::size_t i : order) {
    const std::optional<RectanglePlace> place = skyline.place(sizes[i]);
    if (!place) return std::nullopt;
    places[i] = *place;
  }
  return places;
}

TextureAtlas make_texture_atlas(const TriangleMesh& mesh, int side, const std::string& name, int most_side) {
  const SurfaceCharts charts = surface_charts(mesh);
  const ChartExtents extents = chart_extents(mesh, charts);
  AtlasLayout layout = largest_layout(extents, side, 1.0 / mean_edge(mesh));
  while (layout.places.empty() && 2 * side <= most_side) {
    side *= 2;
    layout = largest_layout(extents, side, 1.0 / mean_edge(mesh));
  }
  if (layout.places.empty()) {
    throw InputError(name + ": " + std::to_string(charts.chart_axis.size()) + " charts of " +
                     std::to_string(mesh.triangles.size()) + " triangles do not fit into " +
                     std::to_string(side) + " x " + std::to_string(side) +
                     " texels; take a larger image, or fewer triangles");
  }
  TextureAtlas atlas{texture_coordinates(mesh, charts, extents, layout, side),
                     charts.triangle_chart,
                     {},
                     sizes_at(extents, layout.texels_per_length),
                     side,
                     1.0 / layout.texels_per_length};
  atlas.places = std::move(layout.places);
  return atlas;
}

AtlasStretch atlas_stretch(const TriangleMesh& mesh, const TextureCoordinates& coordinates) {
  std::vector<double> ratios;
  AtlasStretch stretch;
  double sum = 0.0;
  for (const Triangle& triangle : coordinates.triangles) {
    std::array<Vec3d, 3> p;
    std::array<TexturePoint, 3> t;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = mesh.vertices[coordinates.mesh_vertex[triangle[k]]], t[k] = coordinates.uv[triangle[k]];
    stretch.filled += 0.5 * std::fabs((double{t[1][0]} - t[0][0]) * (double{t[2][1]} - t[0][1]) -
                                      (double{t[2][0]} - t[0][0]) * (double{t[1][1]} - t[0][1]));
    const auto [large, small] = singular_values(p, t);
    if (!(large > 0.0)) continue;
    ratios.push_back(small > 0.0 ? large / small : 1e300);
    sum += ratios.back();
  }
  if (ratios.empty()) return stretch;
  std::sort(ratios.begin(), ratios.end());
  stretch.mean = sum / static_cast<double>(ratios.size());
  stretch.p99 = ratios[static_cast<std::size_t>(0.99 * static_cast<double>(ratios.size() - 1))];
  stretch.largest = ratios.back();
  return stretch;
}

}  // namespace astrolith
