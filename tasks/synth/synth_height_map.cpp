#include "tasks/synth/synth_mesh_internal.h"

#include <cmath>

#include "geometry/surface/height_map.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/length_unit.h"
#include "numerics/vec3_json.h"
#include "synthesis/picture/image_file.h"
#include "tasks/job/output_names.h"

namespace astrolith {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostPixels = 16384;

std::filesystem::path frame_file(const std::filesystem::path& file) {
  return std::filesystem::path(file).replace_extension(".json");
}

Json frame_json(const HeightMap& map, const Region& region, const Recipe& recipe) {
  const double metres = metres_of(recipe.length_unit);
  std::int64_t without = 0;
  for (const float height : map.heights) without += std::isnan(height) ? 1 : 0;
  return {{"pixels", map.side},
          {"metres_per_pixel", metres * map.pixel},
          {"origin_m", json_of(metres * (recipe.origin + region.center + map.origin))},
          {"right", json_of(map.right)},
          {"ahead", json_of(map.ahead)},
          {"up", json_of(map.up)},
          {"body_frame", recipe.frame},
          {"pixel_center",
           "origin + (i + 1/2 - pixels/2) metres_per_pixel right + (pixels/2 - (j + 1/2)) "
           "metres_per_pixel ahead + height up; column i, row j from the top left"},
          {"pixels_without_data", without}};
}

}  // namespace

std::vector<std::filesystem::path> height_map_files(const std::vector<std::string>& names) {
  std::vector<std::filesystem::path> files(names.begin(), names.end());
  for (const std::string& name : names) files.push_back(frame_file(name));
  return files;
}

void check_height_map(const std::filesystem::path& file, const Region& region, const Recipe& recipe,
                      int resolution) {
  if (file.empty()) return;
  if (!region.is_patch) throw InputError("--height-map: is of a patch; add --patch X Y Z SIDE");
  if (recipe.length_unit == "px")
    throw InputError("--height-map: a recipe in px has no size; state m or km in it");
  if (resolution > kMostPixels)
    throw InputError("--height-map: has at most 16384 pixels along a side; lower --resolution");
  require_extension(file, {".tif"});
  require_writable(file);
  require_writable(frame_file(file));
}

void write_height_map(Job& job, const std::filesystem::path& file, const TriangleMesh& mesh,
                      const Region& region, const Recipe& recipe, int resolution) {
  const double metres = metres_of(recipe.length_unit);
  const HeightMap map = region.axes ? height_map(mesh, *region.axes, region.size, resolution, metres)
                                    : height_map(mesh, region.size, resolution, metres);
  const Json frame = frame_json(map, region, recipe);
  write_geotiff(map.heights, map.side, map.side, metres * map.pixel,
                frame.dump(-1, ' ', true, Json::error_handler_t::replace), file);
  write_file(frame_file(file), frame.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  job.summary["height_map"] = frame;
}

}  // namespace astrolith
