#include "estimation/shape/report/fit_plots.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "synthesis/picture/colormap.h"
#include "synthesis/picture/figure.h"

namespace astrolith {
namespace {

// One point of the page is one pixel of the PNG.
constexpr double kPixelsPerInch = 72.0;
constexpr double kStrip = 34.0;  // height of the strip with the captions
constexpr double kBaseline = 22.0;
constexpr double kMargin = 14.0;
constexpr double kTextSize = 14.0;
constexpr Ink kLightInk{0.84, 0.84, 0.82};

// The strip has the colour of the picture's background.
Ink corner_color(const RgbImage& image) {
  return {image.pixels[0] / 255.0, image.pixels[1] / 255.0, image.pixels[2] / 255.0};
}

void draw_light_text(Figure& page, double x, const std::string& text, Figure::Align align) {
  page.text(x, kBaseline, text, kTextSize, align, false, kLightInk);
}

Figure draw_side_by_side(const std::vector<CaptionedPicture>& pictures) {
  double width = 0.0;
  for (const CaptionedPicture& picture : pictures) width += picture.image.width;
  Figure page(width, kStrip + pictures.front().image.height);
  page.fill({0.0, 0.0, page.width(), page.height()}, corner_color(pictures.front().image));
  double left = 0.0;
  for (const auto& [image, caption] : pictures) {
    const auto image_width = static_cast<double>(image.width),
               image_height = static_cast<double>(image.height);
    page.picture({left, kStrip, image_width, image_height}, image, false);
    draw_light_text(page, left + kMargin, caption, Figure::Align::kLeft);
    left += image_width;
  }
  return page;
}

// sequential_color from 0 at the left end to 1 at the right end.
RgbImage color_bar(int width) {
  RgbImage bar{width, 1, {}};
  for (int i = 0; i < width; ++i) {
    const Vec3<float> color = sequential_color(static_cast<double>(i) / (width - 1));
    bar.pixels.insert(bar.pixels.end(), {srgb_byte(color.x), srgb_byte(color.y), srgb_byte(color.z)});
  }
  return bar;
}

void draw_color_scale(Figure& page, const ColorScaleLabels& labels) {
  constexpr int kLength = 160;
  constexpr double kHeight = 12.0, kRoomForLabel = 66.0, kGap = 8.0;
  const Rectangle bar{page.width() - kMargin - kRoomForLabel - kLength, kBaseline - 11.0, kLength, kHeight};
  page.picture(bar, color_bar(kLength), false);
  draw_light_text(page, bar.x - kGap, labels.low, Figure::Align::kRight);
  draw_light_text(page, bar.right() + kGap, labels.high, Figure::Align::kLeft);
}

// The page of a plot: 8 x 5 inches, 1600 x 1000 pixels. Lengths are points.
constexpr double kPlotWidth = 576.0, kPlotHeight = 360.0;  // points
constexpr double kPlotPixelsPerInch = 200.0;
constexpr Rectangle kPlotDiagram{54.0, 36.0, 500.0, 284.0};
constexpr Ink kPlotCurve{0.16, 0.35, 0.63};

// An empty page with a headline above the diagram.
Figure plot_page(const std::string& headline) {
  Figure page(kPlotWidth, kPlotHeight);
  page.text(kPlotDiagram.x, 22.0, headline, 10.0);
  return page;
}

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

void write_captioned_pictures(const std::vector<CaptionedPicture>& pictures,
                              const std::filesystem::path& file) {
  draw_side_by_side(pictures).write_png(file, kPixelsPerInch);
}

void write_picture_with_scale(const CaptionedPicture& picture, const ColorScaleLabels& scale,
                              const std::filesystem::path& file) {
  Figure page = draw_side_by_side({picture});
  draw_color_scale(page, scale);
  page.write_png(file, kPixelsPerInch);
}

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
