// Heights like the measured ones, in other places: patches of them are laid around other anchors. A body of
// the kind then has whole boulders and craters where the measured one has others.
//
// The places p_i have normals n_i, weights a_i and measured heights h_i, which are coefficients of the blend.
// e is the mean edge of the measured model. S(s) means with the standard deviation s (relief_smoothing.h). V
// makes values at the places of coefficients, and V^-1 coefficients of values (relief_values.h).
//
//   details of the bare surface: the mean over places j around i of (n_i + n_j) . (p_i - p_j) / 2, s = 4 e
//        d_i = [n_i . (p_i - (S p)_i) + (S n)_i . p_i - (S (n . p))_i] / 2
//   bands, b = 0 .. 4, s_b = .8 e, 1.6 e, 3.2 e, 6.4 e, 12.8 e:
//        g_0 = h + V^-1 d,   g_b+1 = S(s_b) g_b,   w_b = g_b - g_b+1
//   strength of a band, with q = S (V w_b)^2 (s = 3 e for b < 3, else 12 e) and m its largest value:
//        r(w_b) = sqrt(m exp(sum a_i log max(q_i / m, 1e-12) / sum a_i))
//   patches of the bands w_b, laid over the places (relief_laying.h), have the values l_b; their sum is
//   split:
//        u_0 = V^-1 sum l_b,   u_b+1 = S(s_b) u_b,   x_b = u_b - u_b+1
//   new heights, whose bands are as strong as those that were measured:
//        y = u_5 + sum min(r(w_b) / r(x_b), 2) x_b
//        h' = h - sum w_b + y on the measured body, and h' = y on another one, where w_4 holds g_5, too
//
// At last h' moves until small patches of the surface V h' + d are distributed as those of V h + d, now with
// s = 14 e in d (relief_matching.h): the bends of the base that stay and the patches no longer belong
// together.
//
// What is wider than all bands stays on the measured body. Its strength is a geometric mean over the body,
// since a mean of squares would be that of few rough places. Where unseen ground is filled, places do not
// count whose q is below 1/49 of its third quartile.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "synthesis/relief/relief_patches.h"

namespace astrolith {

struct LikenessOptions {
  double reach = 0.3;  // how far donors are looked for at first, as a share of the body's diagonal
  bool fill = false;   // whether unseen ground (relief_patches.h) gets patches of seen ground
  std::uint32_t hash = 0;
  bool matched = true;  // whether the last step is made (relief_matching.h); never with fill
};

// New heights h' at places of a body with their tiles, from those measured on it or, with `foreign`, on
// another one. Throws InputError, which begins with `where`, where fewer than ten anchors have been measured.
std::vector<double> like_heights(const std::vector<ReliefPlace>& places, const ReliefTiles& tiles,
                                 const ReliefPatches& patches, bool foreign, double spacing,
                                 const LikenessOptions& options, const std::string& where);

// The measured heights, but for ground that no camera saw, which gets patches of seen ground. The patches are
// laid over the values V w_b of the bands, which each place holds with the cover c; seams part both:
//   h + V^-1 sum (l_b - V w_b),   c_i = min(max(q_i / q_0 - 1, 0), 1)
// q_i is the mean square of narrow heights around a place, and q_0 the largest of those around unseen
// anchors.
std::vector<double> filled_heights(const ReliefPatches& patches, double spacing,
                                   const LikenessOptions& options);

}  // namespace astrolith
