#include "estimation/gabor/image/photo_codec_internal.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
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

void read_photo(const std::filesystem::path& file, const TakeRow& take) {
  // These flags, unlike IMREAD_UNCHANGED, turn the image upright.
  const cv::Mat mat = read_with_opencv(file.string(), cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH);
  if (mat.empty() || (mat.depth() != CV_8U && mat.depth() != CV_16U)) {
    throw InputError(file.string() +
                     ": the photo cannot be decoded; it is damaged or of a rare kind, save it again as PNG");
  }
  cv::Mat stored, row;
  for (int y = 0; y < mat.rows; ++y) {
    stored = mat.row(y);
    if (mat.channels() == 3) cv::cvtColor(mat.row(y), stored, cv::COLOR_BGR2RGB);
    stored.convertTo(row, CV_64F, 1.0 / (mat.depth() == CV_8U ? 255.0 : 65535.0));
    const auto* values = row.ptr<double>(0);
    take({values, static_cast<std::size_t>(row.cols * row.channels())}, row.channels());
  }
}

double share_not_opaque(const std::filesystem::path& file, const PhotoHeader& header) {
  if (!header.has_alpha) return 0.0;
  const cv::Mat mat = read_with_opencv(file.string(), cv::IMREAD_UNCHANGED);
  if (mat.empty() || mat.channels() != 4 || (mat.depth() != CV_8U && mat.depth() != CV_16U)) return 0.0;
  cv::Mat alpha;
  cv::extractChannel(mat, alpha, 3);
  const double opaque = mat.depth() == CV_8U ? 255.0 : 65535.0;
  const cv::Mat clear = alpha < opaque;
  return static_cast<double>(cv::countNonZero(clear)) / static_cast<double>(clear.total());
}

}  // namespace astrolith
