#include "estimation/shape/report/convergence_plot.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "estimation/shape/report/plot_page_internal.h"

namespace astrolith {
namespace {

double percent(const ConvergencePoint& p) { return 100.0 * std::max(p.mean_distance, 1e-9); }

Axis distance_axis(std::span<const ConvergencePoint> points) {
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(),
      [](const ConvergencePoint& a, const ConvergencePoint& b) { return percent(a) < percent(b); });
  return logarithmic_axis(percent(*low), percent(*high), "mean distance, % of the bounding-box diagonal");
}

// Labels of numbers of metaballs, set to the upper right of their points. A label that would cover the label
// before it is left out.
class SphereLabels {
 public:
  explicit SphereLabels(Figure& page) : page_(page) {}

  void draw(double x, double y, int spheres) {
    constexpr double kSize = 8.0, kWidth = 16.0;
    if (std::abs(x - last_x_) < kWidth && std::abs(y - last_y_) < kSize) return;
    page_.text(x + 3.0, y - 4.0, std::to_string(spheres), kSize);
    last_x_ = x;
    last_y_ = y;
  }

 private:
  Figure& page_;
  double last_x_ = -1e9, last_y_ = -1e9;
};

}  // namespace

void write_convergence_plot(std::span<const ConvergencePoint> points, const std::filesystem::path& file) {
  Figure page = plot_page("Convergence; the numbers at the curve count the metaballs");
  const Axis x = linear_axis(0.0, std::max(1, points.back().iterations), "iterations of the refinement", 1.0);
  const Axis y = distance_axis(points);
  page.axes(kPlotDiagram, x, y, true);
  std::vector<std::pair<double, double>> curve;
  for (const ConvergencePoint& p : points) curve.emplace_back(p.iterations, std::log10(percent(p)));
  page.curve(kPlotDiagram, x, y, curve, kPlotCurve);
  SphereLabels labels(page);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && points[i].spheres == points[i - 1].spheres) continue;
    labels.draw(place_along_x(curve[i].first, x, kPlotDiagram),
                place_along_y(curve[i].second, y, kPlotDiagram), points[i].spheres);
  }
  page.write_png(file, kPlotPixelsPerInch);
}

}  // namespace astrolith
