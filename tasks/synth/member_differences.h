// How much the members of a set differ from one another.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

// The share of the silhouettes of two bodies that one of them has alone: the area of their symmetric
// difference over that of their union, seen along x, y and z together, in [0, 1]. Meshes are closed and in
// one frame.
double silhouette_difference(const TriangleMesh& a, const TriangleMesh& b);

// How much these members of a set differ, pair by pair: the mean distance of the surfaces as a fraction of
// the first one's diagonal, and the difference of the silhouettes; the least, the mean and the most of each.
// Null for fewer than two members. Throws WorkError when progress asks to stop.
nlohmann::ordered_json member_differences(const std::vector<TriangleMesh>& members,
                                          const Progress& progress = {});

// "two members differ by 3.1 % (0.8 to 6) of the diagonal ...", for figures that are not null.
std::string describe_differences(const nlohmann::ordered_json& figures);

}  // namespace astrolith
