// The unit of a raster's values.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace astrolith {

// The metres of a unit of length by its name, in any case; 0 for another unit. Words behind it that say from
// where heights count are passed over: "metres above the ellipsoid", "m (MSL)".
double metres_of_unit(std::string unit);

// What the label of a PDS3 image states for a keyword, without quotes; empty where it does not. GDAL keeps
// some keywords to itself.
std::string value_in_label(const std::filesystem::path& file, std::string_view keyword);

}  // namespace astrolith
