#include "apps/synth/synth_region.h"

#include <cstdio>

#include "numerics/errors.h"

namespace astrolith {
namespace {

Region parse_tile(const std::string& text) {
  int number = 0, count = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%6d/%6d%c", &number, &count, &rest) != 2) {
    throw InputError("tile: \"" + text + "\" is no tile; write I/N with I from 1 to N, such as 3/16");
  }
  return tile_region(number, count);
}

}  // namespace

Region parse_region(const std::string& tile, const std::vector<double>& patch, bool aligned) {
  if (!patch.empty()) {
    Region region = patch_region({patch[0], patch[1], patch[2]}, patch[3]);
    region.aligned = aligned;
    return region;
  }
  return tile.empty() ? Region{} : parse_tile(tile);
}

}  // namespace astrolith
