// Random points on a mesh's surface, with normals.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

struct SurfaceSamples {
  std::vector<Vec3d> points;             // (n)
  std::vector<Vec3d> normals;            // (n) unit, outwards
  std::vector<std::uint32_t> triangles;  // (n) the triangle each point lies in
};

enum class SampleNormals {
  triangle,     // the normal of the triangle that the point lies in
  interpolated  // angle-weighted vertex normals, interpolated over the triangle
};

// n independent points, uniform over the area. Sample i depends on the mesh, the seed and i alone, so that
// the first k of n samples are the samples of k. Throws InputError for a mesh without area and for n outside
// 0 to (2^31 - 1) / 5, and WorkError when progress asks to stop.
SurfaceSamples sample_surface(const TriangleMesh& mesh, std::int64_t n, std::uint64_t seed,
                              SampleNormals normals = SampleNormals::triangle, const Progress& progress = {});

// Exactly n evenly spread points (blue noise). Five times as many area-weighted candidates are drawn, and the
// most crowded one is removed until n are left (Yuksel, "Sample elimination for generating Poisson disk
// sample sets", Computer Graphics Forum 2015, with its constants alpha = 8, beta = 0.65, gamma = 1.5).
// Distances are straight lines through space. Samples keep the random order of the candidates. Throws as
// sample_surface does.
SurfaceSamples sample_poisson_disk(const TriangleMesh& mesh, std::int64_t n, std::uint64_t seed,
                                   SampleNormals normals = SampleNormals::triangle,
                                   const Progress& progress = {});

// Half the largest distance that n points on a surface can all keep from one another, packed as hexagons:
// sqrt(area / (2 sqrt(3) n)), Yuksel's r_max. In the unit of length whose square is the unit of `area`.
double poisson_disk_radius(double area, std::int64_t n);

}  // namespace astrolith
