#include <algorithm>

#include "geometry/ear_cutter.h"
#include "geometry/io/format_internal.h"

namespace astrolith {

void append_quad(const std::vector<Vec3d>& points, const std::array<std::uint32_t, 4>& q,
                 std::vector<Triangle>& out) {
  if (squared_norm(points[q[2]] - points[q[0]]) <= squared_norm(points[q[3]] - points[q[1]])) {
    out.push_back({q[0], q[1], q[2]});
    out.push_back({q[0], q[2], q[3]});
  } else {
    out.push_back({q[0], q[1], q[3]});
    out.push_back({q[1], q[2], q[3]});
  }
}

void PolygonFans::append(std::span<const std::uint32_t> polygon, std::vector<Triangle>& triangles) {
  if (polygon.size() > 3) fans_.push_back({triangles.size(), polygon.size() - 2});
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
  }
}

void PolygonFans::cut_concave(const MeshFile& file, TriangleMesh& mesh) const {
  const auto in_range = [&](const Triangle& t) {
    return std::max({t[0], t[1], t[2]}) < mesh.vertices.size();
  };
  std::vector<std::span<Triangle>> concave;
  std::size_t squares = 0;
  for (const auto& [first, count] : fans_) {
    const auto fan = std::span(mesh.triangles).subspan(first, count);
    if (!std::all_of(fan.begin(), fan.end(), in_range) || fan_covers_polygon(fan, mesh.vertices)) continue;
    concave.push_back(fan);
    squares += (count + 2) * (count + 2);
    if (squares > kMostSquaredCorners) {
      file.fail("triangle " + std::to_string(first + 1),
                "a face of " + std::to_string(count + 2) + " corners is not convex, which takes too long " +
                    (concave.size() > 1 ? "with those before it" : "to cut"),
                "cut such faces into triangles");
    }
  }
  for (const std::span<Triangle> fan : concave) cut_ears(fan, mesh.vertices);
}

}  // namespace astrolith
