#include "estimation/shape/report/convergence_plot.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

namespace astrolith {
namespace {

constexpr int kWidth = 800, kHeight = 500, kMargin = 70;
const cv::Scalar kInk(40, 40, 40), kGrid(215, 215, 215), kCurve(40, 90, 160);

void write_text(cv::Mat& canvas, const std::string& text, cv::Point at) {
  cv::putText(canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.42, kInk, 1, cv::LINE_AA);
}

class Axes {
 public:
  explicit Axes(std::span<const ConvergencePoint> points)
      : last_iteration_(std::max(1, points.back().iterations)) {
    double low = 1e300, high = 0.0;
    for (const ConvergencePoint& p : points) {
      low = std::min(low, percent(p));
      high = std::max(high, percent(p));
    }
    low_ = std::floor(std::log10(low) * 4.0) / 4.0;
    high_ = std::max(std::ceil(std::log10(high) * 4.0) / 4.0, low_ + 0.25);
  }

  cv::Point at(int iterations, double log_percent) const {
    const double x = static_cast<double>(iterations) / last_iteration_;
    const double y = (log_percent - low_) / (high_ - low_);
    return {kMargin + static_cast<int>(x * (kWidth - 2 * kMargin)),
            kHeight - kMargin - static_cast<int>(y * (kHeight - 2 * kMargin))};
  }
  cv::Point at(const ConvergencePoint& p) const { return at(p.iterations, std::log10(percent(p))); }

  void draw(cv::Mat& canvas) const {
    for (double level = low_; level < high_ + 0.01; level += 0.25) {
      cv::line(canvas, at(0, level), at(last_iteration_, level), kGrid);
      const std::string number = std::to_string(std::pow(10.0, level));
      write_text(canvas, number.substr(0, 5) + " %", at(0, level) + cv::Point(-64, 4));
    }
    write_text(canvas, "mean distance, % of the bounding-box diagonal, at so many metaballs",
               {kMargin, kMargin / 2});
    write_text(canvas, "iterations: " + std::to_string(last_iteration_),
               at(last_iteration_, low_) + cv::Point(-90, 30));
  }

 private:
  static double percent(const ConvergencePoint& p) { return 100.0 * std::max(p.mean_distance, 1e-9); }

  int last_iteration_;
  double low_, high_;
};

}  // namespace

RgbImage plot_convergence(std::span<const ConvergencePoint> points) {
  cv::Mat canvas(kHeight, kWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  const Axes axes(points);
  axes.draw(canvas);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) cv::line(canvas, axes.at(points[i - 1]), axes.at(points[i]), kCurve, 2, cv::LINE_AA);
    cv::circle(canvas, axes.at(points[i]), 3, kCurve, cv::FILLED, cv::LINE_AA);
    if (i > 0 && points[i].spheres == points[i - 1].spheres) continue;
    write_text(canvas, std::to_string(points[i].spheres), axes.at(points[i]) + cv::Point(2, -8));
  }
  return {kWidth, kHeight, {canvas.data, canvas.data + canvas.total() * canvas.elemSize()}};
}

}  // namespace astrolith
