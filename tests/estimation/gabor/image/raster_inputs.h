// Writes rasters by GDAL and TIFF files by libtiff, for tests of their readers.
#pragma once

#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <tiffio.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace astrolith::testing {

struct RasterInput {
  const char* format = "GTiff";
  GDALDataType type = GDT_Float32;
  int width = 3, height = 2, bands = 1;
  std::vector<const char*> options = {};  // of the format, such as "TILED=YES"
};

// The values are those of the first band, row by row, and then of the next ones. `describe` states what else
// the file says.
inline std::filesystem::path write_raster(const std::filesystem::path& file, const RasterInput& input,
                                          std::vector<double> values,
                                          const std::function<void(GDALDataset&)>& describe = {}) {
  GDALAllRegister();
  CPLPushErrorHandler(CPLQuietErrorHandler);
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(input.format);
  std::vector<const char*> options = input.options;
  options.push_back(nullptr);
  auto* const list = const_cast<char**>(options.data());
  const bool copied = driver->GetMetadataItem(GDAL_DCAP_CREATE) == nullptr;
  GDALDriver* const first = copied ? GetGDALDriverManager()->GetDriverByName("MEM") : driver;
  std::unique_ptr<GDALDataset> made(first->Create(copied ? "" : file.c_str(), input.width, input.height,
                                                  input.bands, input.type, copied ? nullptr : list));
  if (describe) describe(*made);
  const CPLErr written = made->RasterIO(GF_Write, 0, 0, input.width, input.height, values.data(), input.width,
                                        input.height, GDT_Float64, input.bands, nullptr, 0, 0, 0, nullptr);
  if (written == CE_None && copied)
    std::unique_ptr<GDALDataset>(driver->CreateCopy(file.c_str(), made.get(), 0, list, nullptr, nullptr));
  made.reset();
  CPLPopErrorHandler();
  return file;
}

// Square pixels with the sides of `side`, in metres or in what the frame counts.
inline void place(GDALDataset& raster, double side, const std::string& frame = "") {
  std::array<double, 6> transform{100.0, side, 0.0, 200.0, 0.0, -side};
  raster.SetGeoTransform(transform.data());
  OGRSpatialReference reference;
  if (!frame.empty() && reference.SetFromUserInput(frame.c_str()) == OGRERR_NONE)
    raster.SetSpatialRef(&reference);
}

// A TIFF of 8 bits of the samples, with more tags.
inline std::filesystem::path write_tiff(const std::filesystem::path& file, int width, int samples,
                                        std::vector<std::uint8_t> bytes,
                                        const std::function<void(TIFF*)>& tags) {
  TIFF* const tiff = TIFFOpen(file.c_str(), "w");
  const int row = width * samples, height = static_cast<int>(bytes.size()) / row;
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, samples >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
  tags(tiff);
  for (int y = 0; y < height; ++y)
    TIFFWriteScanline(tiff, &bytes[static_cast<std::size_t>(y * row)], static_cast<std::uint32_t>(y));
  TIFFClose(tiff);
  return file;
}

}  // namespace astrolith::testing
