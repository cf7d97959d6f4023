// Points of a measured surface as conditions on the heights of a relief layer.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"
#include "synthesis/relief/relief_places.h"

namespace astrolith {

// One equation for each sample of the surface: the sum of shares[k] * height(places[k]), k from first[i] to
// first[i + 1] - 1, is the height that brings the layered surface there. Heights are length units of the
// recipe.
struct ReliefSamples {
  std::vector<float> height;
  std::vector<std::uint32_t> first{0};
  std::vector<std::uint32_t> places;
  std::vector<float> shares;

  std::size_t size() const { return height.size(); }
};

// The places of the recipe's body at this spacing, and the samples of `surface`: its vertices, and four
// points of each facet. Both are in the recipe's frame and unit. Samples whose projection misses the bare
// surface by more than a quarter of the spacing are left out: no height brings the surface there. Expects a
// body without operations and warps. Throws as find_relief_places().
struct ReliefEquations {
  std::vector<ReliefPlace> places;
  ReliefSamples samples;
};
ReliefEquations relief_equations(const TriangleMesh& surface, const Recipe& recipe, double spacing);

}  // namespace astrolith
