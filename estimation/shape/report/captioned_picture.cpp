#include "estimation/shape/report/captioned_picture.h"

#include "estimation/plot/figure.h"
#include "synthesis/picture/colormap.h"

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

}  // namespace astrolith
