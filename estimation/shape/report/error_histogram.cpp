#include "estimation/shape/report/error_histogram.h"

#include <algorithm>
#include <vector>

#include "estimation/shape/report/plot_page_internal.h"

namespace astrolith {
namespace {

constexpr int kBars = 60;
constexpr Ink kZeroLine{0.85, 0.85, 0.85};

// The percentage of the distances that falls into each bar.
std::vector<double> bar_heights(std::span<const double> distances, double limit) {
  std::vector<std::size_t> counts(kBars);
  for (const double d : distances) {
    const double part = std::clamp((d + limit) / (2.0 * limit), 0.0, 1.0);
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(part * kBars), kBars - 1)];
  }
  std::vector<double> heights;
  const double all = std::max<double>(1.0, static_cast<double>(distances.size()));
  for (const std::size_t count : counts) heights.push_back(100.0 * static_cast<double>(count) / all);
  return heights;
}

void draw_bars(Figure& page, const std::vector<double>& heights, const Axis& y) {
  const double width = kPlotDiagram.width / kBars;
  double left = kPlotDiagram.x;
  for (const double height : heights) {
    const double top = place_along_y(height, y, kPlotDiagram);
    page.fill({left, top, width - 0.6, kPlotDiagram.bottom() - top}, kPlotCurve);
    left += width;
  }
}

void draw_sides(Figure& page) {
  constexpr double kSize = 9.0, kInset = 10.0;
  const double baseline = kPlotDiagram.y + 16.0;
  page.text(kPlotDiagram.x + kInset, baseline, "fit outside the target", kSize);
  page.text(kPlotDiagram.right() - kInset, baseline, "fit inside the target", kSize, Figure::Align::kRight);
}

}  // namespace

void write_error_histogram(std::span<const double> distances, double limit,
                           const std::filesystem::path& file) {
  const std::vector<double> heights = bar_heights(distances, limit);
  const double highest = std::max(1e-3, *std::max_element(heights.begin(), heights.end()));
  const Axis x = linear_axis(-100.0 * limit, 100.0 * limit,
                             "distance of the fit from the target, % of the bounding-box diagonal");
  const Axis y = linear_axis(0.0, 1.12 * highest, "share of the fit's surface, %");
  Figure page = plot_page("Distances over the fit; the outer bars also count all that lies beyond");
  draw_bars(page, heights, y);
  const double middle = place_along_x(0.0, x, kPlotDiagram);
  page.line(middle, kPlotDiagram.y, middle, kPlotDiagram.bottom(), 0.7, kZeroLine);
  draw_sides(page);
  page.axes(kPlotDiagram, x, y);
  page.write_png(file, kPlotPixelsPerInch);
}

}  // namespace astrolith
