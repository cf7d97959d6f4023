#include "synthesis/picture/figure.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

double log10(double x) { return portable::log(x) / std::numbers::ln10; }

// The smallest of 2, 5 and 10 times a power of ten that is larger than a fifth of the extent.
double round_step(double extent) {
  const double raw = extent / 5.0, power = portable::pow(10.0, std::floor(log10(raw)));
  return power * (raw / power < 2.0 ? 2.0 : raw / power < 5.0 ? 5.0 : 10.0);
}

// Tick k of the sequence ..., 0.5, 1, 2, 5, 10, ...; tick 0 is 1.
double round_value(int k) {
  constexpr double kMantissas[] = {1.0, 2.0, 5.0};
  const int decade = k >= 0 ? k / 3 : -((2 - k) / 3);
  return kMantissas[k - 3 * decade] * portable::pow(10.0, decade);
}

constexpr double kTickLength = 3.0;
constexpr double kTickText = 7.5;   // size of the ticks' numbers
constexpr double kLabelText = 8.5;  // size of an axis's label
constexpr Ink kGrid{0.88, 0.88, 0.88};

double place(double value, const Axis& axis, double begin, double extent) {
  return begin + extent * (value - axis.low) / (axis.high - axis.low);
}

cairo_status_t append(void* file, const unsigned char* data, unsigned int length) {
  try {
    static_cast<OutputFile*>(file)->write(data, length);
  } catch (const std::exception&) {
    return CAIRO_STATUS_WRITE_ERROR;
  }
  return CAIRO_STATUS_SUCCESS;
}

// The number of bytes of a UTF-8 character with this first byte, or 0 if no character starts with it.
std::size_t utf8_length(unsigned char first) {
  return first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
}

// Replaces all characters outside ASCII by question marks if the text is not valid UTF-8. File names may be
// invalid, and Cairo draws nothing more after it met an invalid text.
std::string printable(std::string text) {
  bool valid = true;
  for (std::size_t i = 0, next = 0; i < text.size() && valid; i = next) {
    const std::size_t length = utf8_length(static_cast<unsigned char>(text[i]));
    next = i + length;
    valid = length > 0 && next <= text.size();
    for (std::size_t k = i + 1; valid && k < next; ++k) {
      valid = (static_cast<unsigned char>(text[k]) & 0xc0) == 0x80;
    }
  }
  for (char& c : text) {
    if (!valid && static_cast<unsigned char>(c) >= 0x80) c = '?';
  }
  return text;
}

void select_font(cairo_t* c, double size, bool bold) {
  cairo_select_font_face(c, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(c, size);
}

void require_success(cairo_status_t status, const std::string& name) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw WorkError(name + ": the figure could not be drawn (" + cairo_status_to_string(status) + ")");
}

// Lays a pixel of Cairo, multiplied by its alpha, over one of 16 bits.
void lay_over(std::uint32_t argb, std::uint16_t* pixel) {
  const std::uint32_t alpha = argb >> 24;
  if (alpha == 0) return;
  const double over = alpha / 255.0, below = (1.0 - over) * pixel[3] / 65535.0, cover = over + below;
  for (unsigned k = 0; k < 3; ++k) {
    const double value = (argb >> (16 - 8 * k) & 0xffu) / 255.0;
    pixel[k] = static_cast<std::uint16_t>((65535.0 * value + below * pixel[k]) / cover + 0.5);
  }
  pixel[3] = static_cast<std::uint16_t>(65535.0 * cover + 0.5);
}

}  // namespace

Axis linear_axis(double low, double high, const std::string& label, double smallest_step) {
  Axis axis{low, high, {}, label};
  const double step = std::max(smallest_step, round_step(high - low));
  const double rounding = 1e-9 * step;
  // As many digits as tell neighbours apart.
  const double most = std::max(std::fabs(low), std::fabs(high));
  const int digits = std::clamp(2 + static_cast<int>(std::ceil(log10(std::max(1.0, most / step)))), 6, 17);
  const double first = std::ceil((low - rounding) / step) + 0.0, last = std::floor((high + rounding) / step);
  for (double k = first; k <= last && axis.ticks.size() < 20; k += 1.0)
    axis.ticks.emplace_back(k * step, fmt::format("{:.{}g}", k * step, digits));
  return axis;
}

Axis logarithmic_axis(double low, double high, const std::string& label) {
  constexpr double kRounding = 1.0 + 1e-9;
  int first = 3 * static_cast<int>(std::floor(log10(low)));
  while (round_value(first + 1) <= low * kRounding) ++first;
  int last = first + 1;
  while (round_value(last) * kRounding < high) ++last;
  Axis axis{log10(round_value(first)), log10(round_value(last)), {}, label};
  for (int k = first; k <= last; ++k) {
    axis.ticks.emplace_back(log10(round_value(k)), fmt::format("{:g}", round_value(k)));
  }
  return axis;
}

double place_along_x(double value, const Axis& axis, const Rectangle& at) {
  return place(value, axis, at.x, at.width);
}

double place_along_y(double value, const Axis& axis, const Rectangle& at) {
  return place(value, axis, at.bottom(), -at.height);
}

void Figure::Free::operator()(cairo_t* context) const { cairo_destroy(context); }
void Figure::Free::operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }

Figure::Figure(double width, double height, Paper paper) : width_(width), height_(height) {
  // Text is measured as on a page of points, whose glyphs no grid of pixels moves.
  const std::unique_ptr<cairo_surface_t, Free> points(
      cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, nullptr));
  measure_.reset(cairo_create(points.get()));
  if (paper == Paper::kWhite) draw([](cairo_t* c) { cairo_paint(c); }, {1.0, 1.0, 1.0});
}

void Figure::draw(std::function<void(cairo_t*)> step, const Ink& ink) {
  steps_.push_back([ink, step = std::move(step)](cairo_t* c) {
    cairo_save(c);
    cairo_set_source_rgb(c, ink.red, ink.green, ink.blue);
    step(c);
    cairo_new_path(c);  // text leaves a point behind
    cairo_restore(c);
  });
}

void Figure::line(double x0, double y0, double x1, double y1, double width, const Ink& ink) {
  draw(
      [=](cairo_t* c) {
        cairo_set_line_width(c, width);
        cairo_move_to(c, x0, y0);
        cairo_line_to(c, x1, y1);
        cairo_stroke(c);
      },
      ink);
}

double Figure::text_width(const std::string& words, double size, bool bold) const {
  select_font(measure_.get(), size, bold);
  cairo_text_extents_t extents;
  cairo_text_extents(measure_.get(), words.c_str(), &extents);
  return extents.x_advance;
}

void Figure::text(double x, double y, const std::string& words, double size, Align align, bool bold,
                  const Ink& ink) {
  text(x, y, 0.0, printable(words), size, align, bold, ink);
}

void Figure::text(double x, double y, double angle, const std::string& words, double size, Align align,
                  bool bold, const Ink& ink) {
  const double shift = align == Align::kLeft ? 0.0 : align == Align::kCenter ? 0.5 : 1.0;
  const double before = shift == 0.0 ? 0.0 : shift * text_width(words, size, bold);
  draw(
      [=](cairo_t* c) {
        select_font(c, size, bold);
        cairo_translate(c, x, y);
        cairo_rotate(c, angle);
        cairo_move_to(c, -before, 0.0);
        cairo_show_text(c, words.c_str());
      },
      ink);
}

void Figure::vertical_text(double x, double y, const std::string& words, double size) {
  text(x, y, -0.5 * std::numbers::pi, printable(words), size, Align::kCenter, false, {});
}

void Figure::picture(const Rectangle& at, int width, int height, std::span<const std::uint8_t> rgb,
                     bool smooth) {
  const std::shared_ptr<cairo_surface_t> image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height),
                                               Free{});
  unsigned char* data = cairo_image_surface_get_data(image.get());
  if (data == nullptr) throw WorkError("figure: a picture is too large to be drawn");
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(image.get()));
  std::size_t i = 0;
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(data + y * stride);
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x, i += 3) {
      row[x] = std::uint32_t{rgb[i]} << 16 | std::uint32_t{rgb[i + 1]} << 8 | rgb[i + 2];
    }
  }
  cairo_surface_mark_dirty(image.get());
  this->image(at, image, smooth);
}

void Figure::image(const Rectangle& at, const std::shared_ptr<cairo_surface_t>& pixels, bool smooth) {
  draw([=](cairo_t* c) {
    const int width = cairo_image_surface_get_width(pixels.get()),
              height = cairo_image_surface_get_height(pixels.get());
    cairo_rectangle(c, at.x, at.y, at.width, at.height);
    cairo_clip(c);
    cairo_translate(c, at.x, at.y);
    cairo_scale(c, at.width / width, at.height / height);
    cairo_set_source_surface(c, pixels.get(), 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(c), smooth ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
    cairo_pattern_set_extend(cairo_get_source(c), CAIRO_EXTEND_PAD);
    cairo_paint(c);
  });
}

void Figure::picture(const Rectangle& at, const RgbaImage16& given) {
  const std::shared_ptr<cairo_surface_t> pixels(
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, given.width, given.height), Free{});
  unsigned char* data = cairo_image_surface_get_data(pixels.get());
  if (data == nullptr) throw WorkError("figure: a picture is too large to be drawn");
  const std::vector<std::uint8_t> rgba = rgba_bytes(given);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(pixels.get()));
  std::size_t i = 0;
  for (std::size_t y = 0; y < static_cast<std::size_t>(given.height); ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(data + y * stride);
    for (std::size_t x = 0; x < static_cast<std::size_t>(given.width); ++x, i += 4) {
      const std::uint32_t alpha = rgba[i + 3];
      const auto times_alpha = [&](std::uint32_t value) { return (value * alpha + 127) / 255; };
      row[x] =
          alpha << 24 | times_alpha(rgba[i]) << 16 | times_alpha(rgba[i + 1]) << 8 | times_alpha(rgba[i + 2]);
    }
  }
  cairo_surface_mark_dirty(pixels.get());
  image(at, pixels, false);
}

void Figure::add(const Figure& other) {
  steps_.insert(steps_.end(), other.steps_.begin(), other.steps_.end());
}

void Figure::picture(const Rectangle& at, const RgbImage& image, bool smooth) {
  picture(at, image.width, image.height, image.pixels, smooth);
}

void Figure::fill(const Rectangle& at, const Ink& ink) {
  draw(
      [=](cairo_t* c) {
        cairo_rectangle(c, at.x, at.y, at.width, at.height);
        cairo_fill(c);
      },
      ink);
}

void Figure::frame(const Rectangle& at) {
  draw([=](cairo_t* c) {
    cairo_set_line_width(c, 0.7);
    cairo_rectangle(c, at.x, at.y, at.width, at.height);
    cairo_stroke(c);
  });
}

void Figure::axes(const Rectangle& at, const Axis& x, const Axis& y, bool grid) {
  const double bottom = at.bottom();
  for (const auto& [value, words] : x.ticks) {
    const double px = place_along_x(value, x, at);
    if (grid) line(px, at.y, px, bottom, 0.5, kGrid);
    line(px, bottom, px, bottom + kTickLength, 0.7, {});
    text(px, bottom + kTickLength + kTickText + 1.0, words, kTickText, Align::kCenter);
  }
  double widest = 0.0;
  for (const auto& [value, words] : y.ticks) {
    const double py = place_along_y(value, y, at);
    widest = std::max(widest, text_width(words, kTickText));
    if (grid) line(at.x, py, at.x + at.width, py, 0.5, kGrid);
    line(at.x - kTickLength, py, at.x, py, 0.7, {});
    text(at.x - kTickLength - 2.0, py + 0.35 * kTickText, words, kTickText, Align::kRight);
  }
  text(at.x + 0.5 * at.width, bottom + 25.0, x.label, kLabelText, Align::kCenter);
  vertical_text(at.x - std::max(30.0, kTickLength + 6.0 + widest), at.y + 0.5 * at.height, y.label,
                kLabelText);
  frame(at);
}

void Figure::y_axis_on_the_right(const Rectangle& at, const Axis& y) {
  const double right = at.x + at.width;
  for (const auto& [value, words] : y.ticks) {
    const double py = place_along_y(value, y, at);
    line(right, py, right + kTickLength, py, 0.7, {});
    text(right + kTickLength + 2.0, py + 0.35 * kTickText, words, kTickText);
  }
  vertical_text(right + 34.0, at.y + 0.5 * at.height, y.label, kLabelText);
  frame(at);
}

void Figure::curve(const Rectangle& at, const Axis& x, const Axis& y,
                   const std::vector<std::pair<double, double>>& points, const Ink& ink) {
  constexpr std::size_t kFew = 60;
  draw(
      [=](cairo_t* c) {
        const auto px = [&](double value) { return place_along_x(value, x, at); };
        const auto py = [&](double value) { return place_along_y(value, y, at); };
        cairo_set_line_width(c, 1.4);
        cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
        for (const auto& [vx, vy] : points) cairo_line_to(c, px(vx), py(vy));
        cairo_stroke(c);
        if (points.size() > kFew) return;
        for (const auto& [vx, vy] : points) {
          cairo_arc(c, px(vx), py(vy), 2.0, 0.0, 2.0 * std::numbers::pi);
          cairo_fill(c);
        }
      },
      ink);
}

void Figure::path(const std::vector<std::pair<double, double>>& points, double width, const Ink& ink) {
  draw(
      [=](cairo_t* c) {
        cairo_set_line_width(c, width);
        cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
        cairo_set_line_cap(c, CAIRO_LINE_CAP_ROUND);
        for (const auto& [x, y] : points) cairo_line_to(c, x, y);
        cairo_stroke(c);
      },
      ink);
}

void Figure::circle(const Rectangle& inside, double x, double y, double radius, double line_width,
                    const Ink& ink) {
  draw(
      [=](cairo_t* c) {
        cairo_rectangle(c, inside.x, inside.y, inside.width, inside.height);
        cairo_clip(c);
        cairo_set_line_width(c, line_width);
        cairo_arc(c, x, y, radius, 0.0, 2.0 * std::numbers::pi);
        cairo_stroke(c);
      },
      ink);
}

void Figure::draw_on(cairo_surface_t* page, double scale, const std::string& name) const {
  const std::unique_ptr<cairo_t, Free> c(cairo_create(page));
  cairo_scale(c.get(), scale, scale);
  for (const auto& step : steps_) step(c.get());
  require_success(cairo_status(c.get()), name);
}

// Bands of rows, so that a large picture needs no second one beside it.
void Figure::draw_over(RgbaImage16& image) const {
  if (steps_.empty()) return;
  constexpr int kBand = 256;
  for (int first = 0; first < image.height; first += kBand) {
    const int rows = std::min(kBand, image.height - first);
    const std::unique_ptr<cairo_surface_t, Free> band(
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, image.width, rows));
    cairo_surface_set_device_offset(band.get(), 0.0, -first);
    draw_on(band.get(), 1.0, "picture");
    cairo_surface_flush(band.get());
    const unsigned char* data = cairo_image_surface_get_data(band.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(band.get()));
    for (int y = 0; y < rows; ++y) {
      const auto* row = reinterpret_cast<const std::uint32_t*>(data + static_cast<std::size_t>(y) * stride);
      std::uint16_t* pixel =
          &image.pixels[4 * static_cast<std::size_t>(first + y) * static_cast<std::size_t>(image.width)];
      for (int x = 0; x < image.width; ++x, pixel += 4) lay_over(row[x], pixel);
    }
  }
}

void Figure::write_png(const std::filesystem::path& file, double pixels_per_inch) const {
  const double scale = pixels_per_inch / 72.0;
  const std::unique_ptr<cairo_surface_t, Free> page(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(width_ * scale)),
                                 static_cast<int>(std::lround(height_ * scale))));
  draw_on(page.get(), scale, file.string());
  OutputFile out(file);
  require_success(cairo_surface_write_to_png_stream(page.get(), append, &out), file.string());
  out.commit();
}

void Figure::write_svg(const std::filesystem::path& file, double points) const {
  write_vectors(file, points, [](OutputFile& out, double width, double height) {
    return cairo_svg_surface_create_for_stream(append, &out, width, height);
  });
}

// The file names no time, so that its bytes are the same on every run.
void Figure::write_pdf(const std::filesystem::path& file, double points) const {
  write_vectors(file, points, [](OutputFile& out, double width, double height) {
    cairo_surface_t* page = cairo_pdf_surface_create_for_stream(append, &out, width, height);
    cairo_pdf_surface_set_metadata(page, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    return page;
  });
}

void Figure::write_vectors(const std::filesystem::path& file, double points, VectorPage* make) const {
  OutputFile out(file);
  {
    const std::unique_ptr<cairo_surface_t, Free> page(make(out, width_ / points, height_ / points));
    draw_on(page.get(), 1.0 / points, file.string());
    cairo_surface_finish(page.get());
    require_success(cairo_surface_status(page.get()), file.string());
  }
  out.commit();
}

}  // namespace astrolith
