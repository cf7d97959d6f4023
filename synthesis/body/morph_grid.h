// The shape between measured bodies (recipe/body.h, Morph), as signed distances on a grid.
//
// Donor j with half axes b lies at the points D R M (p / a) of its own frame for the points p of the morph
// with half axes a: M mirrors, R turns about z, D stretches by b. Its signed distance s_j to the stretched
// surface is the first-order distance of its metaballs at the nodes beside the surface. Every other node has
// its distance to the foot of the nearest such node, as sweeps over the grid carry it on (Danielsson,
// Euclidean distance mapping, 1980). The ellipsoid's distance e is found in the same way, so that both agree
// deep inside. The sum of recipe/body.h at the nodes is the coefficients of the spline, which is the sum
// smoothed over 1/sqrt(3) of a spacing along each axis. A spline through the sum itself has knobs as large as
// a cell where donors are thin, since distances have kinks on the medial axis and a roughness above 1 makes
// them steeper.
#pragma once

#include "numerics/arrays.h"
#include "recipe/body.h"
#include "synthesis/body/spline_grid.h"

namespace astrolith {

// About this many nodes hold the domain: the ellipsoid's box, widened by its mean radius on every side.
inline constexpr double kMorphNodes = 131072.0;

// The distance between nodes, length units.
double morph_spacing(const Morph& morph);

// Throws InputError, with a message that begins with "body: ", for a shape that reaches the end of its
// domain.
SplineGrid make_morph_grid(const Morph& morph, ArrayStore& arrays);

}  // namespace astrolith
