#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <string>

#include "estimation/gabor/image/raster_file_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

// Opens a TIFF such that no field of its directory takes much more memory than the file has bytes: a file of
// a hundred bytes can declare a field of a gigabyte.
TIFF* open_tiff(const std::string& name) {
  constexpr std::uintmax_t kFixed = std::uintmax_t{1} << 20, kEachByte = 8, kMost = std::uintmax_t{1} << 30;
  const auto silent = [](TIFF*, void*, const char*, const char*, va_list) { return 1; };
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  if (options == nullptr) throw std::bad_alloc();
  const std::uintmax_t most = std::min(kMost, kFixed + kEachByte * std::filesystem::file_size(name));
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, static_cast<tmsize_t>(most));
  TIFFOpenOptionsSetErrorHandlerExtR(options, silent, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options, silent, nullptr);
  TIFF* tiff = TIFFOpenExt(name.c_str(), "r", options);
  TIFFOpenOptionsFree(options);
  return tiff;
}

// Raw files that are no TIFF, or that have a mark of their own behind a TIFF's: of Canon, Fuji, Olympus and
// Panasonic.
bool has_raw_mark(const std::array<char, 16>& start) {
  const auto at = [&](std::size_t place, const char* mark) {
    return std::memcmp(start.data() + place, mark, std::strlen(mark)) == 0;
  };
  return at(8, "CR\2") || at(4, "ftypcrx") || at(0, "FUJIFILMCCD") || at(0, "IIRO") || at(0, "IIRS") ||
         at(0, "MMOR") || at(0, "IIU");
}

// DNG has its version as a tag. What else cameras write has a thumbnail, or a mosaic of colours, first.
bool is_raw(TIFF* tiff) {
  constexpr std::uint32_t kThumbnail = FILETYPE_REDUCEDIMAGE;
  constexpr std::uint16_t kMosaic = 32803, kLinearRaw = 34892;
  std::uint32_t kind = 0;
  std::uint16_t photometric = 0;
  const std::uint8_t* version = nullptr;
  TIFFGetField(tiff, TIFFTAG_SUBFILETYPE, &kind);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  return (kind & kThumbnail) != 0 || photometric == kMosaic || photometric == kLinearRaw ||
         TIFFGetField(tiff, TIFFTAG_DNGVERSION, &version) == 1;
}

}  // namespace

TiffTags read_tiff_tags(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string raw = name + ": a camera's raw file, or a thumbnail first; develop it into a PNG or TIFF";
  std::array<char, 16> start{};
  std::ifstream(file, std::ios::binary).read(start.data(), start.size());
  if (has_raw_mark(start)) throw InputError(raw);
  const bool little =
                 start[0] == 'I' && start[1] == 'I' && (start[2] == '*' || start[2] == '+') && start[3] == 0,
             big =
                 start[0] == 'M' && start[1] == 'M' && start[2] == 0 && (start[3] == '*' || start[3] == '+');
  if (!little && !big) return {};
  const std::unique_ptr<TIFF, CloseTiff> tiff(open_tiff(name));
  if (tiff == nullptr) throw InputError(name + ": TIFF cannot be opened; the file is damaged, save it again");
  if (is_raw(tiff.get())) throw InputError(raw);
  std::uint16_t orientation = ORIENTATION_TOPLEFT, extra = 0;
  const std::uint16_t* kinds = nullptr;
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_ORIENTATION, &orientation);
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_EXTRASAMPLES, &extra, &kinds);
  return {orientation, extra > 0 && kinds[0] == EXTRASAMPLE_ASSOCALPHA};
}

}  // namespace astrolith
