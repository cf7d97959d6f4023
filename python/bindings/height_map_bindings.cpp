#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <array>
#include <cstdint>
#include <utility>

#include "geometry/surface/height_map.h"
#include "numerics/length_unit.h"
#include "python/bindings/arrays.h"
#include "python/bindings/job.h"
#include "python/bindings/synthesis_bindings.h"

namespace astrolith::python {
namespace {

using Plane =
    std::array<std::array<double, 3>, 4>;  // right, ahead, up and the origin, relative to the centre

Vec3d vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
std::array<double, 3> list(const Vec3d& v) { return {v.x, v.y, v.z}; }

nb::typed<nb::dict, nb::str, nb::any> height_map_of(const Rows<double>& vertices,
                                                    const Rows<std::uint32_t>& faces,
                                                    const std::array<double, 3>& center, double length,
                                                    int pixels, const std::string& unit, const Plane& plane) {
  const double metres = metres_per_unit(unit);
  HeightMap map = run_job(nb::none(), 0, [=, mesh = mesh_of(vertices, faces, {})](JobState&) {
    const auto& [right, ahead, up, origin] = plane;
    const GroundAxes axes{vector(right), vector(ahead), vector(up)};
    return height_map(mesh, GroundPlane{axes, vector(origin)}, length, pixels, metres);
  });
  const auto side = static_cast<std::size_t>(map.side);
  nb::typed<nb::dict, nb::str, nb::any> result;
  result["pixel"] = metres * map.pixel;
  result["origin"] = list(metres * (Vec3d{center[0], center[1], center[2]} + map.origin));
  result["right"] = list(map.right);
  result["ahead"] = list(map.ahead);
  result["up"] = list(map.up);
  result["heights"] = array_of<float>(std::move(map.heights), {side, side});
  return result;
}

}  // namespace

void bind_height_maps(nb::module_& module) {
  module.def("height_map", &height_map_of, nb::arg("vertices").noconvert(), nb::arg("faces").noconvert(),
             nb::arg("center"), nb::arg("length"), nb::arg("pixels"), nb::arg("unit"), nb::arg("plane"));
}

}  // namespace astrolith::python
