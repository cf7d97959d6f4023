#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/io/format_internal.h"
#include "geometry/io/text_scanner_internal.h"

namespace astrolith {

std::vector<Vec3d> read_points(const std::filesystem::path& file) {
  MeshFile content = load_mesh_file(file);
  std::replace(content.bytes.begin(), content.bytes.end(), ',', ' ');
  TextScanner scan(content);
  std::vector<Vec3d> points;
  bool names_may_come = true;
  while (scan.next_filled_line()) {
    const std::string_view first = scan.word();
    if (names_may_come && !parse_number(first)) {
      names_may_come = false;
      continue;
    }
    names_may_come = false;
    const double x = scan.to_number(first, "x"), y = scan.number("y"), z = scan.number("z");
    for (const double c : {x, y, z}) {
      if (!(std::fabs(c) <= 1e18)) scan.fail("a coordinate is beyond 1e18", "state lengths in a larger unit");
    }
    points.push_back({x, y, z});
  }
  if (points.empty()) content.fail("", "holds no points", "give lines of x, y and z");
  return points;
}

}  // namespace astrolith
