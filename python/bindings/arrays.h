// NumPy arrays from and for the libraries. The Python side of the package has checked shapes, types and
// numbers.
#pragma once

#include <nanobind/ndarray.h>

#include <array>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith::python {

namespace nb = nanobind;

template <typename T>
using Rows = nb::ndarray<const T, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
template <typename T>
using NumpyArray = nb::ndarray<nb::numpy, T>;

// An array of the vector's memory, which it takes over. The size of the vector's elements must be that of the
// last axes: a vector of n Vec3f becomes (n x 3) floats.
template <typename T, typename Element>
NumpyArray<T> array_of(std::vector<Element>&& values, std::initializer_list<std::size_t> shape) {
  auto* held = new std::vector<Element>(std::move(values));
  nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<Element>*>(p); });
  return NumpyArray<T>(reinterpret_cast<T*>(held->data()), shape, owner);
}

inline std::vector<Vec3d> points_of(const Rows<double>& rows) {
  std::vector<Vec3d> points(rows.shape(0));
  const double* p = rows.data();
  for (Vec3d& v : points) {
    v = {p[0], p[1], p[2]};
    p += 3;
  }
  return points;
}

inline TriangleMesh mesh_of(const Rows<double>& vertices, const Rows<std::uint32_t>& faces,
                            const std::optional<Rows<double>>& normals) {
  TriangleMesh mesh;
  mesh.vertices = points_of(vertices);
  mesh.triangles.resize(faces.shape(0));
  const std::uint32_t* f = faces.data();
  for (Triangle& t : mesh.triangles) {
    t = {f[0], f[1], f[2]};
    f += 3;
  }
  if (normals) mesh.normals = points_of(*normals);
  return mesh;
}

}  // namespace astrolith::python
