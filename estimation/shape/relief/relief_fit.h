// Fits a relief layer: the heights of a measured surface over the body of a recipe.
//
// The synthesis puts a point q on the surface where s(q) + n(p) = 0, with p the projection of q on the bare
// body. So every point q of the measured surface says n(p) = -s(q), and the heights at the places of the
// layer follow from many such points by least squares (relief_fit.cpp). The same projection serves the fit
// and the synthesis: it needs neither to be along the normal nor exact.
// Heights are taken back where they make what neither the metaballs nor the target have.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "numerics/vec3.h"
#include "recipe/recipe.h"

namespace astrolith {

// Halves the heights that give these points theirs: those around the points' projections on the bare body.
// Halved again and again, the surface there becomes that of the metaballs. Points are in the frame and unit
// of the recipe. Its first relief is one of its own body, as fit_relief() makes it. Returns how many heights
// changed; 0 without a relief.
std::size_t halve_heights(const std::vector<Vec3d>& points, Recipe& recipe);

// A model with fewer facets has no relief that its metaballs do not show.
inline constexpr std::size_t kFewestReliefFacets = 1000;

struct ReliefOptions {
  double spacing = 0.0;  // length units; 0: 1.2 to 12 places for each vertex, more on small models
  double step = 0.0;     // between two heights, length units; 0: kDefaultStep times the mean residual
};

struct ReliefFit {
  ReliefLayer layer;           // with pixels, without the name of a file
  std::size_t heights = 0;     // number of heights
  double base_distance = 0.0;  // mean |height| of the samples: the base's own error, length units
  double residual = 0.0;       // mean |residual| of the samples after rounding, length units
  double left_out = 0.0;       // share of the samples that no height reaches, [0, 1]
};

// The spacing that shows what the facets of a surface show, or the least that a relief of it may have.
double least_relief_spacing(const TriangleMesh& surface);

// Throws InputError for a surface of fewer than kFewestReliefFacets facets.
void expect_relief_facets(const TriangleMesh& surface);

// Fits the heights of `surface` over the body of `recipe`; both are in the recipe's frame and unit. Throws
// InputError for a surface of fewer than kFewestReliefFacets facets, a body with operations or a warp, and a
// spacing too small for the body. The layer has no pixels where the work was asked to stop before there were
// heights.
ReliefFit fit_relief(const TriangleMesh& surface, const Recipe& recipe, const ReliefOptions& options = {},
                     const Progress& progress = {});

}  // namespace astrolith
