// Heights like the measured ones, in other places: patches of them are drawn for other anchors, turned and
// blended. A body of the kind then has whole boulders and craters where the measured one has others.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "synthesis/body/body_ground.h"
#include "synthesis/relief/relief_places.h"

namespace astrolith {

struct LikenessOptions {
  double edge = 0.0;   // mean edge of the model that was measured, length units
  double reach = 0.3;  // how far donors are looked for at first, as a share of the body's diagonal
  std::uint32_t hash = 0;
};

// Heights at the places of a body.
struct MeasuredRelief {
  BodyGround ground;
  const std::vector<ReliefPlace>& places;
  const std::vector<double>& heights;  // coefficients of the blend (relief_layer.h), length units
};

// New heights at places of a body, from those measured on it or, with `foreign`, on another one.
//
// Anchors (relief_anchors.h) lie 16 edges apart, or on small models as near as leaves forty of them, but 8 at
// least. A place at the offset o from an anchor, in the tangent frame and as long as the chord, gets the
// height at the offset o from the anchor's donor, turned by an angle of the hash and projected on the
// surface. Heights smoothed by 2.5 edges are means over the anchors within R = 1.5 distances with weights
// (1 - d^2 / R^2)^3, since they are wide; the rest has an exponent of up to 30, and is divided by the root of
// the sum of the squared weights, so that it keeps its variance. Bands of the result, cut at .7, 1.4 and 2.8
// edges, become as strong as those that were measured, by the
// geometric mean over the body of the root mean square around a place.
// Throws InputError, which begins with `where`, where fewer than ten anchors have been measured.
std::vector<double> like_heights(const std::vector<ReliefPlace>& places, const MeasuredRelief& measured,
                                 bool foreign, double spacing, const LikenessOptions& options,
                                 const std::string& where);

}  // namespace astrolith
