#include "estimation/gabor/gabor_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <system_error>

#include "estimation/gabor/fourier_transform.h"
#include "numerics/output_file.h"
#include "synthesis/colormap.h"
#include "synthesis/image_file.h"

namespace astrolith {
namespace {

constexpr int kPanel = 400;       // pixels a side
constexpr int kMargin = 28;       // around panels
constexpr int kCaption = 30;      // above each
constexpr double kDecades = 6.0;  // of the spectra shown

const cv::Scalar kInk(40, 40, 40);
const cv::Scalar kPaper(255, 255, 255);

// Brightness such that 3.5 standard deviations on either side of the mean fill the scale.
std::uint8_t tone(double deviations) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(127.5 + 127.5 * deviations / 3.5, 0.0, 255.0)));
}

template <typename T>
std::vector<std::uint8_t> tones(std::span<const T> values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const T v : values) mean += v / n;
  double square = 0.0;
  for (const T v : values) square += (v - mean) * (v - mean) / n;
  const double rms = square > 0.0 ? std::sqrt(square) : 1.0;
  std::vector<std::uint8_t> grey;
  grey.reserve(values.size());
  for (const T v : values) grey.push_back(tone((v - mean) / rms));
  return grey;
}

cv::Mat grey_panel(std::vector<std::uint8_t>& grey, int width, int height) {
  const cv::Mat whole(height, width, CV_8UC1, grey.data());
  const int side = std::min(width, height);
  const cv::Mat square = whole(cv::Rect((width - side) / 2, (height - side) / 2, side, side));
  cv::Mat panel;
  cv::resize(square, panel, {kPanel, kPanel}, 0, 0, side >= kPanel ? cv::INTER_AREA : cv::INTER_CUBIC);
  cv::cvtColor(panel, panel, cv::COLOR_GRAY2RGB);
  return panel;
}

// Frequency 0 in the middle, frequencies growing to the right and down; `top` is the brightest power.
RgbImage spectrum_picture(const PowerSpectrum& spectrum, double top) {
  RgbImage picture{spectrum.width, spectrum.height, {}};
  for (int y = 0; y < spectrum.height; ++y) {
    for (int x = 0; x < spectrum.width; ++x) {
      const int kx = frequency_bin(x - spectrum.width / 2, spectrum.width);
      const int ky = frequency_bin(y - spectrum.height / 2, spectrum.height);
      const double power =
          spectrum.power[static_cast<std::size_t>(ky) * static_cast<std::size_t>(spectrum.width) +
                         static_cast<std::size_t>(kx)];
      const double level = 1.0 + std::log10(std::max(power / top, 1e-30)) / kDecades;
      const Vec3<float> color = sequential_color(level);
      picture.pixels.insert(picture.pixels.end(),
                            {srgb_byte(color.x), srgb_byte(color.y), srgb_byte(color.z)});
    }
  }
  return picture;
}

cv::Mat picture_panel(RgbImage& picture) {
  const cv::Mat whole(picture.height, picture.width, CV_8UC3, picture.pixels.data());
  cv::Mat panel;
  cv::resize(whole, panel, {kPanel, kPanel}, 0, 0,
             picture.width >= kPanel ? cv::INTER_AREA : cv::INTER_NEAREST);
  return panel;
}

// Every lobe as the circle of half its peak, thicker for more variance.
void draw_lobes(const std::vector<GaborLobe>& lobes, cv::Mat& panel) {
  constexpr int kShift = 4;  // OpenCV draws at 1/16 pixel
  constexpr double kSixteenth = 16.0;
  for (const GaborLobe& lobe : lobes) {
    const double share = std::sqrt(lobe.variance / lobes.front().variance);
    for (const double sign : {1.0, -1.0}) {
      const cv::Point center(cvRound((0.5 + sign * lobe.frequency_x) * kPanel * kSixteenth),
                             cvRound((0.5 + sign * lobe.frequency_y) * kPanel * kSixteenth));
      const int radius = cvRound(std::max(1.0, 0.5 * std::ldexp(1.0, -lobe.bandwidth) * kPanel) * kSixteenth);
      cv::circle(panel, center, radius, {255, 255, 255}, share > 0.3 ? 2 : 1, cv::LINE_AA, kShift);
    }
  }
}

void write_text(cv::Mat& sheet, const std::string& text, cv::Point at, double size = 0.5) {
  cv::putText(sheet, text, at, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

// The certified relative gap over the iterations, logarithmic.
cv::Mat gap_panel(const BasisPursuitResult& pursuit) {
  cv::Mat panel(kPanel, kPanel, CV_8UC3, kPaper);
  const int left = 52;
  const int bottom = kPanel - 34;
  const int last = std::max(1, pursuit.history.back().iteration);
  double lowest = 0.0;
  for (const GapSample& s : pursuit.history)
    lowest = std::min(lowest, std::log10(std::max(s.relative_gap, 1e-12)));
  const int decades = std::max(1, static_cast<int>(std::ceil(-lowest)));
  const auto place = [&](double iteration, double log_gap) {
    return cv::Point(left + cvRound((kPanel - left - 12) * iteration / last),
                     12 + cvRound((bottom - 12) * -log_gap / decades));
  };
  for (int d = 0; d <= decades; ++d) {
    cv::line(panel, place(0, -d), place(last, -d), {225, 225, 225}, 1);
    write_text(panel, fmt::format("1e-{}", d), {4, place(0, -d).y + 4}, 0.38);
  }
  cv::rectangle(panel, place(0, 0), place(last, -decades), kInk, 1);
  for (std::size_t i = 0; i < pursuit.history.size(); ++i) {
    const auto at = [&](const GapSample& s) {
      return place(s.iteration, std::log10(std::max(s.relative_gap, 1e-12)));
    };
    const cv::Scalar blue(31, 90, 180);
    if (i > 0) cv::line(panel, at(pursuit.history[i - 1]), at(pursuit.history[i]), blue, 2, cv::LINE_AA);
    if (pursuit.history.size() <= 60) cv::circle(panel, at(pursuit.history[i]), 3, blue, -1, cv::LINE_AA);
  }
  write_text(panel, fmt::format("iterations 0 to {}", last), {left, kPanel - 10}, 0.42);
  return panel;
}

void place_panel(const cv::Mat& panel, int column, int row, const std::string& caption, cv::Mat& sheet) {
  const int x = kMargin + column * (kPanel + kMargin);
  const int y = kMargin + row * (kPanel + kCaption + kMargin) + kCaption;
  panel.copyTo(sheet(cv::Rect(x, y, kPanel, kPanel)));
  write_text(sheet, caption, {x, y - 10});
}

}  // namespace

void write_gabor_report(const GreyImage& exemplar, std::span<const float> synthesis, const GaborFit& fit,
                        const std::filesystem::path& folder) {
  make_output_folder(folder);
  std::vector<std::uint8_t> photo = tones(std::span<const double>(exemplar.values));
  std::vector<std::uint8_t> noise = tones(synthesis);
  const PowerSpectrum& estimate = fit.estimate.spectrum;
  const double top = *std::max_element(estimate.power.begin(), estimate.power.end());
  RgbImage measured = spectrum_picture(estimate, top);
  RgbImage fitted = spectrum_picture(fit.fitted, top);

  cv::Mat sheet(kMargin + 2 * (kPanel + kCaption + kMargin), kMargin + 3 * (kPanel + kMargin), CV_8UC3,
                kPaper);
  place_panel(grey_panel(photo, exemplar.width, exemplar.height), 0, 0, "exemplar", sheet);
  place_panel(grey_panel(noise, exemplar.width, exemplar.height), 1, 0, "synthesis, same size", sheet);
  place_panel(gap_panel(fit.pursuit), 2, 0,
              fmt::format("certified relative duality gap: {:.1e}", fit.pursuit.relative_gap), sheet);
  place_panel(picture_panel(measured), 0, 1, "spectrum estimated from the exemplar", sheet);
  place_panel(picture_panel(fitted), 1, 1,
              fmt::format("fitted spectrum, distance {:.3f}", fit.spectrum_distance), sheet);
  cv::Mat lobes = picture_panel(measured);
  draw_lobes(fit.lobes, lobes);
  place_panel(lobes, 2, 1, fmt::format("{} lobes at half their peak", fit.lobes.size()), sheet);

  write_png8_grey(photo, exemplar.width, exemplar.height, folder / "exemplar.png");
  write_png8_grey(noise, exemplar.width, exemplar.height, folder / "synthesis.png");
  write_png8_rgb(measured, folder / "spectrum_exemplar.png");
  write_png8_rgb(fitted, folder / "spectrum_fitted.png");
  write_png8_rgb({sheet.cols, sheet.rows, {sheet.datastart, sheet.dataend}}, folder / "report.png");
}

}  // namespace astrolith
