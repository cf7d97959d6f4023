// A page that is drawn once and written as PNG, SVG or PDF, or drawn over a picture: text, pictures, curves
// and axes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "synthesis/picture/image_file.h"

struct _cairo;
struct _cairo_surface;

namespace astrolith {

class OutputFile;

struct Axis {
  double low = 0.0, high = 1.0;                       // values at the two ends; high may lie below low
  std::vector<std::pair<double, std::string>> ticks;  // value, text
  std::string label;
};

// An axis from low to high (low < high) with about five ticks at multiples of 1, 2 or 5 times a power of ten.
// Ticks are at least `smallest_step` apart.
Axis linear_axis(double low, double high, const std::string& label, double smallest_step = 0.0);

// An axis of log10(value), whose ticks name the values 1, 2 and 5 times a power of ten between low and high.
// The range is widened to whole ticks. Both ends are positive values, low <= high.
Axis logarithmic_axis(double low, double high, const std::string& label);

// A box on the page. Lengths are points, 1/72 inch; y points down.
struct Rectangle {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

// An sRGB colour, components in [0, 1].
struct Ink {
  double red = 0.15, green = 0.15, blue = 0.15;
};

// All lengths and places are points of the page, its upper left corner is (0, 0).
class Figure {
 public:
  enum class Paper { kWhite, kNone };
  Figure(double width, double height, Paper paper = Paper::kWhite);

  enum class Align { kLeft, kCenter, kRight };
  // Text of one size whose baseline lies at y; x is its left end, middle or right end.
  void text(double x, double y, const std::string& text, double size, Align align = Align::kLeft,
            bool bold = false, const Ink& ink = {});
  // Text that reads upwards, its baseline at x and its middle at y.
  void vertical_text(double x, double y, const std::string& text, double size);
  // rgb: row-major (height x width x 3), sRGB; stretched over `at`. `smooth` suits photos, blocks suit grids.
  void picture(const Rectangle& at, int width, int height, std::span<const std::uint8_t> rgb, bool smooth);
  void picture(const Rectangle& at, const RgbImage& image, bool smooth);
  void picture(const Rectangle& at, const RgbaImage16& image);  // in 8 bits, with its coverage
  void fill(const Rectangle& at, const Ink& ink);
  void frame(const Rectangle& at);
  void line(double x0, double y0, double x1, double y1, double width, const Ink& ink = {});
  // Ticks, texts and labels of x below and of y (upwards) to the left of a frame.
  void axes(const Rectangle& at, const Axis& x, const Axis& y, bool grid = false);
  void y_axis_on_the_right(const Rectangle& at, const Axis& y);
  // A curve through points in axis units; at most 60 points are marked by dots.
  void curve(const Rectangle& at, const Axis& x, const Axis& y,
             const std::vector<std::pair<double, double>>& points, const Ink& ink);
  void path(const std::vector<std::pair<double, double>>& points, double width, const Ink& ink);
  // A circle, cut off at the border of `inside`.
  void circle(const Rectangle& inside, double x, double y, double radius, double line_width, const Ink& ink);

  // Draws all of another page over this one.
  void add(const Figure& other);

  double width() const { return width_; }
  double height() const { return height_; }

  // What text of a size is wide.
  double text_width(const std::string& text, double size, bool bold = false) const;

  // Draws the page over a picture, whose pixels are its points.
  void draw_over(RgbaImage16& image) const;

  // Each throws InputError where the file cannot be written, WorkError where the page cannot be drawn. A page
  // of vectors has so many of its points in a point of 1/72 inch.
  void write_png(const std::filesystem::path& file, double pixels_per_inch) const;
  void write_svg(const std::filesystem::path& file, double points = 1.0) const;
  void write_pdf(const std::filesystem::path& file, double points = 1.0) const;

 private:
  using VectorPage = _cairo_surface*(OutputFile& out, double width, double height);

  // Adds a step in its own state of the context, with `ink` as its colour. Steps are kept as functions,
  // because Cairo 1.16 never frees a recording that it has painted on a page of SVG.
  void draw(std::function<void(_cairo*)> step, const Ink& ink = {});
  void text(double x, double y, double angle, const std::string& words, double size, Align align, bool bold,
            const Ink& ink);
  void image(const Rectangle& at, const std::shared_ptr<_cairo_surface>& pixels, bool smooth);
  // `name` begins the message of an error.
  void draw_on(_cairo_surface* page, double scale, const std::string& name) const;
  void write_vectors(const std::filesystem::path& file, double points, VectorPage* make) const;

  struct Free {
    void operator()(_cairo* context) const;
    void operator()(_cairo_surface* surface) const;
  };
  double width_, height_;
  std::unique_ptr<_cairo, Free> measure_;  // has the size of text
  std::vector<std::function<void(_cairo*)>> steps_;
};

// The place on the page of a value on a horizontal or a vertical axis of the diagram `at`.
double place_along_x(double value, const Axis& axis, const Rectangle& at);
double place_along_y(double value, const Axis& axis, const Rectangle& at);

}  // namespace astrolith
