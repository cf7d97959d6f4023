// Analytic meshes with known measures. They are closed and counter-clockwise from outside unless their names
// say otherwise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "geometry/triangle_mesh.h"

namespace astrolith::testing {

inline TriangleMesh tetrahedron(double radius = 1.0) {
  const double s = radius / std::sqrt(3.0);
  return {
      {{s, s, s}, {s, -s, -s}, {-s, s, -s}, {-s, -s, s}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}, {}};
}

inline TriangleMesh octahedron(double radius = 1.0) {
  const double r = radius;
  return {{{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}},
          {}};
}

// The cube [0, side]^3 shifted by `corner`, with two triangles for each face.
inline TriangleMesh cube(double side = 1.0, const Vec3d& corner = {}) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(corner + Vec3d{(i & 1) * side, (i >> 1 & 1) * side, (i >> 2 & 1) * side});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// Splits each triangle into four at the midpoints of its edges.
inline TriangleMesh subdivided(const TriangleMesh& coarse) {
  TriangleMesh fine;
  fine.vertices = coarse.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> midpoints;
  const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
    const auto [it, added] =
        midpoints.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.vertices.size()));
    if (added) fine.vertices.push_back(0.5 * (coarse.vertices[a] + coarse.vertices[b]));
    return it->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::uint32_t ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
    fine.triangles.insert(fine.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

// An icosahedron, subdivided and pushed onto the sphere: 20 * 4^subdivisions triangles, with vertices exactly
// at `radius`.
inline TriangleMesh icosphere(int subdivisions, double radius = 1.0, const Vec3d& center = {}) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh{{{-1, g, 0},
                     {1, g, 0},
                     {-1, -g, 0},
                     {1, -g, 0},
                     {0, -1, g},
                     {0, 1, g},
                     {0, -1, -g},
                     {0, 1, -g},
                     {g, 0, -1},
                     {g, 0, 1},
                     {-g, 0, -1},
                     {-g, 0, 1}},
                    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}},
                    {}};
  for (int i = 0; i < subdivisions; ++i) mesh = subdivided(mesh);
  for (Vec3d& p : mesh.vertices) p = center + radius * normalized(p);
  return mesh;
}

// A torus around the z axis: `columns` quads along the big circle, `rows` along the small one.
inline TriangleMesh torus(double big_radius, double small_radius, int columns = 48, int rows = 24) {
  TriangleMesh mesh;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const double u = 2 * std::numbers::pi * i / columns, v = 2 * std::numbers::pi * j / rows;
      const double rho = big_radius + small_radius * std::cos(v);
      mesh.vertices.push_back({rho * std::cos(u), rho * std::sin(u), small_radius * std::sin(v)});
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % columns) * rows + j % rows); };
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

// Two meshes in one, which share nothing.
inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({i + offset, j + offset, k + offset});
  return a;
}

// Two spheres of the given radius at x = -distance/2 and x = +distance/2.
inline TriangleMesh two_spheres(int subdivisions, double radius, double distance) {
  return joined(icosphere(subdivisions, radius, {-distance / 2, 0, 0}),
                icosphere(subdivisions, radius, {distance / 2, 0, 0}));
}

// A half sphere, open with one boundary loop: the faces of an icosphere whose three vertices have z >= 0.
inline TriangleMesh open_cap(int subdivisions, double radius = 1.0) {
  TriangleMesh mesh = icosphere(subdivisions, radius);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.vertices[t[0]].z < 0 || mesh.vertices[t[1]].z < 0 || mesh.vertices[t[2]].z < 0;
  });
  return mesh;
}

// The mesh with every face turned inside out.
inline TriangleMesh reversed(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace astrolith::testing
