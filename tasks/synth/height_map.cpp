#include "tasks/synth/ground_maps.h"

#include <cmath>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/length_unit.h"
#include "numerics/vec3_json.h"
#include "synthesis/picture/image_file.h"
#include "tasks/job/json_text.h"
#include "tasks/job/output_names.h"

namespace astrolith {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostPixels = 16384;

std::filesystem::path frame_file(const std::filesystem::path& file) {
  return std::filesystem::path(file).replace_extension(".json");
}

}  // namespace

std::vector<std::filesystem::path> height_map_files(const std::vector<std::string>& names) {
  std::vector<std::filesystem::path> files(names.begin(), names.end());
  for (const std::string& name : names) files.push_back(frame_file(name));
  return files;
}

void check_map(const std::filesystem::path& file, const std::string& option, const Region& region,
               const Recipe& recipe, int resolution) {
  if (!region.is_patch) throw InputError(option + ": is of a patch; add --patch X Y Z SIDE");
  if (!region.plane)
    throw InputError(option +
                     ": the patch holds no surface that faces one direction; move it, or take a smaller one");
  if (recipe.length_unit == "px")
    throw InputError(option + ": a recipe in px has no size; state m or km in it");
  if (resolution > kMostPixels)
    throw InputError(option + ": has at most 16384 pixels along a side; lower --resolution");
  require_extension(file, {".tif"});
  require_writable(file);
}

void check_height_map(const std::filesystem::path& file, const Region& region, const Recipe& recipe,
                      int resolution) {
  if (file.empty()) return;
  check_map(file, "--height-map", region, recipe, resolution);
  require_writable(frame_file(file));
}

HeightMap heights_of_patch(const TriangleMesh& mesh, const PatchGround& ground, int resolution) {
  const double metres = metres_of(ground.recipe.length_unit);
  return height_map(mesh, *ground.region.plane, ground.region.size, resolution, metres);
}

Json frame_json(const HeightMap& map, const PatchGround& ground) {
  const double metres = metres_of(ground.recipe.length_unit);
  std::int64_t without = 0;
  for (const float height : map.heights) without += std::isnan(height) ? 1 : 0;
  return {{"pixels", map.side},
          {"metres_per_pixel", metres * map.pixel},
          {"origin_m", json_of(metres * (ground.recipe.origin + ground.region.center + map.origin))},
          {"right", json_of(map.right)},
          {"ahead", json_of(map.ahead)},
          {"up", json_of(map.up)},
          {"body_frame", ground.recipe.frame},
          {"pixel_center",
           "origin + (i + 1/2 - pixels/2) metres_per_pixel right + (pixels/2 - (j + 1/2)) "
           "metres_per_pixel ahead + height up; column i, row j from the top left"},
          {"pixels_without_data", without}};
}

void write_height_map(Job& job, const std::filesystem::path& file, const HeightMap& map,
                      const PatchGround& ground) {
  const Json frame = frame_json(map, ground);
  write_geotiff(map.heights, map.side, map.side, metres_of(ground.recipe.length_unit) * map.pixel,
                frame.dump(-1, ' ', true, Json::error_handler_t::replace), file);
  write_file(frame_file(file), json_text(frame));
  job.summary["height_map"] = frame;
}

}  // namespace astrolith
