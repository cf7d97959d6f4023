// RasterFile without GDAL: PNG alone, with the values that GDAL gives. Wheels have it, since GDAL brings a
// hundred libraries. Other pictures come as arrays (astrolith.fit_texture).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "estimation/gabor/image/raster_file_internal.h"
#include "numerics/errors.h"
#include "numerics/files/input_file.h"
#include "synthesis/picture/image_file.h"

class GDALDataset {};  // no file is open through it

namespace astrolith {

namespace {

// Four bytes, the highest first; beyond 2^31 - 1, which PNG refuses, that number.
int number_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t k = 0; k < 4; ++k) number = number << 8 | bytes[at + k];
  return static_cast<int>(std::min<std::uint32_t>(number, 0x7fffffff));
}

}  // namespace

struct RasterFile::Bands {
  GreyPng image;
  double full_scale = 255.0;
  double factor = 1.0;  // of a stored number
  bool alpha = false;

  int channels() const { return image.rgb.empty() ? 1 : 3; }
};

RasterFile::~RasterFile() = default;

void RasterFile::fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

RasterFile::RasterFile(const std::filesystem::path& file, const ImageWords& words)
    : name_(file.string()), bands_(std::make_unique<Bands>()) {
  require_plain_file(file);
  std::ifstream stream(file, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
  constexpr std::size_t kWidth = 16, kHeight = 20, kBitDepth = 24, kColorType = 25;  // places of the header
  constexpr int kMostSide = 1 << 20;
  constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G'};
  if (bytes.size() <= kColorType ||
      !std::equal(std::begin(kSignature), std::end(kSignature), bytes.begin())) {
    fail(
        "this build reads PNG alone, since GDAL is left out; save it as PNG, or give its pixels to "
        "astrolith.fit_texture as an array");
  }
  Bands& b = *bands_;
  b.image.width = number_at(bytes, kWidth);
  b.image.height = number_at(bytes, kHeight);
  // Whoever asks for the size refuses a larger image.
  if (1.0 * width() * height() <= kLargestImagePixels) b.image = decode_grey_png(bytes, name_, 1, kMostSide);
  constexpr int kPalette = 3;
  const int bits = bytes[kColorType] == kPalette ? 8 : bytes[kBitDepth];
  b.full_scale = std::ldexp(1.0, bits) - 1.0;
  b.factor = 1.0 / b.full_scale;
  b.alpha = (bytes[kColorType] & 4) != 0;
  if (words.height_unit.empty()) return;
  if (b.channels() != 1) fail("has colours, and no heights; leave --height-unit out");
  StatedScale scale;
  scale.heights = true;
  b.factor = unit_metres(words.height_unit);
  scale_ = scale;
}

int RasterFile::width() const { return bands_->image.width; }
int RasterFile::height() const { return bands_->image.height; }

std::vector<std::string> RasterFile::remarks() const {
  if (!bands_->alpha) return {};
  return {"alpha ignored: transparent pixels count with the colour stored under them"};
}

bool RasterFile::names_gaps() const { return false; }
double RasterFile::to_value(double stored) const { return bands_->factor * stored; }
double RasterFile::to_stored(double value) const { return value / bands_->factor; }

void RasterFile::read(const TakeRow& take, const Progress& progress) {
  const Bands& b = *bands_;
  const std::vector<std::uint16_t>& numbers = b.channels() == 3 ? b.image.rgb : b.image.values;
  const auto count = static_cast<std::size_t>(width()) * static_cast<std::size_t>(b.channels());
  const double spread = 65535.0 / b.full_scale;  // decoded numbers of fewer bits fill 16
  std::vector<double> row(count);
  for (int y = 0; y < height(); ++y) {
    if (!report(progress, static_cast<double>(y) / height(), "read"))
      throw WorkError(name_ + ": stopped; nothing is written");
    const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(count) * y;
    std::transform(begin, begin + static_cast<std::ptrdiff_t>(count), row.begin(),
                   [&](std::uint16_t v) { return to_value(v / spread); });
    take(row, b.channels());
  }
}

}  // namespace astrolith
