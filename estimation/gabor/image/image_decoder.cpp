#include "estimation/gabor/image/image_codec_internal.h"

#include <tiffio.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "numerics/errors.h"

namespace astrolith {
namespace {

// Image libraries print about damaged files on the C library's stderr, past every logger; our own error
// reports the damage. While an object of this class lives, stderr is a stream that drops what this thread
// prints and passes on the rest, so that threads lose nothing of one another. Descriptor 2 stays as it is.
class SilentStderr {
 public:
  SilentStderr() {
    silent_ = true;
    const std::lock_guard lock(mutex_);
    if (living_++ == 0 && filter() != nullptr) before_ = std::exchange(stderr, filter());
  }
  SilentStderr(const SilentStderr&) = delete;
  SilentStderr& operator=(const SilentStderr&) = delete;
  ~SilentStderr() {
    silent_ = false;
    const std::lock_guard lock(mutex_);
    if (--living_ == 0 && filter() != nullptr) stderr = before_;
  }

 private:
  static ssize_t pass_on(void*, const char* text, std::size_t size) {
    return silent_ ? static_cast<ssize_t>(size) : ::write(STDERR_FILENO, text, size);
  }
  // Made once, and never closed: a thread may be about to print.
  static std::FILE* filter() {
    static std::FILE* const stream = [] {
      std::FILE* made = ::fopencookie(nullptr, "w", {nullptr, pass_on, nullptr, nullptr});
      if (made != nullptr) std::setvbuf(made, nullptr, _IONBF, 0);
      return made;
    }();
    return stream;
  }

  static inline thread_local bool silent_ = false;
  static inline std::mutex mutex_;
  static inline int living_ = 0;
  static inline std::FILE* before_ = nullptr;
};

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw InputError(name + ": " + what);
}

// Reads the first page of a TIFF of 16-bit floats, which OpenCV cannot read, as grey or RGB without alpha.
cv::Mat decode_half_floats(const std::string& name) {
  const std::unique_ptr<TIFF, CloseTiff> tiff(TIFFOpen(name.c_str(), "r"));
  std::uint32_t width = 0, height = 0;
  std::uint16_t samples = 1, planar = PLANARCONFIG_CONTIG, orientation = ORIENTATION_TOPLEFT;
  if (tiff == nullptr) fail(name, "cannot be opened; save it again");
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_PLANARCONFIG, &planar);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_ORIENTATION, &orientation);
  const bool plain = TIFFIsTiled(tiff.get()) == 0 && planar == PLANARCONFIG_CONTIG &&
                     orientation == ORIENTATION_TOPLEFT && samples >= 1 && samples <= 4 &&
                     TIFFScanlineSize64(tiff.get()) == std::uint64_t{width} * samples * 2;
  if (!plain) fail(name, "16-bit floats in tiles, planes or turned; save it with 32-bit floats");
  const int channels = samples >= 3 ? 3 : 1;
  cv::Mat mat(static_cast<int>(height), static_cast<int>(width), CV_MAKETYPE(CV_32F, channels));
  cv::Mat stored(1, static_cast<int>(width), CV_MAKETYPE(CV_16F, samples)), row;
  for (std::uint32_t y = 0; y < height; ++y) {
    if (TIFFReadScanline(tiff.get(), stored.data, y) != 1) fail(name, "ends too early; save it again");
    stored.convertTo(row, CV_32F);
    const int red_last[] = {0, channels - 1, 1, 1, channels - 1, 0};  // from, to
    const cv::Mat target = mat.row(static_cast<int>(y));
    cv::mixChannels(&row, 1, const_cast<cv::Mat*>(&target), 1, red_last, static_cast<std::size_t>(channels));
  }
  return mat;
}

cv::Mat read_with_opencv(const std::string& name, int flags) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);  // OpenCV's own words
  const SilentStderr silent;
  try {
    return cv::imread(name, flags);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

cv::Mat decode_image(const std::filesystem::path& file, const ImageHeader& header) {
  if (header.half_floats) return decode_half_floats(file.string());
  // These flags, unlike IMREAD_UNCHANGED, turn the image upright.
  const cv::Mat mat = read_with_opencv(file.string(), cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH);
  if (mat.empty()) {
    fail(file.string(), "the image cannot be decoded; it is damaged or of a rare kind, save it again as PNG");
  }
  return mat;
}

double share_not_opaque(const std::filesystem::path& file, const ImageHeader& header) {
  if (!header.has_alpha || header.half_floats) return 0.0;
  const cv::Mat mat = read_with_opencv(file.string(), cv::IMREAD_UNCHANGED);
  if (mat.channels() != 4 || (mat.depth() != CV_8U && mat.depth() != CV_16U)) return 0.0;
  cv::Mat alpha;
  cv::extractChannel(mat, alpha, 3);
  const double opaque = mat.depth() == CV_8U ? 255.0 : 65535.0;
  const cv::Mat clear = alpha < opaque;
  return static_cast<double>(cv::countNonZero(clear)) / static_cast<double>(clear.total());
}

}  // namespace astrolith
