#include "estimation/shape/report/error_histogram.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace astrolith {
namespace {

constexpr int kWidth = 800, kHeight = 500, kMargin = 70, kBars = 60;
const cv::Scalar kInk(40, 40, 40), kGrid(215, 215, 215), kBar(40, 90, 160);

void write_text(cv::Mat& canvas, const std::string& text, cv::Point at) {
  cv::putText(canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.42, kInk, 1, cv::LINE_AA);
}

std::vector<std::size_t> count(std::span<const double> distances, double limit) {
  std::vector<std::size_t> bars(kBars);
  for (const double d : distances) {
    const double part = std::clamp((d + limit) / (2.0 * limit), 0.0, 1.0);
    ++bars[std::min<std::size_t>(static_cast<std::size_t>(part * kBars), kBars - 1)];
  }
  return bars;
}

std::string percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f %%", 100.0 * fraction);
  return text;
}

}  // namespace

RgbImage plot_error_histogram(std::span<const double> distances, double limit) {
  cv::Mat canvas(kHeight, kWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  const std::vector<std::size_t> bars = count(distances, limit);
  const auto highest =
      static_cast<double>(std::max<std::size_t>(1, *std::max_element(bars.begin(), bars.end())));
  const double width = static_cast<double>(kWidth - 2 * kMargin) / kBars;
  const int floor = kHeight - kMargin;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const int left = kMargin + static_cast<int>(width * static_cast<double>(i));
    const int height = static_cast<int>((kHeight - 2 * kMargin) * static_cast<double>(bars[i]) / highest);
    cv::rectangle(canvas, {left, floor - height}, {left + static_cast<int>(width) - 1, floor}, kBar,
                  cv::FILLED);
  }
  cv::line(canvas, {kMargin, floor}, {kWidth - kMargin, floor}, kInk);
  cv::line(canvas, {kWidth / 2, kMargin}, {kWidth / 2, floor}, kGrid);
  write_text(canvas, percent(-limit), {kMargin - 24, floor + 20});
  write_text(canvas, "0", {kWidth / 2 - 4, floor + 20});
  write_text(canvas, percent(limit), {kWidth - kMargin - 24, floor + 20});
  write_text(canvas, "fit outside the target", {kMargin, floor + 42});
  write_text(canvas, "fit inside", {kWidth - kMargin - 70, floor + 42});
  write_text(canvas,
             "share of the fit's surface at each distance from the target, of the bounding-box diagonal",
             {kMargin, kMargin / 2});
  return {kWidth, kHeight, {canvas.data, canvas.data + canvas.total() * canvas.elemSize()}};
}

}  // namespace astrolith
