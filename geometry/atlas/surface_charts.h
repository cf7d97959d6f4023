// Cuts a surface into charts, each of which a projection along an axis lays flat.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// A direction of projection. right, up and out are right-handed and orthonormal, along the mesh's axes.
struct ChartAxis {
  Vec3d right, up, out;
};

// The six directions of a cube; every direction lies within 54.8 degrees of one of them.
inline constexpr std::array<ChartAxis, 6> kChartAxes{{{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
                                                      {{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}},
                                                      {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                                      {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                                      {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                                                      {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}}};

// A triangle whose normal lies at an angle to the axis is shortened by the cosine along one direction. The
// ratio of the singular values of the map from the surface to its chart is 1 / cosine, below 2.
inline constexpr double kLeastChartCosine = 0.505;

struct SurfaceCharts {
  std::vector<std::uint32_t> triangle_chart;  // (#F)
  std::vector<std::uint8_t> chart_axis;       // (#charts) an index into kChartAxes
};

// Each triangle takes the axis that the surface around it faces, where its own normal lies within 59 degrees
// of that axis, and else the nearest one. A chart is a set of triangles of one axis, joined by edges, no two
// of which overlap in the projection. Bodies of any topology will do, as will open meshes. Triangles without
// area join any chart. Throws InputError for indices out of range.
SurfaceCharts surface_charts(const TriangleMesh& mesh);

}  // namespace astrolith
