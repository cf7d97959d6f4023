// The marks of a picture (picture_marks.h), typeset on a page whose points are the pixels of the picture.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "numerics/portable_angles.h"
#include "numerics/tangent_frame.h"
#include "synthesis/picture/colormap.h"
#include "synthesis/picture/preview_rays_internal.h"

namespace astrolith {
namespace {

constexpr int kLeastMarkedWidth = 160, kLeastMarkedHeight = 120;
constexpr double kStripWithValues = 4.4, kStripOfLengths = 2.6;  // sizes of the text

double text_size(int height) { return std::max(11.0, height / 60.0); }

// A length of one digit, without an exponent where few zeros do.
std::string length_digits(double length) {
  return length >= 1.0 && length < 1e7 ? fmt::format("{:.0f}", length) : fmt::format("{:.4g}", length);
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
  const auto has_no_scale = [](const Camera& view) {
    return view.field_of_view > 0.0 || view.map != MapProjection::kNone;
  };
  return options.marks.length_unit && std::none_of(options.views.begin(), options.views.end(), has_no_scale);
}

// "slope [°]" for "slope [deg]".
std::string typeset_units(std::string words) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kSigns{
      {{"[deg]", "[\u00b0]"}, {"m/s2", "m/s\u00b2"}}};
  for (const auto& [plain, sign] : kSigns) {
    const std::size_t at = words.find(plain);
    if (at != std::string::npos) words.replace(at, plain.size(), sign);
  }
  return words;
}

class MarksPainter {
 public:
  MarksPainter(Figure& page, const RgbaImage16& image, const PreviewOptions& options)
      : page_(page),
        image_(image),
        size_(text_size(image.height)),
        top_(image.height - marks_height(options)) {
    const bool light = !options.transparent && options.background.y > 0.2f;
    if (!light) ink_ = {0.92, 0.92, 0.92};
  }

  // A bar of colours with ticks at round numbers.
  void value_bar(const ValueScale& scale) {
    const Rectangle bar{0.36 * image_.width, top_ + 0.5 * size_, 0.61 * image_.width, 0.75 * size_};
    constexpr int kColors = 256;
    RgbImage colors{kColors, 1, {}};
    for (int i = 0; i < kColors; ++i) {
      const Vec3<float> c = sequential_color(i / (kColors - 1.0));
      colors.pixels.insert(colors.pixels.end(), {srgb_byte(c.x), srgb_byte(c.y), srgb_byte(c.z)});
    }
    page_.picture(bar, colors, true);
    const Axis axis = linear_axis(scale.low, scale.high, "");
    const double baseline = bar.bottom() + 1.3 * size_;
    for (const auto& [value, words] : axis.ticks) {
      const double x = place_along_x(value, axis, bar);
      page_.line(x, bar.bottom(), x, bar.bottom() + 0.3 * size_, line_width(), ink_);
      page_.text(x, baseline, words, size_, Figure::Align::kCenter, false, ink_);
    }
    page_.text(bar.x + 0.5 * bar.width, baseline + 1.35 * size_, typeset_units(scale.title), size_,
               Figure::Align::kCenter, false, ink_);
  }

  void length_bar(double length_per_pixel, const std::string& unit) {
    const double length = round_length(0.25 * image_.width * length_per_pixel);
    const double pixels = length / length_per_pixel, left = 0.03 * image_.width;
    const double line = top_ + 1.25 * size_, end = 0.35 * size_;
    page_.path({{left, line - end}, {left, line}, {left + pixels, line}, {left + pixels, line - end}},
               line_width(), ink_);
    page_.text(left, line + 1.3 * size_, length_digits(length) + (unit.empty() ? "" : " " + unit), size_,
               Figure::Align::kLeft, false, ink_);
  }

  // Words to the upper right of a place, on a dark background.
  void label(double px, double py, const std::string& words) {
    const double left = px + 0.35 * size_, baseline = py - 0.25 * size_, edge = 0.2 * size_;
    page_.fill({left - edge, baseline - 0.8 * size_ - edge, page_.text_width(words, size_) + 2.0 * edge,
                0.8 * size_ + 2.0 * edge},
               {0.1, 0.1, 0.1});
    page_.text(left, baseline, words, size_, Figure::Align::kLeft, false, {1.0, 1.0, 1.0});
  }

  // A line along places of a ring, from red to yellow.
  void ring(const std::vector<std::pair<double, double>>& places, double shade) {
    page_.path(places, 1.5 * line_width(), {1.0, 0.16 + 0.78 * std::clamp(shade, 0.0, 1.0), 0.12});
  }

  // The letter of a view in the upper left corner of its panel.
  void letter(std::size_t view, double left, double top) {
    const std::string words =
        view < 26 ? fmt::format("({})", static_cast<char>('a' + view)) : fmt::format("({})", view + 1);
    page_.text(left + 0.6 * size_, top + 1.5 * size_, words, 1.3 * size_, Figure::Align::kLeft, true, ink_);
  }

  // A meridian or a parallel of a map, as far as the map has it.
  void map_line(const std::vector<std::pair<double, double>>& places) {
    page_.path(places, 0.6 * line_width(), {0.5, 0.5, 0.5});
  }
  void degrees(double x, double y, const std::string& words, Figure::Align align) {
    page_.text(x, y, words, 0.8 * size_, align, false, ink_);
  }
  // On the map itself: light, with a dark edge, so that one reads them on every colour.
  void degrees_on_map(double x, double y, const std::string& words) {
    const double edge = 0.08 * size_;
    for (const auto& [dx, dy] :
         {std::pair(-edge, 0.0), std::pair(edge, 0.0), std::pair(0.0, -edge), std::pair(0.0, edge)})
      page_.text(x + dx, y + dy, words, 0.8 * size_, Figure::Align::kLeft, false, {0.05, 0.05, 0.05});
    page_.text(x, y, words, 0.8 * size_, Figure::Align::kLeft, false, {1.0, 1.0, 1.0});
  }
  double letters_high() const { return size_; }

  // The axes of the mesh as a view sees them, in the lower left corner of its panel.
  void axes(const ViewCamera& camera, double left, double bottom, double panel_height) {
    const double arm = std::max(1.5 * size_, 0.045 * panel_height), reach = arm + 1.2 * size_;
    const double x = left + reach, y = bottom - reach;
    if (!is_empty(static_cast<int>(x), static_cast<int>(y), static_cast<int>(reach))) return;
    constexpr std::array<Ink, 3> kInks{{{0.92, 0.35, 0.31}, {0.37, 0.75, 0.37}, {0.39, 0.55, 0.96}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d axis{k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
      const double dx = dot(axis, camera.right), dy = -dot(axis, camera.up);
      if (dx * dx + dy * dy < 0.01) continue;  // the axis points to the viewer, or away
      page_.path({{x, y}, {x + arm * dx, y + arm * dy}}, 1.5 * line_width(), kInks[k]);
      const double end = arm + 0.6 * size_;
      page_.text(x + end * dx, y + end * dy + 0.3 * size_, std::string("xyz").substr(k, 1), size_,
                 Figure::Align::kCenter, false, kInks[k]);
    }
  }

 private:
  double line_width() const { return std::max(1.0, 0.1 * size_); }

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

  Figure& page_;
  const RgbaImage16& image_;
  double size_, top_;
  Ink ink_;
};

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
  std::vector<std::pair<double, double>> seen;
  const auto end_line = [&] {
    if (seen.size() > 1) painter.ring(seen, ring.shade);
    seen.clear();
  };
  for (int k = 0; k <= kRingDots; ++k) {
    const portable::SineCosine turn = portable::sine_and_cosine(2.0 * std::numbers::pi * k / kRingDots);
    const Vec3d outwards = turn.cosine * along.first + turn.sine * along.second;
    const std::optional<Vec3d> place = draped(ring, outwards, scene);
    const auto at = place ? rays.seen_at(view, *place, scene) : std::nullopt;
    if (!at) {
      end_line();
      continue;
    }
    seen.emplace_back(at->first, at->second);
  }
  end_line();
}

Vec3d at_degrees(double longitude, double latitude) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  const portable::SineCosine a = portable::sine_and_cosine(kRadians * longitude),
                             b = portable::sine_and_cosine(kRadians * latitude);
  return {b.cosine * a.cosine, b.cosine * a.sine, b.sine};
}

std::string longitude_words(int degrees) {
  const int turned = degrees > 180 ? degrees - 360 : degrees;
  return turned == 0 || turned == 180 || turned == -180
             ? fmt::format("{}\u00b0", std::abs(turned))
             : fmt::format("{}\u00b0{}", std::abs(turned), turned > 0 ? "E" : "W");
}

std::string latitude_words(int degrees) {
  return degrees == 0 ? "0\u00b0" : fmt::format("{}\u00b0{}", std::abs(degrees), degrees > 0 ? "N" : "S");
}

// Lines of longitude and latitude over a map, every 30 degrees, and their degrees beside it.
class Graticule {
 public:
  Graticule(MarksPainter& painter, const PreviewRays& rays, std::size_t view)
      : painter_(painter), rays_(rays), view_(view) {}

  void draw() const {
    const Vec3d& from = rays_.camera(view_).from;
    const int middle = from.x < 0.0 ? 180 : 0, half = is_hemisphere() ? 90 : 180;
    for (int longitude = middle - half; longitude <= middle + half; longitude += kStep) {
      // A map's edge belongs to it, whatever the rounding.
      const double inside = std::clamp<double>(longitude, middle - half + kEdge, middle + half - kEdge);
      line([&](double t) { return at_degrees(inside, 90.0 * t); });
      label(at_degrees(inside, is_hemisphere() ? 0.0 : -90.0), longitude_words(longitude), is_hemisphere());
    }
    for (int latitude = -90 + kStep; latitude < 90; latitude += kStep) {
      line([&](double t) { return at_degrees(middle + (half - kEdge) * t, latitude); });
      const auto at = rays_.on_map(view_, at_degrees(middle - half + kEdge, latitude));
      if (at) {
        painter_.degrees(at->first - 0.4 * painter_.letters_high(),
                         at->second + 0.3 * painter_.letters_high(), latitude_words(latitude),
                         Figure::Align::kRight);
      }
    }
  }

 private:
  static constexpr int kStep = 30;
  static constexpr double kEdge = 1e-6;  // degrees

  bool is_hemisphere() const { return rays_.camera(view_).map == MapProjection::kHemisphere; }

  template <typename Place>
  void line(const Place& place) const {
    constexpr int kParts = 90;
    std::vector<std::pair<double, double>> places;
    for (int k = -kParts; k <= kParts; ++k) {
      const auto at = rays_.on_map(view_, place(static_cast<double>(k) / kParts));
      if (at) places.push_back(*at);
    }
    if (places.size() > 1) painter_.map_line(places);
  }

  // Words stand below a place, or on a hemisphere above its equator, where longitudes part.
  void label(const Vec3d& direction, const std::string& words, bool above) const {
    const auto at = rays_.on_map(view_, direction);
    if (!at) return;
    const double size = painter_.letters_high();
    if (above) return painter_.degrees_on_map(at->first + 0.2 * size, at->second - 0.25 * size, words);
    painter_.degrees(at->first, at->second + 1.1 * size, words, Figure::Align::kCenter);
  }

  MarksPainter& painter_;
  const PreviewRays& rays_;
  std::size_t view_;
};

}  // namespace

int marks_height(const PreviewOptions& options) {
  if (options.width < kLeastMarkedWidth || options.height < kLeastMarkedHeight) return 0;
  const double sizes = options.marks.values      ? kStripWithValues
                       : has_length_bar(options) ? kStripOfLengths
                                                 : 0.0;
  return static_cast<int>(std::ceil(sizes * text_size(options.height)));
}

Figure draw_marks(const RgbaImage16& image, const PreviewOptions& options, const PreviewRays& rays,
                  const RayScene& scene) {
  const PictureMarks& marks = options.marks;
  Figure page(image.width, image.height, Figure::Paper::kNone);
  if (image.width < kLeastMarkedWidth || image.height < kLeastMarkedHeight) return page;
  MarksPainter painter(page, image, options);
  if (marks.values) painter.value_bar(*marks.values);
  for (std::size_t view = 0; view < options.views.size(); ++view) {
    for (const PlaceRing& ring : marks.rings) draw_ring(painter, ring, view, rays, scene);
    for (const PlaceLabel& label : marks.labels) {
      const auto at = rays.seen_at(view, scene.to_unit(label.place), scene);
      if (at) painter.label(at->first, at->second, label.text);
    }
    const auto [left, bottom] = rays.lower_left(view);
    if (marks.letters) painter.letter(view, left, bottom - rays.panel_height());
    if (!marks.axes) continue;
    if (rays.camera(view).map != MapProjection::kNone) {
      Graticule(painter, rays, view).draw();
      continue;
    }
    painter.axes(rays.camera(view), left, bottom, rays.panel_height());
  }
  if (has_length_bar(options)) painter.length_bar(rays.pixel() / scene.scale(), *marks.length_unit);
  return page;
}

}  // namespace astrolith
