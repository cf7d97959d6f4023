#include "synthesis/picture/color_bar.h"

#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

#include "synthesis/picture/colormap.h"

namespace astrolith {
namespace {

constexpr int kGlyphWidth = 3, kGlyphHeight = 5;
constexpr std::string_view kGlyphs = "0123456789.-+e";
// Five rows of three dots each, the highest bit at the upper left.
constexpr std::array<unsigned, 14> kDots{075557, 026227, 071747, 071717, 055711, 074717, 074757,
                                         071122, 075757, 075717, 000002, 000700, 002720, 007747};

void put(RgbImage& image, int x, int y, const std::array<std::uint8_t, 3>& color) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  const auto at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  for (std::size_t k = 0; k < 3; ++k) image.pixels[at + k] = color[k];
}

void draw_glyph(RgbImage& image, int left, int top, int dot, unsigned dots) {
  for (int y = 0; y < kGlyphHeight * dot; ++y) {
    for (int x = 0; x < kGlyphWidth * dot; ++x) {
      const int bit = (kGlyphHeight - 1 - y / dot) * kGlyphWidth + (kGlyphWidth - 1 - x / dot);
      if ((dots >> bit & 1u) != 0) put(image, left + x, top + y, {235, 235, 235});
    }
  }
}

std::string four_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

int text_width(const std::string& text, int dot) {
  return static_cast<int>(text.size()) * (kGlyphWidth + 1) * dot;
}

void draw_text(RgbImage& image, int left, int top, int dot, const std::string& text) {
  for (const char c : text) {
    const std::size_t glyph = kGlyphs.find(c);
    if (glyph != std::string_view::npos) draw_glyph(image, left, top, dot, kDots[glyph]);
    left += (kGlyphWidth + 1) * dot;
  }
}

}  // namespace

void add_color_bar(RgbImage& image, double low, double high) {
  if (image.width < 160 || image.height < 120) return;
  const int dot = image.height / 320 + 1, left = image.width / 4, right = image.width - left;
  const int top = image.height + 2 * dot, bottom = top + 6 * dot, text_top = bottom + 2 * dot;
  const int before = std::exchange(image.height, text_top + (kGlyphHeight + 2) * dot);
  image.pixels.resize(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  for (int y = before; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      put(image, x, y, {image.pixels[0], image.pixels[1], image.pixels[2]});
  }
  for (int x = left; x < right; ++x) {
    const Vec3<float> c = sequential_color((x - left) / (right - left - 1.0));
    for (int y = top; y < bottom; ++y) put(image, x, y, {srgb_byte(c.x), srgb_byte(c.y), srgb_byte(c.z)});
  }
  draw_text(image, left, text_top, dot, four_digits(low));
  const std::string last = four_digits(high);
  draw_text(image, right - text_width(last, dot), text_top, dot, last);
}

}  // namespace astrolith
