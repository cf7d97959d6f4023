#include "estimation/gabor/image_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "estimation/gabor/image_header_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

// Image libraries print about damaged files on their own, past every logger; while this lives, what is
// printed on stderr goes nowhere. Our error says it once.
class SilentStderr {
 public:
  SilentStderr() : kept_(::dup(STDERR_FILENO)) {
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (kept_ >= 0 && nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
    if (nowhere >= 0) ::close(nowhere);
  }
  SilentStderr(const SilentStderr&) = delete;
  SilentStderr& operator=(const SilentStderr&) = delete;
  ~SilentStderr() {
    if (kept_ < 0) return;
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
  }

 private:
  int kept_;
};

cv::Mat decode(const std::string& name) {
  const SilentStderr silent;
  cv::Mat mat;
  try {
    mat = cv::imread(name, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    mat.release();
  }
  if (mat.empty()) {
    throw InputError(name +
                     ": the image cannot be decoded; it is damaged or of a rare kind, save it again as PNG");
  }
  return mat;
}

// What turns a stored number into [0, 1].
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

// Float images hold anything; beyond this a value is a "no data" mark or in a unit too small.
constexpr double kLargestValue = 1e5;

GreyImage to_grey(const cv::Mat& mat, const std::string& name) {
  const double scale = 1.0 / full_scale(mat, name);
  const int channels = mat.channels();
  GreyImage image{mat.cols, mat.rows, {}};
  image.values.reserve(mat.total());
  cv::Mat row;
  for (int y = 0; y < mat.rows; ++y) {
    mat.row(y).convertTo(row, CV_64F, scale);
    const double* p = row.ptr<double>(0);
    for (int x = 0; x < mat.cols; ++x, p += channels) {
      // OpenCV orders channels blue, green, red, alpha.
      const double value = channels >= 3 ? 0.0722 * p[0] + 0.7152 * p[1] + 0.2126 * p[2] : p[0];
      if (!(std::abs(value) <= kLargestValue)) {
        throw InputError(
            fmt::format("{}: pixel ({}, {}): the value {} is not finite or beyond {:g}; fill such "
                        "pixels (no data?) or rescale the image",
                        name, x, y, value, kLargestValue));
      }
      image.values.push_back(value);
    }
  }
  return image;
}

}  // namespace

ImageFile read_grey_image(const std::filesystem::path& file) {
  const std::string name = file.string();
  const ImageHeader header = read_image_header(file);
  const double pixels = static_cast<double>(header.width) * header.height;
  if (pixels > kLargestImagePixels) {
    throw InputError(
        fmt::format("{}: {} x {} pixels would take {:.0f} GB; cut out or scale down to at most "
                    "8192 x 8192",
                    name, header.width, header.height, 16.0 * pixels / 1e9));
  }
  const cv::Mat mat = decode(name);
  ImageFile result{to_grey(mat, name), {}};
  if (mat.channels() == 3 || mat.channels() == 4) {
    result.remarks.push_back("colours turned into luma");
  }
  if (mat.channels() == 2 || mat.channels() == 4) result.remarks.push_back("alpha channel ignored");
  if (header.more_pages) result.remarks.push_back("only the first of several pages used");
  return result;
}

}  // namespace astrolith
