#include "synthesis/picture/picture_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"
#include "numerics/sample_statistics.h"
#include "numerics/tangent_frame.h"
#include "synthesis/picture/colormap.h"
#include "synthesis/picture/preview_rays_internal.h"

namespace astrolith {
namespace {

using PictureInk = std::array<std::uint8_t, 3>;  // sRGB

constexpr int kGlyphColumns = 5, kGlyphRows = 8, kAdvance = 6;
// The printable characters of ASCII from the blank on. Each byte is a column, the lowest that of the left;
// the lowest bit of a byte is the uppermost dot.
constexpr std::uint64_t kGlyphs[] = {
    0x0000000000, 0x00005f0000, 0x0007000700, 0x147f147f14, 0x122a7f2a24, 0x6264081323, 0x5020564936,
    0x0003070800, 0x0041221c00, 0x001c224100, 0x2a1c7f1c2a, 0x08083e0808, 0x0030708000, 0x0808080808,
    0x0060600000, 0x0204081020, 0x3e4549513e, 0x00407f4200, 0x4649494972, 0x334d494121, 0x107f121418,
    0x3945454527, 0x3149494a3c, 0x0709112141, 0x3649494936, 0x1e29494946, 0x0000140000, 0x0000344000,
    0x4122140800, 0x1414141414, 0x0814224100, 0x0609590102, 0x4e595d413e, 0x7c1211127c, 0x364949497f,
    0x224141413e, 0x3e4141417f, 0x414949497f, 0x010909097f, 0x735141413e, 0x7f0808087f, 0x00417f4100,
    0x013f414020, 0x412214087f, 0x404040407f, 0x7f021c027f, 0x7f1008047f, 0x3e4141413e, 0x060909097f,
    0x5e2151413e, 0x462919097f, 0x3249494926, 0x03017f0103, 0x3f4040403f, 0x1f2040201f, 0x3f4038403f,
    0x6314081463, 0x0304780403, 0x434d495961, 0x4141417f00, 0x2010080402, 0x7f41414100, 0x0402010204,
    0x4040404040, 0x0008070300, 0x4078545420, 0x384444287f, 0x2844444438, 0x7f28444438, 0x1854545438,
    0x02097e0800, 0x789ca4a418, 0x780404087f, 0x00407d4400, 0x003d404020, 0x004428107f, 0x00407f4100,
    0x780478047c, 0x780404087c, 0x3844444438, 0x18242418fc, 0xfc18242418, 0x080404087c, 0x2454545448,
    0x24443f0404, 0x7c2040403c, 0x1c2040201c, 0x3c4030403c, 0x4428102844, 0x7c9090904c, 0x444c546444,
    0x0041360800, 0x0000770000, 0x0008364100, 0x0204020102};
constexpr char kFirstGlyph = ' ', kLastGlyph = '~', kNoGlyph = '?';

// Fills what lies within the picture.
void fill_rectangle(RgbaImage16& image, int left, int top, int width, int height, const PictureInk& ink) {
  for (int y = std::max(0, top); y < std::min(image.height, top + height); ++y) {
    for (int x = std::max(0, left); x < std::min(image.width, left + width); ++x) {
      const auto at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x));
      for (std::size_t k = 0; k < 3; ++k) image.pixels[at + k] = static_cast<std::uint16_t>(257u * ink[k]);
      image.pixels[at + 3] = 65535;
    }
  }
}

// The width of a line of text in pixels. A character is 5 x 8 dots, of dot x dot pixels each, and one dot
// apart from the next.
int text_width(std::string_view text, int dot) {
  return dot * (kAdvance * static_cast<int>(text.size()) - 1);
}

// Draws printable ASCII; other bytes show as a question mark.
void draw_text(RgbaImage16& image, int left, int top, int dot, std::string_view text, const PictureInk& ink) {
  for (const char c : text) {
    const char known = c < kFirstGlyph || c > kLastGlyph ? kNoGlyph : c;
    const std::uint64_t glyph = kGlyphs[known - kFirstGlyph];
    for (int x = 0; x < kGlyphColumns; ++x) {
      for (int y = 0; y < kGlyphRows; ++y) {
        if ((glyph >> (8 * x + y) & 1u) != 0)
          fill_rectangle(image, left + x * dot, top + y * dot, dot, dot, ink);
      }
    }
    left += kAdvance * dot;
  }
}

constexpr int kLeastMarkedWidth = 160, kLeastMarkedHeight = 120;
constexpr int kStripDots = 24, kBarTop = 4, kBarDots = 6, kTextTop = 13;  // dots from the top of the strip

int dot_side(int height) { return 1 + height / 600; }

std::string four_digits(double value) { return fmt::format("{:.4g}", value); }

// A length of one digit, without an exponent where few zeros do.
std::string length_digits(double length) {
  return length >= 1.0 && length < 1e7 ? fmt::format("{:.0f}", length) : four_digits(length);
}

// The largest of 1, 2 and 5 times a power of ten that is not above `most`.
double round_length(double most) {
  double power = 1.0;
  while (power > most) power /= 10.0;
  while (power * 10.0 <= most) power *= 10.0;
  return power * 5.0 <= most ? 5.0 * power : power * 2.0 <= most ? 2.0 * power : power;
}

// A pinhole has no one scale of lengths.
bool has_length_bar(const PreviewOptions& options) {
  const auto is_pinhole = [](const Camera& view) { return view.field_of_view > 0.0; };
  return options.marks.length_unit && std::none_of(options.views.begin(), options.views.end(), is_pinhole);
}

class MarksPainter {
 public:
  MarksPainter(RgbaImage16& image, const PreviewOptions& options, int strip)
      : image_(image), options_(options), dot_(dot_side(image.height)), top_(image.height - strip) {
    const bool light = !options.transparent && options.background.y > 0.2f;
    ink_ = light ? PictureInk{40, 40, 40} : PictureInk{235, 235, 235};
  }

  void value_bar(const ValueScale& scale) {
    const int left = image_.width * 36 / 100, right = image_.width * 97 / 100;
    for (int x = left; x < right; ++x) {
      const Vec3<float> c = sequential_color((x - left) / (right - left - 1.0));
      fill_rectangle(image_, x, top_ + kBarTop * dot_, 1, kBarDots * dot_,
                     {srgb_byte(c.x), srgb_byte(c.y), srgb_byte(c.z)});
    }
    const std::string low = four_digits(scale.low), high = four_digits(scale.high);
    text(left, low);
    text(right - text_width(high, dot_), high);
    const int room = right - left - 2 * std::max(text_width(low, dot_), text_width(high, dot_)) - 12 * dot_;
    const std::string title = scale.title.substr(0, static_cast<std::size_t>(std::max(0, room / (6 * dot_))));
    text((left + right - text_width(title, dot_)) / 2, title);
  }

  void length_bar(double length_per_pixel, const std::string& unit) {
    const double length = round_length(0.25 * image_.width * length_per_pixel);
    const int pixels = static_cast<int>(length / length_per_pixel + 0.5), left = image_.width * 3 / 100;
    const int line = top_ + (kBarTop + kBarDots) * dot_ - dot_;
    fill_rectangle(image_, left, line, pixels, dot_, ink_);
    for (const int end : {left, left + pixels - dot_})
      fill_rectangle(image_, end, line - 2 * dot_, dot_, 3 * dot_, ink_);
    text(left, length_digits(length) + (unit.empty() ? "" : " " + unit));
  }

  // Words to the upper right of a place, on a dark background.
  void label(double px, double py, const std::string& words) {
    const int left = rounded(px) + 4 * dot_, top = rounded(py) - 12 * dot_;
    fill_rectangle(image_, left - 2 * dot_, top - dot_, text_width(words, dot_) + 4 * dot_, 10 * dot_,
                   {25, 25, 25});
    draw_text(image_, left, top, dot_, words, {255, 255, 255});
  }

  // A dot of a ring, from red to yellow.
  void ring_dot(double px, double py, double shade) {
    const int thick = dot_ + 1;
    fill_rectangle(image_, rounded(px) - thick / 2, rounded(py) - thick / 2, thick, thick,
                   {255, static_cast<std::uint8_t>(40.0 + 200.0 * std::clamp(shade, 0.0, 1.0)), 30});
  }

  // The axes of the mesh as a view sees them, in the lower left corner of its panel.
  void axes(const ViewCamera& camera, double left, double bottom, double panel_height) {
    const double arm = std::max(8.0 * dot_, 0.045 * panel_height), reach = arm + 9.0 * dot_;
    const int x = static_cast<int>(left + reach), y = static_cast<int>(bottom - reach);
    if (!is_empty(x, y, static_cast<int>(reach))) return;
    constexpr std::array<PictureInk, 3> kInks{{{235, 90, 80}, {95, 190, 95}, {100, 140, 245}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d axis{k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
      const double dx = dot(axis, camera.right), dy = -dot(axis, camera.up);
      if (dx * dx + dy * dy < 0.01) continue;  // the axis points to the viewer, or away
      for (int step = 0; step <= static_cast<int>(arm); ++step)
        fill_rectangle(image_, x + rounded(dx * step), y + rounded(dy * step), dot_, dot_, kInks[k]);
      const double end = arm + 5.0 * dot_;
      draw_text(image_, x + rounded(dx * end) - 2 * dot_, y + rounded(dy * end) - 4 * dot_, dot_,
                std::string_view("xyz").substr(k, 1), kInks[k]);
    }
  }

 private:
  static int rounded(double value) { return static_cast<int>(std::floor(value + 0.5)); }

  void text(int left, const std::string& words) {
    draw_text(image_, left, top_ + kTextTop * dot_, dot_, words, ink_);
  }

  // Whether a square shows nothing but background, all of whose pixels are alike.
  bool is_empty(int x, int y, int reach) const {
    const auto at = [&](int u, int v) {
      return &image_.pixels[4 * (static_cast<std::size_t>(v) * static_cast<std::size_t>(image_.width) +
                                 static_cast<std::size_t>(u))];
    };
    if (x - reach < 0 || y - reach < 0 || x + reach >= image_.width || y + reach >= image_.height)
      return false;
    const std::uint16_t* first = at(x - reach, y + reach);
    for (int v = y - reach; v <= y + reach; ++v) {
      for (int u = x - reach; u <= x + reach; ++u) {
        if (!std::equal(first, first + 4, at(u, v))) return false;
      }
    }
    return true;
  }

  RgbaImage16& image_;
  const PreviewOptions& options_;
  int dot_, top_;
  PictureInk ink_{};
};

}  // namespace

ValueRange value_range(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::erase_if(sorted, [](double value) { return !std::isfinite(value); });
  if (sorted.empty()) sorted = {0.0};
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted_quantile(sorted, 0.01), high = sorted_quantile(sorted, 0.99);
  return {low, high > low ? high : low + 1.0, sorted.front(), sorted.back()};
}

std::string column_title(const std::string& name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kUnits{{{"_m_s2", "m/s2"},
                                                                                 {"_J_kg", "J/kg"},
                                                                                 {"_deg", "deg"},
                                                                                 {"_km", "km"},
                                                                                 {"_cm", "cm"},
                                                                                 {"_mm", "mm"},
                                                                                 {"_m", "m"},
                                                                                 {"_s", "s"}}};
  std::string words = name, unit;
  for (const auto& [ending, symbol] : kUnits) {
    if (!unit.empty() || !name.ends_with(ending) || name.size() == ending.size()) continue;
    words.resize(name.size() - ending.size());
    unit = " [" + std::string(symbol) + "]";
  }
  std::replace(words.begin(), words.end(), '_', ' ');
  return words + unit;
}

void draw_caption(RgbaImage16& image, int left, int top, const std::string& text) {
  draw_text(image, left, top, 2, text, {255, 255, 255});
}

int marks_height(const PreviewOptions& options) {
  if (options.width < kLeastMarkedWidth || options.height < kLeastMarkedHeight) return 0;
  return options.marks.values || has_length_bar(options) ? kStripDots * dot_side(options.height) : 0;
}

namespace {

constexpr int kRingDots = 512;
constexpr double kRingLift = 0.01;  // radii above the ground, so that few dots lie below the surface

// The ground below a place of the ring's circle or above it, by at most a radius; none where there is none.
std::optional<Vec3d> draped(const PlaceRing& ring, const Vec3d& outwards, const RayScene& scene) {
  const Vec3d start = scene.to_unit(ring.center + ring.radius * (outwards + ring.normal));
  const RayHit hit = scene.first_hit(to_float(start), to_float(-ring.normal));
  const double radius = ring.radius * scene.scale();
  if (!hit.found || double{hit.distance} > 2.0 * radius) return std::nullopt;
  return start + (kRingLift * radius - double{hit.distance}) * ring.normal;
}

void draw_ring(MarksPainter& painter, const PlaceRing& ring, std::size_t view, const PreviewRays& rays,
               const RayScene& scene) {
  const Tangents<double> along = crossed_tangents(ring.normal);
  for (int k = 0; k < kRingDots; ++k) {
    const portable::SineCosine turn = portable::sine_and_cosine(2.0 * std::numbers::pi * k / kRingDots);
    const Vec3d outwards = turn.cosine * along.first + turn.sine * along.second;
    const std::optional<Vec3d> place = draped(ring, outwards, scene);
    if (!place) continue;
    if (const auto at = rays.seen_at(view, *place, scene))
      painter.ring_dot(at->first, at->second, ring.shade);
  }
}

}  // namespace

void draw_marks(RgbaImage16& image, const PreviewOptions& options, const PreviewRays& rays,
                const RayScene& scene) {
  const PictureMarks& marks = options.marks;
  if (image.width < kLeastMarkedWidth || image.height < kLeastMarkedHeight) return;
  MarksPainter painter(image, options, marks_height(options));
  if (marks.values) painter.value_bar(*marks.values);
  for (std::size_t view = 0; view < options.views.size(); ++view) {
    const ViewCamera& camera = rays.camera(view);
    for (const PlaceRing& ring : marks.rings) draw_ring(painter, ring, view, rays, scene);
    for (const PlaceLabel& label : marks.labels) {
      const auto at = rays.seen_at(view, scene.to_unit(label.place), scene);
      if (at) painter.label(at->first, at->second, label.text);
    }
    if (!marks.axes) continue;
    const auto [left, bottom] = rays.lower_left(view);
    painter.axes(camera, left, bottom, rays.panel_height());
  }
  if (has_length_bar(options)) painter.length_bar(rays.pixel() / scene.scale(), *marks.length_unit);
}

}  // namespace astrolith
