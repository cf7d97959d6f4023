#include "estimation/gabor/texture_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "estimation/gabor/spectrum/fourier_transform.h"
#include "numerics/files/output_file.h"
#include "numerics/sample_statistics.h"
#include "synthesis/picture/colormap.h"
#include "synthesis/picture/figure.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {
namespace {

constexpr int kReliefSide = 240;        // vertices along a side; 240 x 240 stay below kMostPageVertices
constexpr double kReliefHeight = 0.05;  // from black to white, of the side

struct Rgb {
  double red = 0.0, green = 0.0, blue = 0.0;  // 0 .. 255
  double grey() const { return (red + green + blue) / 3.0; }
};

// The mean of a square of pixels.
Rgb mean_color(const ReportPicture& picture, int x, int y, int side) {
  Rgb sum;
  for (int row = y; row < y + side; ++row) {
    for (int column = x; column < x + side; ++column) {
      const std::size_t i = 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                                 static_cast<std::size_t>(column));
      sum.red += picture.rgb[i];
      sum.green += picture.rgb[i + 1];
      sum.blue += picture.rgb[i + 2];
    }
  }
  const double pixels = static_cast<double>(side) * side;
  return {sum.red / pixels, sum.green / pixels, sum.blue / pixels};
}

// The middle of the picture as a relief in the plane of x and z, which looks along -y. Lengths are vertices.
TurnableSurface relief(const ReportPicture& picture, const std::string& caption) {
  const int shorter = std::min(picture.width, picture.height);
  const int pixels = std::max(1, shorter / (2 * kReliefSide));  // a vertex shows pixels x pixels of them
  const int side = std::min(kReliefSide, shorter / pixels);
  const int left = (picture.width - side * pixels) / 2, top = (picture.height - side * pixels) / 2;
  TurnableSurface surface{caption, {}, {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Rgb color = mean_color(picture, left + x * pixels, top + y * pixels, pixels);
      const double height = kReliefHeight * side * (color.grey() / 255.0 - 0.5);
      surface.mesh.vertices.push_back({static_cast<double>(x), -height, static_cast<double>(side - 1 - y)});
      for (const double part : {color.red, color.green, color.blue}) {
        surface.rgb.push_back(static_cast<std::uint8_t>(part + 0.5));
      }
    }
  }
  const auto n = static_cast<std::uint32_t>(side);
  for (std::uint32_t y = 0; y + 1 < n; ++y) {
    for (std::uint32_t x = 0; x + 1 < n; ++x) {
      const std::uint32_t corner = y * n + x;
      surface.mesh.triangles.push_back({corner, corner + n, corner + 1});
      surface.mesh.triangles.push_back({corner + 1, corner + n, corner + n + 1});
    }
  }
  return surface;
}

constexpr double kDecades = 6.0;  // range of the spectra shown
// Lengths on the page, in points.
constexpr double kPanel = 200.0;           // side of a panel
constexpr double kLeft = 52.0;             // left end of the first panel
constexpr double kTop = 58.0;              // upper end of the first panel
constexpr double kColumn = kPanel + 58.0;  // distance from panel to panel along a row
constexpr double kRow = kPanel + 74.0;     // distance from panel to panel down a column
constexpr double kPageWidth = kLeft + 3.0 * kColumn + 14.0;
constexpr double kPageHeight = kTop + 2.0 * kRow - 24.0;
constexpr Ink kCurve{0.12, 0.35, 0.70};
constexpr Ink kWhite{1.0, 1.0, 1.0};

template <typename T>
ReportPicture tone(std::span<const T> values, int width, int height) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0, square = 0.0;
  for (const T v : values) mean += static_cast<double>(v) / n;
  for (const T v : values) square += (static_cast<double>(v) - mean) * (static_cast<double>(v) - mean) / n;
  const double per_tone = square > 0.0 ? 127.5 / (3.5 * std::sqrt(square)) : 1.0;
  ReportPicture picture{width, height, {}};
  picture.rgb.reserve(3 * values.size());
  for (const T v : values) {
    const double level = std::clamp(127.5 + per_tone * (static_cast<double>(v) - mean), 0.0, 255.0);
    picture.rgb.insert(picture.rgb.end(), 3, static_cast<std::uint8_t>(std::lround(level)));
  }
  return picture;
}

// The logarithm of a spectrum in colours. Frequency 0 lies in the middle; frequencies grow to the right and
// down. `top` is the power of the brightest colour.
ReportPicture spectrum_picture(const PowerSpectrum& spectrum, double top) {
  ReportPicture picture{spectrum.width, spectrum.height, {}};
  for (int y = 0; y < spectrum.height; ++y) {
    for (int x = 0; x < spectrum.width; ++x) {
      const int kx = frequency_bin(x - spectrum.width / 2, spectrum.width);
      const int ky = frequency_bin(y - spectrum.height / 2, spectrum.height);
      const double power =
          spectrum.power[static_cast<std::size_t>(ky) * static_cast<std::size_t>(spectrum.width) +
                         static_cast<std::size_t>(kx)];
      const Vec3<float> color = sequential_color(1.0 + std::log10(std::max(power / top, 1e-30)) / kDecades);
      picture.rgb.insert(picture.rgb.end(), {srgb_byte(color.x), srgb_byte(color.y), srgb_byte(color.z)});
    }
  }
  return picture;
}

Rectangle panel(int column, int row) { return {kLeft + column * kColumn, kTop + row * kRow, kPanel, kPanel}; }

void caption(Figure& page, const Rectangle& at, const std::string& letter, const std::string& words) {
  page.text(at.x, at.y - 7.0, letter, 9.5, Figure::Align::kLeft, true);
  page.text(at.x + 17.0, at.y - 7.0, words, 9.0);
}

// An axis from 0 to size pixels, with ticks at a few round numbers.
Axis pixel_axis(int size, bool upwards, const std::string& label) {
  const double step = size >= 4000 ? 2000 : size >= 800 ? 500 : size >= 300 ? 200 : size >= 150 ? 100 : 25;
  Axis axis{upwards ? double(size) : 0.0, upwards ? 0.0 : double(size), {}, label};
  for (double v = 0.0; v <= size; v += step) axis.ticks.emplace_back(v, fmt::format("{:g}", v));
  return axis;
}

// How much of a pixel lies in a pixel of a smaller picture, along one axis.
struct PixelShare {
  int from, to;
  float share;  // of the pixel `to`
};

std::vector<PixelShare> pixel_shares(int from_size, int to_size, double scale) {
  constexpr double kLeast = 1e-3;
  std::vector<PixelShare> shares;
  for (int to = 0; to < to_size; ++to) {
    const double low = to * scale, high = std::min(low + scale, static_cast<double>(from_size));
    for (int from = static_cast<int>(low); from < high; ++from) {
      const double covered = std::min(from + 1.0, high) - std::max(static_cast<double>(from), low);
      if (covered > kLeast) shares.push_back({from, to, static_cast<float>(covered / (high - low))});
    }
  }
  return shares;
}

// The picture at a smaller scale: each pixel is the mean over the area that it covers.
ReportPicture scaled_down(const ReportPicture& picture, double factor) {
  const auto scaled = [&](int side) { return static_cast<int>(std::lround(side * factor)); };
  ReportPicture small{scaled(picture.width), scaled(picture.height), {}};
  const std::vector<PixelShare> columns = pixel_shares(picture.width, small.width, 1.0 / factor),
                                rows = pixel_shares(picture.height, small.height, 1.0 / factor);
  const std::size_t from_row = 3 * static_cast<std::size_t>(picture.width),
                    to_row = 3 * static_cast<std::size_t>(small.width);
  std::vector<float> sums(to_row * static_cast<std::size_t>(small.height)), row(to_row);
  for (const PixelShare& y : rows) {
    std::fill(row.begin(), row.end(), 0.0f);
    const std::uint8_t* pixels = picture.rgb.data() + static_cast<std::size_t>(y.from) * from_row;
    for (const PixelShare& x : columns) {
      for (int c = 0; c < 3; ++c)
        row[static_cast<std::size_t>(3 * x.to + c)] += x.share * static_cast<float>(pixels[3 * x.from + c]);
    }
    float* sum = sums.data() + static_cast<std::size_t>(y.to) * to_row;
    for (std::size_t i = 0; i < to_row; ++i) sum[i] += y.share * row[i];
  }
  for (const float sum : sums) small.rgb.push_back(static_cast<std::uint8_t>(std::nearbyint(sum)));
  return small;
}

// Draws a photo into a panel, whose side is as long as the longer side of the photo. A photo with more pixels
// than a page shows is scaled down first.
void draw_photo(Figure& page, const Rectangle& within, const ReportPicture& picture) {
  constexpr double kFinest = 800.0;
  const int longer = std::max(picture.width, picture.height);
  const double fit = kPanel / longer;
  const Rectangle at{within.x, within.y, picture.width * fit, picture.height * fit};
  const ReportPicture shown = longer > kFinest ? scaled_down(picture, kFinest / longer) : picture;
  page.picture(at, shown.width, shown.height, shown.rgb, longer >= 128);
  page.axes(at, pixel_axis(picture.width, false, "pixels"), pixel_axis(picture.height, true, "pixels"));
}

Axis frequency_axis(bool upwards, const std::string& label) {
  Axis axis{upwards ? 0.5 : -0.5, upwards ? -0.5 : 0.5, {}, label};
  for (const double v : {-0.5, -0.25, 0.0, 0.25, 0.5}) axis.ticks.emplace_back(v, fmt::format("{:g}", v));
  return axis;
}

void draw_spectrum(Figure& page, const Rectangle& at, const ReportPicture& picture) {
  page.picture(at, picture.width, picture.height, picture.rgb, picture.width > 512);
  page.axes(at, frequency_axis(false, "cycles per pixel along rows"),
            frequency_axis(true, "cycles per pixel down columns"));
}

// Draws every lobe as the circle where it has half its peak. Lobes with much variance get a thicker line.
void draw_lobes(Figure& page, const Rectangle& at, const std::vector<GaborLobe>& lobes) {
  for (const GaborLobe& lobe : lobes) {
    const double share = std::sqrt(lobe.variance / lobes.front().variance);
    for (const double sign : {1.0, -1.0}) {
      page.circle(at, at.x + (0.5 + sign * lobe.frequency_x) * at.width,
                  at.y + (0.5 + sign * lobe.frequency_y) * at.height,
                  std::max(0.8, 0.5 * std::ldexp(1.0, -lobe.bandwidth) * at.width), share > 0.3 ? 1.1 : 0.5,
                  kWhite);
    }
  }
}

void draw_color_bar(Figure& page, const Rectangle& beside) {
  ReportPicture bar{1, 128, {}};
  for (int y = 0; y < bar.height; ++y) {
    const Vec3<float> color = sequential_color(1.0 - (y + 0.5) / bar.height);
    bar.rgb.insert(bar.rgb.end(), {srgb_byte(color.x), srgb_byte(color.y), srgb_byte(color.z)});
  }
  const Rectangle at{beside.x + beside.width + 8.0, beside.y, 9.0, beside.height};
  page.picture(at, bar.width, bar.height, bar.rgb, true);
  Axis axis{-kDecades, 0.0, {}, "log10 of power over the peak"};
  for (int d = 0; d <= static_cast<int>(kDecades); ++d) axis.ticks.emplace_back(-d, fmt::format("{}", -d));
  page.y_axis_on_the_right(at, axis);
}

// Draws the certified relative gap against the steps of the pursuit.
void draw_gap(Figure& page, const Rectangle& at, const BasisPursuitResult& pursuit) {
  std::vector<std::pair<double, double>> points;
  double lowest = -1.0;
  for (const GapSample& s : pursuit.history) {
    points.emplace_back(s.iteration, std::log10(std::clamp(s.relative_gap, 1e-16, 1.0)));
    lowest = std::min(lowest, points.back().second);
  }
  const int last = std::max(1, pursuit.history.empty() ? 1 : pursuit.history.back().iteration);
  const int decades = static_cast<int>(std::ceil(-lowest));
  const Axis x = linear_axis(0.0, last, "steps of the pursuit", 1.0);
  Axis y{-static_cast<double>(decades), 0.0, {}, "log10 of the relative duality gap"};
  for (int d = 0; d <= decades; d += decades > 8 ? 2 : 1) y.ticks.emplace_back(-d, fmt::format("{}", -d));
  page.axes(at, x, y, true);
  page.curve(at, x, y, points, kCurve);
}

void draw_lobe_panels(Figure& page, const GaborFit& fit, const ReportPicture& measured) {
  caption(page, panel(2, 0), "c",
          fmt::format("certified gap of the pursuit {:.1e}", fit.pursuit.relative_gap));
  draw_gap(page, panel(2, 0), fit.pursuit);
  caption(page, panel(2, 1), "f", fmt::format("{} lobes at half their peak, over d", fit.lobes.size()));
  draw_spectrum(page, panel(2, 1), measured);
  draw_lobes(page, panel(2, 1), fit.lobes);
  draw_color_bar(page, panel(2, 1));
}

// The share of the values in each of the bins from -kBeyond to kBeyond, over the largest share of all.
constexpr double kBeyond = 4.0;  // standard deviations of the photo
std::vector<double> histogram(const std::vector<double>& values, double mean, double deviation) {
  constexpr int kBins = 64;
  std::vector<double> shares(kBins);
  for (const double v : values) {
    const double at = ((v - mean) / deviation + kBeyond) / (2.0 * kBeyond) * kBins;
    if (at >= 0.0 && at < kBins)
      shares[static_cast<std::size_t>(at)] += 1.0 / static_cast<double>(values.size());
  }
  return shares;
}

void draw_grey_values(Figure& page, const Rectangle& at, const TextureReport& report) {
  const double mean = sample_mean(report.photo_values),
               deviation = std::sqrt(sample_variance(report.photo_values));
  const std::vector<double> photo_histogram = histogram(report.photo_values, mean, deviation),
                            texture_histogram = histogram(report.texture_values, mean, deviation);
  const double most = std::max(*std::max_element(photo_histogram.begin(), photo_histogram.end()),
                               *std::max_element(texture_histogram.begin(), texture_histogram.end()));
  const Axis x = linear_axis(-kBeyond, kBeyond, "deviations of the photo from its mean", 1.0);
  const Axis y{0.0, 1.05, {{0.0, "0"}, {0.5, "0.5"}, {1.0, "1"}}, "share of the pixels, over the largest"};
  page.axes(at, x, y, true);
  const auto draw = [&](const std::vector<double>& shares, const Ink& ink, double line, const char* words) {
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      points.emplace_back(
          kBeyond * (2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(shares.size()) - 1.0),
          shares[i] / most);
    }
    page.curve(at, x, y, points, ink);
    page.text(at.x + 8.0, at.y + line, words, 8.0, Figure::Align::kLeft, true, ink);
  };
  draw(photo_histogram, {}, 14.0, "photo");
  draw(texture_histogram, kCurve, 26.0, "texture");
}

void draw_image_panels(Figure& page, const TextureReport& report) {
  caption(page, panel(2, 0), "c", "grey values of both");
  draw_grey_values(page, panel(2, 0), report);
  caption(page, panel(2, 1), "f",
          fmt::format("image of the layer, {} x {} pixels", report.image.width, report.image.height));
  draw_photo(page, panel(2, 1), report.image);
}

void write_picture(const ReportPicture& picture, const std::filesystem::path& file) {
  write_png8_rgb({picture.width, picture.height, picture.rgb}, file);
}

}  // namespace

PageTable choice_table(const ModelChoice& choice) {
  PageTable table{{"difference from unseen squares", "values", "filters", "sum", "scatter of the sum"}, {}};
  const auto add = [&](std::string name, const HeldOutScore& score) {
    table.rows.push_back({std::move(name), fmt::format("{:.3f}", score.mean.values),
                          fmt::format("{:.3f}", score.mean.filters), fmt::format("{:.3f}", score.mean.sum()),
                          fmt::format("{:.3f}", score.scatter)});
  };
  for (const TextureModel model : kTextureModels) {
    add(fmt::format("{}{}", model_word(model), model == choice.taken ? " (taken)" : ""),
        choice.scores[static_cast<std::size_t>(model)]);
  }
  add("the photo's own squares", choice.photo);
  return table;
}

PageTable lobe_table(const FittedChannel& channel) {
  const GaborFit& fit = channel.fit;
  const LobeQuality& quality = fit.quality;
  return {{"fit", ""},
          {{"lobes", std::to_string(fit.lobes.size())},
           {"distance from the photo's true spectrum, 0 is perfect",
            fmt::format("{:.3f}; a fit is weak above {:.3f}", quality.residual, quality.weak_above)},
           {"variance in the right octave", fmt::format("{:.1f} %", 100.0 * quality.band_overlap)},
           {"photo's pixels, width x height",
            fmt::format("{} x {}", channel.exemplar.width, channel.exemplar.height)}}};
}

PageTable gaussianity_table(const Gaussianity& g) {
  const auto row = [](const char* name, double value, const char* gaussian) {
    return std::vector<std::string>{name, fmt::format("{:.2f}", value), gaussian};
  };
  return {{"can noise be this photo?", "photo", "Gaussian texture"},
          {row("skewness of the grey values", g.skewness, "0"),
           row("excess kurtosis of the grey values", g.excess_kurtosis, "0"),
           row("excess kurtosis of differences (edges)", g.edge_kurtosis, "0"),
           row("spread of the variance over the photo", g.variance_spread, "1"),
           row("chance that a Gaussian texture is as unusual", g.p_value, "above 0.05")}};
}

void write_texture_page(const TextureReport& report, const std::string& layer, const std::string& verdict,
                        std::vector<PageTable> tables, const std::filesystem::path& folder) {
  const TurnableSurfaces reliefs{relief(report.photo, "photo"), relief(report.texture, layer), "", "", ""};
  write_report_page({report.title,
                     verdict,
                     {reliefs},
                     std::move(tables),
                     {{"report.png", "Photo and texture, and the spectra of both."}}},
                    folder / "index.html");
}

ReportPicture tone_mapped(std::span<const double> values, int width, int height) {
  return tone(values, width, height);
}

ReportPicture tone_mapped(std::span<const float> values, int width, int height) {
  return tone(values, width, height);
}

void write_texture_report(const TextureReport& report, const std::filesystem::path& folder) {
  make_output_folder(folder);
  const double top = *std::max_element(report.measured.power.begin(), report.measured.power.end());
  const ReportPicture measured = spectrum_picture(report.measured, top),
                      shown = spectrum_picture(report.shown, top);

  Figure page(kPageWidth, kPageHeight);
  page.text(kLeft, 27.0, report.title, 12.0, Figure::Align::kLeft, true);
  caption(page, panel(0, 0), "a",
          fmt::format("photo, {} x {} pixels", report.photo.width, report.photo.height));
  draw_photo(page, panel(0, 0), report.photo);
  caption(page, panel(1, 0), "b", "texture, same size");
  draw_photo(page, panel(1, 0), report.texture);
  caption(page, panel(0, 1), "d", "spectrum estimated from the photo");
  draw_spectrum(page, panel(0, 1), measured);
  caption(page, panel(1, 1), "e", report.shown_words);
  draw_spectrum(page, panel(1, 1), shown);
  report.lobes ? draw_lobe_panels(page, *report.lobes, measured) : draw_image_panels(page, report);
  page.write_png(folder / "report.png", 200.0);
  page.write_svg(folder / "report.svg");

  write_picture(report.photo, folder / "exemplar.png");
  write_picture(report.texture, folder / "synthesis.png");
  write_picture(measured, folder / "spectrum_exemplar.png");
  write_picture(shown, folder / "spectrum_fitted.png");
}

}  // namespace astrolith
