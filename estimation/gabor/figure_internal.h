// A page that is drawn once and written as PNG and as SVG: text, pictures, curves and axes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

struct _cairo;
struct _cairo_surface;

namespace astrolith {

// Lengths are points, 1/72 inch; y down.
struct Rectangle {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

struct Ink {
  double red = 0.15, green = 0.15, blue = 0.15;
};

struct Axis {
  double low = 0.0, high = 1.0;
  std::vector<std::pair<double, std::string>> ticks;  // value, text
  std::string label;
};

class Figure {
 public:
  Figure(double width, double height);

  enum class Align { kLeft, kCenter, kRight };
  // Bottom line of the text at y.
  void text(double x, double y, const std::string& text, double size, Align align = Align::kLeft,
            bool bold = false);
  void vertical_text(double x, double y, const std::string& text, double size);  // centred, reading upwards
  // rgb: row-major (height x width x 3), sRGB; stretched over `at`. Smooth for photos, blocks for grids.
  void picture(const Rectangle& at, int width, int height, std::span<const std::uint8_t> rgb, bool smooth);
  void frame(const Rectangle& at);
  // Ticks, texts and labels of x below and y (upwards) to the left of a frame.
  void axes(const Rectangle& at, const Axis& x, const Axis& y, bool grid = false);
  void y_axis_on_the_right(const Rectangle& at, const Axis& y);
  // Points in axis units; dots at the points if there are few.
  void curve(const Rectangle& at, const Axis& x, const Axis& y,
             const std::vector<std::pair<double, double>>& points, const Ink& ink);
  // In points of the page, cut off at the border of `inside`.
  void circle(const Rectangle& inside, double x, double y, double radius, double line_width, const Ink& ink);

  // Throw InputError where the file cannot be written.
  void write_png(const std::filesystem::path& file, double pixels_per_inch) const;
  void write_svg(const std::filesystem::path& file) const;

 private:
  void set(const Ink& ink);
  void line(double x0, double y0, double x1, double y1, double width, const Ink& ink);

  struct Free {
    void operator()(_cairo* context) const;
    void operator()(_cairo_surface* surface) const;
  };
  double width_, height_;
  std::unique_ptr<_cairo_surface, Free> surface_;
  std::unique_ptr<_cairo, Free> context_;
};

}  // namespace astrolith
