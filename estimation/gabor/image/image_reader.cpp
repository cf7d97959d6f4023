#include "estimation/gabor/image/image_reader.h"

#include <fmt/format.h>

#include <cmath>

#include "estimation/gabor/image/image_codec_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

ImageHeader read_fitting_header(const std::filesystem::path& file) {
  ImageHeader header = read_image_header(file);
  const double pixels = static_cast<double>(header.width) * header.height;
  if (pixels > kLargestImagePixels) {
    throw InputError(fmt::format(
        "{}: {} x {} pixels would take {:.0f} GB; cut out or scale down to at most "
        "{:.0f} million pixels, such as 8192 x 8192",
        file.string(), header.width, header.height, 18.0 * pixels / 1e9, kLargestImagePixels / 1e6));
  }
  return header;
}

// The stored number that becomes 1.
double full_scale(const cv::Mat& mat, const std::string& name) {
  switch (mat.depth()) {
    case CV_8U:
      return 255.0;
    case CV_16U:
      return 65535.0;
    case CV_32F:
    case CV_64F:
      return 1.0;
    default:
      throw InputError(name +
                       ": its pixels are signed integers; save it with 8 or 16 bits unsigned, or as floats");
  }
}

// Float images may hold any number. A larger value is a "no data" mark, or its unit is too small.
constexpr double kLargestValue = 1e5;

void require_usable(double value, int x, int y, const std::string& name) {
  if (std::abs(value) <= kLargestValue) return;  // false for NaN
  throw InputError(
      fmt::format("{}: pixel ({}, {}): the value {} is not finite or beyond {:g}; fill such "
                  "pixels (no data?) or rescale the image",
                  name, x, y, value, kLargestValue));
}

// Calls take(pixel) with the scaled channels of every pixel, row by row.
template <typename Take>
void for_each_pixel(const cv::Mat& mat, const std::string& name, const Take& take) {
  const double scale = 1.0 / full_scale(mat, name);
  const int channels = mat.channels();
  cv::Mat row;
  for (int y = 0; y < mat.rows; ++y) {
    mat.row(y).convertTo(row, CV_64F, scale);
    const double* p = row.ptr<double>(0);
    for (int x = 0; x < mat.cols; ++x, p += channels) {
      for (int c = 0; c < channels; ++c) require_usable(p[c], x, y, name);
      take(p);
    }
  }
}

GreyImage empty_plane(const cv::Mat& mat) {
  GreyImage plane{mat.cols, mat.rows, {}};
  plane.values.reserve(mat.total());
  return plane;
}

std::vector<std::string> remarks_on(const ImageHeader& header, double not_opaque) {
  std::vector<std::string> remarks;
  if (not_opaque > 0.0) {
    remarks.push_back(fmt::format(
        "alpha ignored: {:.1f} % of the pixels are not opaque, and count with the colour stored under it",
        100.0 * not_opaque));
  }
  if (header.more_pages) {
    remarks.push_back(header.format == "PNG" ? "animated: only the first frame used"
                                             : "only the first of several pages used");
  }
  return remarks;
}

}  // namespace

ImageSize read_image_size(const std::filesystem::path& file) {
  const ImageHeader header = read_fitting_header(file);
  return {static_cast<int>(header.width), static_cast<int>(header.height)};
}

ImageFile read_grey_image(const std::filesystem::path& file) {
  const ImageHeader header = read_fitting_header(file);
  ImageFile result{{}, remarks_on(header, share_not_opaque(file, header))};
  const cv::Mat mat = decode_image(file, header);
  result.image = empty_plane(mat);
  const bool colors = mat.channels() == 3;
  for_each_pixel(mat, file.string(), [&](const double* p) {
    // OpenCV orders channels blue, green, red.
    result.image.values.push_back(colors ? 0.0722 * p[0] + 0.7152 * p[1] + 0.2126 * p[2] : p[0]);
  });
  return result;
}

ColorImageFile read_color_image(const std::filesystem::path& file) {
  const ImageHeader header = read_fitting_header(file);
  ColorImageFile result{{}, remarks_on(header, share_not_opaque(file, header))};
  const cv::Mat mat = decode_image(file, header);
  result.planes.assign(3, empty_plane(mat));
  const int last = mat.channels() - 1;
  for_each_pixel(mat, file.string(), [&](const double* p) {
    for (int c = 0; c < 3; ++c) {
      result.planes[static_cast<std::size_t>(c)].values.push_back(p[last == 2 ? 2 - c : 0]);
    }
  });
  return result;
}

ColorImageFile read_image(const std::filesystem::path& file, bool colors) {
  if (colors) return read_color_image(file);
  ImageFile grey = read_grey_image(file);
  return {{std::move(grey.image)}, std::move(grey.remarks)};
}

}  // namespace astrolith
