// Writes height maps of a local plane that GDAL and GIS programs read.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace astrolith {

// Writes a GeoTIFF of 32-bit floats, row-major with the top row first, uncompressed. The map is a plane in
// metres without a datum: `pixel` metres a pixel, zero at the middle of the map, x to the right and y up. NaN
// is stated as the value of no data. `description` becomes the image's description. Throws what
// write_tiff_float() throws.
void write_geotiff(std::span<const float> values, int width, int height, double pixel,
                   const std::string& description, const std::filesystem::path& file);

}  // namespace astrolith
