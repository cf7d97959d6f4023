#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_minixml.h>
#include <fmt/format.h>
#include <gdal_frmts.h>
#include <gdal_pam.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

#include "estimation/gabor/image/image_reader.h"
#include "estimation/gabor/image/raster_file_internal.h"
#include "numerics/errors.h"
#include "numerics/files/input_file.h"

namespace astrolith {
namespace {

// A library of GDAL that was built without a format lacks its function: the format is left out then.
#pragma weak GDALRegister_GTiff
#pragma weak GDALRegister_PNG
#pragma weak GDALRegister_JPEG
#pragma weak GDALRegister_WEBP
#pragma weak GDALRegister_JP2OpenJPEG
#pragma weak GDALRegister_FITS
#pragma weak GDALRegister_HFA
#pragma weak GDALRegister_netCDF
#pragma weak GDALRegister_DTED
#pragma weak GDALRegister_GSAG
#pragma weak GDALRegister_GSBG
#pragma weak GDALRegister_GS7BG
#pragma weak GDALRegister_VRT
#pragma weak GDALRegister_EXR
#pragma weak GDALRegister_ISIS3
#pragma weak GDALRegister_ISIS2
#pragma weak GDALRegister_PDS
#pragma weak GDALRegister_PDS4
#pragma weak GDALRegister_VICAR
#pragma weak GDALRegister_AAIGrid
#pragma weak GDALRegister_SRTMHGT
#pragma weak GDALRegister_ENVI
#pragma weak GDALRegister_EHdr

// The formats that are read. None runs what a file says. Labels name the files of their pixels. Formats that
// are known by their own first bytes stand before those that a file beside the pixels describes.
struct Format {
  const char* name;
  void (*register_driver)();
};
constexpr Format kFormats[] = {{"GTiff", GDALRegister_GTiff},
                               {"PNG", GDALRegister_PNG},
                               {"JPEG", GDALRegister_JPEG},
                               {"WEBP", GDALRegister_WEBP},
                               {"JP2OpenJPEG", GDALRegister_JP2OpenJPEG},
                               {"FITS", GDALRegister_FITS},
                               {"HFA", GDALRegister_HFA},
                               {"netCDF", GDALRegister_netCDF},
                               {"DTED", GDALRegister_DTED},
                               {"GSAG", GDALRegister_GSAG},
                               {"GSBG", GDALRegister_GSBG},
                               {"GS7BG", GDALRegister_GS7BG},
                               {"VRT", GDALRegister_VRT},
                               {"EXR", GDALRegister_EXR},
                               {"ISIS3", GDALRegister_ISIS3},
                               {"ISIS2", GDALRegister_ISIS2},
                               {"PDS", GDALRegister_PDS},
                               {"PDS4", GDALRegister_PDS4},
                               {"VICAR", GDALRegister_VICAR},
                               {"AAIGrid", GDALRegister_AAIGrid},
                               {"SRTMHGT", GDALRegister_SRTMHGT},
                               {"ENVI", GDALRegister_ENVI},
                               {"EHdr", GDALRegister_EHdr}};

// While an object of this class lives, this thread's GDAL prints nothing, starts no thread that would, writes
// nothing beside its input and asks no network.
class QuietGdal {
 public:
  QuietGdal() {
    static std::once_flag registered;
    std::call_once(registered, [] {
      for (const Format& format : kFormats) {
        if (format.register_driver != nullptr) format.register_driver();
      }
    });
    CPLPushErrorHandler(CPLQuietErrorHandler);
  }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
  ~QuietGdal() { CPLPopErrorHandler(); }

 private:
  CPLConfigOptionSetter notes_{"GDAL_PAM_ENABLED", "YES",
                               false};  // .aux.xml, of which open_raster() writes none
  CPLConfigOptionSetter grid_type_{"AAIGRID_DATATYPE", "Float64",
                                   false};  // "NaN" among whole numbers is none
  CPLConfigOptionSetter no_python_{"GDAL_VRT_ENABLE_PYTHON", "NO", false};
  CPLConfigOptionSetter raw_{"GDAL_VRT_RAWRASTERBAND_ALLOWED_SOURCE", "SIBLING_OR_CHILD_OF_VRT_PATH", false};
  CPLConfigOptionSetter no_folder_{"GDAL_DISABLE_READDIR_ON_OPEN", "TRUE", false};
  CPLConfigOptionSetter small_cache_{"GDAL_CACHEMAX", "128", false};  // MB; counts at its first use only
  CPLConfigOptionSetter no_network_{"CPL_VSIL_CURL_ALLOWED_FILENAME", "none", false};
  CPLConfigOptionSetter no_stream_{"CPL_VSIL_CURL_ALLOWED_EXTENSIONS", "", false};
  // A decoder fills what is missing of a cut JPEG with grey, and only warns.
  CPLConfigOptionSetter whole_jpeg_{"GDAL_ERROR_ON_LIBJPEG_WARNING", "YES", false};
  CPLConfigOptionSetter one_thread_{"GDAL_NUM_THREADS", "1", false};
};

std::unique_ptr<GDALDataset> open_raster(const std::string& name) {
  std::vector<const char*> drivers;
  for (const Format& format : kFormats) drivers.push_back(format.name);
  drivers.push_back(nullptr);
  std::unique_ptr<GDALDataset> raster(
      GDALDataset::Open(name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers.data(), nullptr, nullptr));
  // What stands in .aux.xml is read, and nothing is written there.
  if (auto* const noted = dynamic_cast<GDALPamDataset*>(raster.get()))
    noted->SetPamFlags(noted->GetPamFlags() | GPF_NOSAVE);
  return raster;
}

// An Arc ASCII grid whose first row begins with "nan", which GDAL 3.6 takes for a line of the header: the
// raster is that of a copy in memory, with a blank in front of the row. Null for other files.
std::unique_ptr<GDALDataset> open_grid_of_nan(const std::string& name) {
  std::ifstream in(name, std::ios::binary);
  std::string line(5, '\0');
  const auto starts_with = [&](const char* word) { return STARTS_WITH_CI(line.c_str(), word); };
  in.read(line.data(), static_cast<std::streamsize>(line.size()));
  if (!in || (!starts_with("ncols") && !starts_with("nrows"))) return nullptr;
  std::getline(in, line);
  std::streamoff at = in.tellg();
  while (std::getline(in, line) && !starts_with("nan") && line.size() < 200 &&
         std::isalpha(static_cast<unsigned char>(line[0])) != 0)
    at = in.tellg();
  if (!starts_with("nan")) return nullptr;
  const auto put = [](const std::string& file, const std::filesystem::path& from, std::streamoff blank) {
    std::ifstream source(from, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(source)), {});
    if (blank > 0) text.insert(static_cast<std::size_t>(blank), 1, ' ');
    VSILFILE* const made = VSIFOpenL(file.c_str(), "wb");
    VSIFWriteL(text.data(), 1, text.size(), made);
    VSIFCloseL(made);
  };
  static std::atomic<int> number{0};
  const std::string copy = fmt::format("/vsimem/astrolith_{}/grid", number++);
  put(copy + ".asc", name, at);
  const std::filesystem::path frame = std::filesystem::path(name).replace_extension(".prj");
  if (std::filesystem::is_regular_file(frame)) put(copy + ".prj", frame, 0);
  std::unique_ptr<GDALDataset> raster = open_raster(copy + ".asc");
  // An open file stays until it is closed.
  VSIUnlink((copy + ".asc").c_str());
  VSIUnlink((copy + ".prj").c_str());
  return raster;
}

// Rows of raw numbers as a raster. Their type is that of the name's ending, or of the size of the file:
// floats of 32 bits, or whole numbers of 8 or 16 bits, the lowest byte first.
std::unique_ptr<GDALDataset> open_raw(const std::string& name, const ImageSize& size) {
  const auto bytes = static_cast<double>(std::filesystem::file_size(name));
  const double pixels = static_cast<double>(size.width) * size.height;
  const bool floats = std::filesystem::path(name).extension() == ".r32" || bytes == 4.0 * pixels;
  const int each = floats ? 4 : bytes == pixels ? 1 : 2;
  if (bytes != each * pixels) {
    throw InputError(
        fmt::format("{}: has {} bytes, and {} x {} pixels would take {}; give another --raw-size", name,
                    bytes, size.width, size.height, each * pixels));
  }
  const CPLString escaped = CPLString(name).replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  const std::string description = fmt::format(
      "<VRTDataset rasterXSize=\"{0}\" rasterYSize=\"{1}\"><VRTRasterBand dataType=\"{2}\" band=\"1\" "
      "subClass=\"VRTRawRasterBand\"><SourceFilename>{3}</SourceFilename><PixelOffset>{4}</PixelOffset>"
      "<LineOffset>{5}</LineOffset><ByteOrder>LSB</ByteOrder></VRTRasterBand></VRTDataset>",
      size.width, size.height,
      floats      ? "Float32"
      : each == 1 ? "Byte"
                  : "UInt16",
      escaped, each, static_cast<std::int64_t>(each) * size.width);
  const CPLConfigOptionSetter any_place("GDAL_VRT_RAWRASTERBAND_ALLOWED_SOURCE", "ALL", false);
  const char* const drivers[] = {"VRT", nullptr};
  return std::unique_ptr<GDALDataset>(
      GDALDataset::Open(description.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, nullptr, nullptr));
}

std::string structure(GDALMajorObject& object, const char* key) {
  const char* value = object.GetMetadataItem(key, "IMAGE_STRUCTURE");
  return value == nullptr ? "" : value;
}

std::string driver_name(GDALDataset& dataset) { return dataset.GetDriverName(); }

// Whether a PNG or a WebP says that it is animated: PNG by a chunk before its pixels, WebP in its first.
bool is_animated(const std::string& name) {
  std::string start(1 << 16, '\0');
  std::ifstream in(name, std::ios::binary);
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  const bool webp = start.compare(8, 8, "WEBPVP8X") == 0;
  return webp ? (start[20] & 2) != 0
              : start.compare(1, 3, "PNG") == 0 && start.find("acTL") < start.find("IDAT");
}

// A label names the file of its pixels, and might name any other.
void require_own_folder(GDALDataset& dataset, const std::string& name) {
  const CPLStringList files(dataset.GetFileList());
  const std::filesystem::path own = std::filesystem::path(name).lexically_normal();
  for (int k = 0; k < files.Count(); ++k) {
    const std::filesystem::path file = std::filesystem::path(files[k]).lexically_normal();
    if (file == own || (file.parent_path() == own.parent_path() && std::filesystem::is_regular_file(file)))
      continue;
    throw InputError(name + ": names a file that is no plain file of its own folder; put both into one");
  }
}

// Whether a list of sources may name this file: it lies beside the list, and is no list itself.
bool is_plain_source(const CPLXMLNode& element, const std::string& source, const std::string& name) {
  if (!EQUAL(CPLGetXMLValue(&element, "relativeToVRT", "0"), "1") ||
      source.find_first_of("/\\:&") != source.npos)
    return false;
  const std::filesystem::path file = std::filesystem::path(name).parent_path() / source;
  if (!std::filesystem::is_regular_file(file)) return false;
  std::ifstream in(file, std::ios::binary);
  char first = ' ';
  while (std::isspace(static_cast<unsigned char>(first)) != 0 && in.get(first)) {
  }
  return first != '<';
}

// GDAL opens the files that a list of sources names, in elements whose names it reads in any case.
void require_plain_sources(const std::string& name) {
  std::ifstream in(name, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const CPLXMLTreeCloser tree(CPLParseXMLString(text.c_str()));
  std::vector<const CPLXMLNode*> waiting{tree.get()};
  while (!waiting.empty()) {
    const CPLXMLNode* const node = waiting.back();
    waiting.pop_back();
    if (node == nullptr) continue;
    waiting.push_back(node->psNext);
    waiting.push_back(node->psChild);
    const auto is = [&](const char* element) { return EQUAL(node->pszValue, element); };
    if (node->eType != CXT_Element ||
        (!is("SourceFilename") && !is("SourceDataset") && !is("DatasetName") && !is("Filename")))
      continue;
    const std::string source = CPLGetXMLValue(node, nullptr, "");
    if (!is_plain_source(*node, source, name)) {
      throw InputError(
          name + ": names " + source.substr(0, 80) +
          ", which is no picture of its own folder; put both into one, with relativeToVRT=\"1\"");
    }
  }
}

// A header that stands beside raw numbers states as many as there are, or it is another file's.
void require_own_header(GDALDataset& raster, const std::string& name) {
  GDALRasterBand& band = *raster.GetRasterBand(1);
  const std::string bits = structure(band, "NBITS");
  const double row =
      std::ceil((bits.empty() ? GDALGetDataTypeSizeBits(band.GetRasterDataType()) : std::atoi(bits.c_str())) *
                static_cast<double>(raster.GetRasterXSize()) / 8.0);
  const char* const offset = raster.GetMetadataItem("header_offset", "ENVI");
  const char* const packed = raster.GetMetadataItem("file_compression", "ENVI");
  const double stated =
      (offset == nullptr ? 0.0 : CPLAtof(offset)) + row * raster.GetRasterYSize() * raster.GetRasterCount();
  const auto bytes = static_cast<double>(std::filesystem::file_size(name));
  constexpr double kMargin = 1.02;  // words in front of the pixels, or behind them
  if ((packed != nullptr && std::string(packed) != "0") || (bytes >= stated && bytes <= kMargin * stated))
    return;
  throw InputError(
      fmt::format("{}: is no picture or height map by its first bytes, and the header beside it states "
                  "{:.0f} bytes of {:.0f}; "
                  "give the file that the header is of",
                  name, stated, bytes));
}

// The file of the same name and another ending that holds a raster: the label of pixels, or the pixels of a
// header. Empty where none is.
std::string raster_beside(const std::filesystem::path& file) {
  std::vector<std::string> others;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(file.parent_path() / ".", error)) {
    if (entry.path().stem() == file.stem() && entry.path().filename() != file.filename() &&
        entry.is_regular_file(error))
      others.push_back((file.parent_path() / entry.path().filename()).string());
  }
  std::sort(others.begin(), others.end());
  const auto found = std::find_if(others.begin(), others.end(),
                                  [](const std::string& other) { return open_raster(other) != nullptr; });
  return found == others.end() ? "" : *found;
}

// Whether the file begins as the labels of PDS3, PDS4 and ISIS do.
bool is_label(const std::filesystem::path& file) {
  std::string start(16, '\0');
  std::ifstream(file, std::ios::binary).read(start.data(), 16);
  return start.rfind("PDS_VERSION_ID", 0) == 0 || start.rfind("CCSD3ZF", 0) == 0 ||
         start.rfind("<?xml", 0) == 0 || start.rfind("Object = IsisCub", 0) == 0;
}

}  // namespace

// The bands of values, one or three, and how stored numbers become values.
struct RasterFile::Bands {
  std::vector<GDALRasterBand*> values;
  GDALRasterBand* alpha = nullptr;
  bool premultiplied = false;  // colours are stored multiplied by alpha
  const GDALColorTable* palette = nullptr;
  bool white_is_zero = false;
  bool signed_bytes = false;
  // Numbers of no pixel lie outside: ISIS and others have marks for no data, and for what a camera missed.
  double least = -1e30, most = 1e30;
  double factor = 1.0, offset = 0.0;  // of the numbers that GDAL gives
  std::optional<double> blank;        // what GDAL gives for no data and masks not
  bool masked = true;                 // GDAL's mask counts
  double opaque = 1.0;                // the alpha of an opaque pixel
  std::string unit;                   // of the values, as the file spells it; empty: none
  bool as_stated = false;             // the values are the file's own, and not shares of a full scale
  bool fourth_unused = false;
  bool see_through = false;  // GDAL's mask and palette say where a picture is transparent
  std::size_t not_opaque = 0;

  int channels() const { return palette != nullptr ? 3 : static_cast<int>(values.size()); }
};

namespace {

bool is_signed_or_float(GDALRasterBand& band) {
  const GDALDataType type = band.GetRasterDataType();
  return GDALDataTypeIsFloating(type) != 0 || GDALDataTypeIsSigned(type) != 0;
}

double full_scale(GDALRasterBand& band) {
  const std::string bits = structure(band, "NBITS");
  const int stored =
      bits.empty() ? GDALGetDataTypeSizeBits(band.GetRasterDataType()) : std::atoi(bits.c_str());
  return std::ldexp(1.0, std::clamp(stored, 1, 64)) - 1.0;
}

double block_pixels(GDALRasterBand& band) {
  int width = 0, height = 0;
  band.GetBlockSize(&width, &height);
  return static_cast<double>(width) * height;
}

// The bytes of so many pixels of this band and all others.
double band_bytes(GDALRasterBand& band, double pixels) {
  return pixels * band.GetDataset()->GetRasterCount() * GDALGetDataTypeSizeBytes(band.GetRasterDataType());
}

// Rows are read one by one, and each block is decoded once only where a row of blocks has room in the cache.
void hold_block_row(GDALRasterBand& band) {
  int width = 0, height = 0;
  band.GetBlockSize(&width, &height);
  const double across = std::ceil(static_cast<double>(band.GetXSize()) / width);
  constexpr double kMasks = 2.0;
  const auto bytes = static_cast<GIntBig>(kMasks * band_bytes(band, across * block_pixels(band)));
  if (GDALGetCacheMax64() < bytes) GDALSetCacheMax64(bytes);
}

bool read_row(GDALRasterBand& band, int y, GDALDataType type, void* row) {
  const int width = band.GetXSize();
  return band.RasterIO(GF_Read, 0, y, width, 1, row, width, 1, type, 0, 0, nullptr) == CE_None;
}

}  // namespace

void RasterFile::fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

RasterFile::~RasterFile() {
  const QuietGdal quiet;
  dataset_.reset();
}

int RasterFile::width() const { return dataset_->GetRasterXSize(); }
int RasterFile::height() const { return dataset_->GetRasterYSize(); }

RasterFile::RasterFile(const std::filesystem::path& file, const ImageWords& words)
    : name_(file.string()), bands_(std::make_unique<Bands>()) {
  require_plain_file(file);
  const TiffTags tags = read_tiff_tags(file);
  orientation_ = tags.orientation;
  bands_->premultiplied = tags.premultiplied;
  const QuietGdal quiet;
  if (words.raw_size)
    dataset_ = open_raw(name_, *words.raw_size);
  else if (dataset_ = open_grid_of_nan(name_); dataset_ == nullptr)
    dataset_ = open_raster(name_);
  if (dataset_ == nullptr) {
    const std::string ending = file.extension().string();
    if (ending == ".r16" || ending == ".r32" || ending == ".raw")
      fail("holds numbers alone; state its columns and rows, such as --raw-size 1025x1025");
    const std::string other = raster_beside(file);
    if (!other.empty()) fail("its first bytes are not those of a picture or height map; give " + other);
    if (is_label(name_))
      fail(
          "is a label whose pixels are missing, damaged or of a kind that is not read; put the file that it "
          "names beside it");
    fail(
        "its first bytes are not those of a picture or height map that can be read, or it is damaged; save "
        "it as PNG or JPEG, a height map as a GeoTIFF of 32-bit floats");
  }
  const std::string driver = driver_name(*dataset_);
  const bool in_memory = std::string(dataset_->GetDescription()).rfind("/vsimem/", 0) == 0;
  if (!words.raw_size && !in_memory) require_own_folder(*dataset_, name_);
  if (driver == "VRT" && !words.raw_size) require_plain_sources(name_);
  if (driver == "ENVI" || driver == "EHdr") require_own_header(*dataset_, name_);
  if (const char* turned = dataset_->GetMetadataItem("EXIF_Orientation"))
    orientation_ = std::clamp(std::atoi(turned), 1, 8);
  animated_ = is_animated(name_);
  if (animated_ && driver == "WEBP") fail("an animated WebP; save one frame of it as PNG");
  find_bands();
  find_scale(words.height_unit);
}

void RasterFile::find_bands() {
  Bands& b = *bands_;
  int count = dataset_->GetRasterCount();
  if (count == 0) fail("holds several rasters and none by itself; take one out (gdal_translate)");
  GDALRasterBand* const last = dataset_->GetRasterBand(count);
  if (count > 1 && last->GetColorInterpretation() == GCI_AlphaBand) {
    b.alpha = last;
    b.opaque = GDALDataTypeIsFloating(last->GetRasterDataType()) != 0 ? 1.0 : full_scale(*last);
    --count;
  }
  GDALRasterBand& first = *dataset_->GetRasterBand(1);
  const bool colors = first.GetColorInterpretation() == GCI_RedBand;
  b.fourth_unused = count == 4 && colors;
  if (count != 1 && !b.fourth_unused && (count != 3 || (!colors && is_signed_or_float(first)))) {
    fail(fmt::format("has {} bands, which are no red, green and blue; cut out one (gdal_translate -b 1)",
                     count));
  }
  for (int k = 1; k <= std::min(count, 3); ++k) b.values.push_back(dataset_->GetRasterBand(k));
  for (GDALRasterBand* band : b.values) {
    constexpr double kSmallBlock = 1 << 22;
    const double image = band_bytes(*band, 1.0 * width() * height());
    if (GDALDataTypeIsComplex(band->GetRasterDataType()) != 0)
      fail("its pixels are complex numbers; save their magnitude as a GeoTIFF of 32-bit floats");
    if (band_bytes(*band, block_pixels(*band)) > std::max(4.0 * image, kSmallBlock))
      fail("its tiles are much larger than the image; save it again with smaller ones");
  }
  b.white_is_zero = structure(*dataset_, "MINISWHITE") == "YES";
  const bool indices = count == 1 && GDALGetDataTypeSizeBits(first.GetRasterDataType()) <= 16;
  b.palette = indices && !b.white_is_zero ? first.GetColorTable() : nullptr;
  b.signed_bytes = structure(first, "PIXELTYPE") == "SIGNEDBYTE";
  const std::string driver = driver_name(*dataset_);
  b.see_through = driver == "PNG";
  if (driver == "PDS" || driver == "ISIS2") require_known_floats();
  if (driver == "ISIS2" || driver == "ISIS3") {
    if (first.GetRasterDataType() == GDT_Int16) b.least = -32752.0;
    if (first.GetRasterDataType() == GDT_UInt16) std::tie(b.least, b.most) = std::pair(3.0, 65522.0);
  }
  b.unit = first.GetUnitType();
  b.factor = first.GetScale();
  b.offset = first.GetOffset();
  if (driver == "PDS") read_label(first);
  if (driver == "FITS") read_fits(first);
  b.as_stated =
      is_signed_or_float(first) || b.signed_bytes || b.factor != 1.0 || b.offset != 0.0 || !b.unit.empty();
  if (!b.as_stated) b.factor = 1.0 / full_scale(first);
}

// GDAL takes the floats of a VAX for others, which have their exponents elsewhere.
void RasterFile::require_known_floats() const {
  for (const char* keyword : {"SAMPLE_TYPE", "CORE_ITEM_TYPE"}) {
    const std::string type = value_in_label(name_, keyword);
    if (type.rfind("VAX", 0) == 0 && type.find("REAL") != type.npos)
      fail("its pixels are floats of a VAX (" + type + "); save it as a GeoTIFF of 32-bit floats, by ISIS");
  }
}

void RasterFile::read_label(GDALRasterBand& first) {
  if (bands_->unit.empty()) bands_->unit = value_in_label(name_, "UNIT");
  // Where the label names no mark, GDAL takes 0 for one.
  bands_->masked = is_signed_or_float(first) || !value_in_label(name_, "MISSING_CONSTANT").empty() ||
                   !value_in_label(name_, "MISSING").empty();
}

// FITS gives scaled numbers, cut to integers where integers are stored, and the mark for no data as stored.
void RasterFile::read_fits(GDALRasterBand& first) {
  Bands& b = *bands_;
  const double factor = std::exchange(b.factor, 1.0), offset = std::exchange(b.offset, 0.0);
  const bool integers = GDALDataTypeIsFloating(first.GetRasterDataType()) == 0;
  const bool unsigned_ones = integers && !is_signed_or_float(first);  // stored from below 0
  if (integers && (factor != 1.0 || (offset != 0.0 && !unsigned_ones)))
    fail("holds scaled integers; save it as FITS or GeoTIFF of 32-bit floats");
  b.masked = false;
  int known = 0;
  const double blank = first.GetNoDataValue(&known);
  if (known != 0) b.blank = unsigned_ones && blank < 0.0 ? blank + 0.5 * (full_scale(first) + 1.0) : blank;
  const char* unit = dataset_->GetMetadataItem("BUNIT");
  if (b.unit.empty() && unit != nullptr) b.unit = unit;
}

// A picture from above is turned so that north is above and east to the right: in another order of its rows
// or columns it is the ground's mirror image.
void RasterFile::turn_to_north(const GroundSteps& steps) {
  constexpr int kMirrored = 2, kTurned = 3, kFlipped = 4;  // of EXIF
  if (orientation_ != 1 || (!steps.west && !steps.south)) return;
  orientation_ = !steps.south ? kMirrored : steps.west ? kTurned : kFlipped;
}

void RasterFile::find_scale(const std::string& height_unit) {
  StatedScale scale;
  const std::optional<GroundSteps> steps = ground_steps(*dataset_);
  if (steps && steps->column.length() > 0.0 && steps->row.length() > 0.0) {
    scale.pixel_width = steps->column.length();
    scale.pixel_height = steps->row.length();
    scale.like_degrees = steps->like_degrees;
    scale.perhaps_degrees = steps->perhaps_degrees;
    scale.unknown = steps->unknown;
    turn_to_north(*steps);
    if (orientation_ > 4) std::swap(scale.pixel_width, scale.pixel_height);  // rows become columns
    const double shear = steps->column.east * steps->row.east + steps->column.north * steps->row.north;
    scale.sheared = std::abs(shear) > 0.01 * scale.pixel_width * scale.pixel_height;
    scale.pixel_source = steps->source;
  }
  Bands& b = *bands_;
  if (!height_unit.empty())
    b.unit = height_unit;
  else if (b.unit.empty())
    b.unit = vertical_unit(*dataset_);
  const double metres = unit_metres(b.unit);
  const bool many_levels = b.as_stated ? b.values.front()->GetRasterDataType() != GDT_Byte || b.signed_bytes
                                       : full_scale(*b.values.front()) >= 65535.0;
  const bool one = b.channels() == 1 && (!b.white_is_zero || !height_unit.empty());
  if (!height_unit.empty() && !one) fail("has colours, and no heights; leave --height-unit out");
  if (one && (metres > 0.0 || (b.unit.empty() && scale.pixel_width > 0.0 && many_levels))) {
    scale.heights = true;
    if (!b.as_stated) b.factor = 1.0;
    b.as_stated = true;
    if (metres > 0.0) {
      b.factor *= metres;
      b.offset *= metres;
      if (b.unit.find_first_of(" (,") != std::string::npos) scale.height_source = "unit \"" + b.unit + "\"";
    } else {
      scale.height_source = "no unit is stated";
      if (steps && !steps->plane_unit.empty())
        scale.height_source +=
            ", and the plane counts in " + steps->plane_unit + ": --height-unit says another";
    }
  }
  if (scale.heights) b.see_through = false;  // what is transparent has no height
  if (scale.heights || scale.pixel_width > 0.0) scale_ = scale;
}

std::vector<std::string> RasterFile::remarks() const {
  std::vector<std::string> remarks;
  if (bands_->not_opaque > 0 && !bands_->premultiplied && !(scale_ && scale_->heights)) {
    remarks.push_back(fmt::format(
        "alpha ignored: {:.1f} % of the pixels are not opaque, and count with the colour stored under it",
        100.0 * static_cast<double>(bands_->not_opaque) / (static_cast<double>(width()) * height())));
  }
  if (animated_) remarks.emplace_back("animated: only the first frame used");
  if (bands_->fourth_unused) remarks.emplace_back("only the first three of four bands used");
  if (dataset_->GetMetadataItem("SUBDATASET_2_NAME", "SUBDATASETS") != nullptr)
    remarks.emplace_back("only the first of several pages used");
  if (bands_->channels() == 1 && !bands_->unit.empty() && !(scale_ && scale_->heights)) {
    remarks.push_back("its unit \"" + bands_->unit +
                      "\" is no length, and its values are taken as brightness");
  }
  return remarks;
}

bool RasterFile::names_gaps() const {
  const Bands& b = *bands_;
  return b.blank || (b.masked && (b.values.front()->GetMaskFlags() & (GMF_NODATA | GMF_PER_DATASET)) != 0);
}

namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double RasterFile::to_value(double stored) const {
  const Bands& b = *bands_;
  return b.factor * stored + b.offset;
}

double RasterFile::to_stored(double value) const {
  const Bands& b = *bands_;
  return (value - b.offset) / b.factor;
}

void RasterFile::read(const TakeRow& take, const Progress& progress) {
  const QuietGdal quiet;
  Bands& b = *bands_;
  hold_block_row(*b.values.front());
  const auto columns = static_cast<std::size_t>(width());
  const auto channels = static_cast<std::size_t>(b.channels());
  std::vector<double> stored(columns), row(columns * channels), alpha(b.alpha != nullptr ? columns : 0);
  std::vector<std::uint8_t> valid(columns), band_valid(columns), clear(columns);
  b.not_opaque = 0;
  for (int y = 0; y < height(); ++y) {
    if (!report(progress, static_cast<double>(y) / height(), "read"))
      throw WorkError(name_ + ": stopped; nothing is written");
    bool whole = b.alpha == nullptr || read_row(*b.alpha, y, GDT_Float64, alpha.data());
    std::fill(valid.begin(), valid.end(), std::uint8_t{0});
    for (std::size_t k = 0; whole && k < b.values.size(); ++k) {
      GDALRasterBand& band = *b.values[k];
      const bool all = !b.masked || (band.GetMaskFlags() & (GMF_ALL_VALID | GMF_ALPHA)) != 0;
      whole = read_row(band, y, GDT_Float64, stored.data()) &&
              (all || read_row(*band.GetMaskBand(), y, GDT_Byte, band_valid.data()));
      for (std::size_t x = 0; x < columns; ++x) {
        double v = stored[x];
        valid[x] = valid[x] || all || band_valid[x];
        if (b.palette != nullptr) {
          GDALColorEntry entry{};
          b.palette->GetColorEntryAsRGB(static_cast<int>(v), &entry);
          clear[x] = b.see_through && entry.c4 < 255;
          const double rgb[] = {entry.c1 / 255.0, entry.c2 / 255.0, entry.c3 / 255.0};
          std::copy(rgb, rgb + 3, row.begin() + static_cast<std::ptrdiff_t>(3 * x));
          continue;
        }
        if (b.signed_bytes && v > 127.0) v -= 256.0;
        const bool mark = !(v >= b.least && v <= b.most) || (b.blank && v == *b.blank);
        v = to_value(v);
        row[x * channels + k] = mark ? kMissing : b.white_is_zero && !b.as_stated ? 1.0 - v : v;
      }
    }
    if (!whole) fail("ends too early or is damaged; fetch it again");
    for (std::size_t x = 0; x < columns; ++x) {
      const double opacity = b.alpha != nullptr ? alpha[x] / b.opaque : 1.0;
      b.not_opaque += opacity < 1.0 || clear[x] || (b.see_through && !valid[x]);
      const bool erased = !(opacity > 0.0) && (b.premultiplied || (scale_ && scale_->heights));
      for (std::size_t k = 0; k < channels; ++k) {
        double& v = row[x * channels + k];
        if (b.premultiplied && !b.as_stated && opacity > 0.0) v = std::min(v / opacity, 1.0);
        if ((!valid[x] && !b.see_through) || erased) v = kMissing;
      }
    }
    take(row, b.channels());
  }
}

}  // namespace astrolith
