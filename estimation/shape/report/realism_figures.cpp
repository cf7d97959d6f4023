#include "estimation/shape/report/realism_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "estimation/plot/figure.h"
#include "estimation/shape/report/captioned_picture.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "numerics/sample_statistics.h"
#include "synthesis/picture/colormap.h"
#include "synthesis/picture/preview.h"

namespace astrolith {
namespace {

constexpr Ink kInkOfA{0.16, 0.35, 0.63}, kInkOfB{0.83, 0.37, 0.10};

std::vector<double> sorted_values(const LocalStatistic& statistic) {
  std::vector<double> sorted = statistic.values;
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

std::vector<std::pair<double, double>> quantile_curve(const std::vector<double>& sorted) {
  std::vector<std::pair<double, double>> curve;
  for (int percent = 1; percent <= 99; ++percent) {
    curve.emplace_back(percent, quantile_of_sorted(sorted, 0.01 * percent));
  }
  return curve;
}

std::string heading_of(const LocalStatistic& statistic) {
  const char* heading = traits_of(statistic.quantity).heading;
  return statistic.radius > 0.0 ? fmt::format("{}, {:g} edges", heading, statistic.radius) : heading;
}

void draw_quantiles(Figure& page, const Rectangle& at, const LocalStatistic& a, const LocalStatistic& b) {
  const std::vector<double> of_a = sorted_values(a), of_b = sorted_values(b);
  const double low = std::min(quantile_of_sorted(of_a, 0.01), quantile_of_sorted(of_b, 0.01)),
               high = std::max(quantile_of_sorted(of_a, 0.99), quantile_of_sorted(of_b, 0.99));
  const double room = std::max(0.05 * (high - low), 1e-9);
  const Axis x = linear_axis(0.0, 100.0, ""), y = linear_axis(low - room, high + room, "");
  page.text(at.x, at.y - 5.0, heading_of(a), 8.0);
  page.axes(at, x, y);
  page.curve(at, x, y, quantile_curve(of_a), kInkOfA);
  page.curve(at, x, y, quantile_curve(of_b), kInkOfB);
}

// The roughness at every vertex: the mean over all places, with weights that fall as the fourth power of the
// distance beyond the radius of the statistic.
std::vector<double> roughness_at_vertices(const NamedSurface& surface, const LocalStatistic& roughness) {
  const double scale = surface.statistics.edge * roughness.radius;
  const std::vector<Vec3d>& places = surface.statistics.places;
  std::vector<double> values(surface.mesh.vertices.size());
  parallel_for(
      0, static_cast<std::int64_t>(values.size()),
      [&](std::int64_t i) {
        const auto v = static_cast<std::size_t>(i);
        double sum = 0.0, weights = 0.0;
        for (std::size_t k = 0; k < places.size(); ++k) {
          const double x = squared_norm(places[k] - surface.mesh.vertices[v]) / (scale * scale);
          const double weight = 1.0 / (0.01 + x * x);
          sum += weight * roughness.values[k];
          weights += weight;
        }
        values[v] = sum / weights;
      },
      64);
  return values;
}

const LocalStatistic& mapped_roughness(const SurfaceStatistics& surface) {
  const LocalStatistic* of_six = surface.find(SurfaceQuantity::roughness, 6.0);
  return of_six != nullptr ? *of_six : surface.local.front();
}

CaptionedPicture roughness_map(const NamedSurface& surface, double low, double high) {
  PreviewOptions options;
  options.width = 800;
  options.height = 600;
  options.ambient = 0.5;  // keeps colours readable in the shadows
  options.vertex_colors =
      sequential_colors(roughness_at_vertices(surface, mapped_roughness(surface.statistics)), low, high);
  return {render_preview(surface.mesh, options), surface.name};
}

}  // namespace

void write_quantile_curves(const NamedSurface& a, const NamedSurface& b, const std::filesystem::path& file) {
  constexpr double kWidth = 150.0, kHeight = 100.0, kLeft = 44.0, kTop = 52.0, kAcross = 200.0, kDown = 142.0;
  constexpr int kColumns = 4;
  std::vector<std::pair<const LocalStatistic*, const LocalStatistic*>> both;
  for (const LocalStatistic& of_a : a.statistics.local) {
    const LocalStatistic* of_b = b.statistics.find(of_a.quantity, of_a.radius);
    if (of_b != nullptr) both.emplace_back(&of_a, of_b);
  }
  const std::size_t rows = (both.size() + kColumns - 1) / kColumns;
  Figure page(kColumns * kAcross + 10.0, kTop + static_cast<double>(rows) * kDown);
  page.text(kLeft, 20.0, a.name, 10.0, Figure::Align::kLeft, true, kInkOfA);
  page.text(kLeft + kAcross, 20.0, b.name, 10.0, Figure::Align::kLeft, true, kInkOfB);
  page.text(page.width() - 10.0, 20.0, "values over the share of places below them, %", 9.0,
            Figure::Align::kRight);
  for (std::size_t k = 0; k < both.size(); ++k) {
    const std::size_t column = k % kColumns, row = k / kColumns;
    const double x = kLeft + static_cast<double>(column) * kAcross,
                 y = kTop + static_cast<double>(row) * kDown;
    draw_quantiles(page, {x, y, kWidth, kHeight}, *both[k].first, *both[k].second);
  }
  page.write_png(file, 144.0);
}

void write_roughness_maps(const NamedSurface& a, const NamedSurface& b, const std::filesystem::path& file) {
  const std::vector<double> sorted = sorted_values(mapped_roughness(a.statistics));
  const double low = quantile_of_sorted(sorted, 0.05),
               high = std::max(quantile_of_sorted(sorted, 0.95), low + 1e-6);
  const double radius = mapped_roughness(a.statistics).radius;
  CaptionedPicture left = roughness_map(a, low, high), right = roughness_map(b, low, high);
  left.caption += fmt::format(": roughness within {:g} edges, dark {:.2g} %, light {:.2g} % of that radius",
                              radius, 100.0 * portable::exp(low), 100.0 * portable::exp(high));
  write_captioned_pictures({left, right}, file);
}

}  // namespace astrolith
