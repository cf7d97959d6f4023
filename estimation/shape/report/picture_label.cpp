#include "estimation/shape/report/picture_label.h"

#include <opencv2/imgproc.hpp>

#include "synthesis/picture/colormap.h"

namespace astrolith {
namespace {

cv::Mat view(RgbImage& image) { return {image.height, image.width, CV_8UC3, image.pixels.data()}; }

}  // namespace

void draw_label(RgbImage& image, const std::string& text, int x, int y) {
  cv::Mat canvas = view(image);
  cv::putText(canvas, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {215, 215, 210}, 1, cv::LINE_AA);
}

void draw_color_scale(RgbImage& image, const std::string& low, const std::string& high) {
  constexpr int kLength = 160, kHeight = 12, kTop = 13, kRoom = 80;
  const int left = image.width - kRoom - kLength;
  cv::Mat canvas = view(image);
  for (int i = 0; i < kLength; ++i) {
    const Vec3<float> c = sequential_color(static_cast<double>(i) / (kLength - 1));
    cv::line(canvas, {left + i, kTop}, {left + i, kTop + kHeight},
             {double(srgb_byte(c.x)), double(srgb_byte(c.y)), double(srgb_byte(c.z))});
  }
  draw_label(image, low, left - 18, kTop + kHeight);
  draw_label(image, high, left + kLength + 8, kTop + kHeight);
}

}  // namespace astrolith
