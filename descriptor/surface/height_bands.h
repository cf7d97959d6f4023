// The relief of a surface by scale: how high it is in bands of one octave, and whether high relief of one
// band lies where the next one has it too.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "descriptor/surface/evened_surface.h"
#include "numerics/progress.h"

namespace astrolith {

// Deviations of the smoothings, in edges. A band lies between two of them.
inline constexpr std::array<double, 5> kBandScales{0.8, 1.6, 3.2, 6.4, 12.8};

struct HeightBand {
  double from = 0.0, to = 0.0;  // edges
  double rms = 0.0;             // edges, about the mean over the surface
};

struct HeightBands {
  std::vector<HeightBand> bands;   // ascending; those that the body has room for
  std::optional<double> coupling;  // -1 to 1; where both of its bands are there and neither is flat
};

// Measures the bands on the surface itself, without a base. With G_s the mean of the surface around each
// point by Gaussian weights of the deviation s, and S_s = 3 G_s - 3 G_s G_s + G_s G_s G_s, the heights of a
// band from s to t are h = n . (S_s x - S_t x). n is the surface's normal, smoothed by G_t. On a plane S_s
// keeps the share 1 - (1 - g)^3 of a wave, with g = exp(-(2 pi s / wavelength)^2 / 2): the band from s to 2 s
// keeps most, .72, of waves of 4.9 s. A sphere of radius R shrinks by about R (s / R)^6 only, so that little
// of the body's shape counts as relief. Where t is above kMostBodyShare of the radius of a sphere of equal
// area, the shape would count, and the band is left out.
//
// The coupling is the correlation over the surface of sqrt(G_s a^2) and |b|, of the bands a from 3.2 to 6.4
// and b from 6.4 to 12.8 edges, with s = 6.4 edges.
//
// G_s is made of (s / .8)^2 steps of the deviation .8 edges, each a mean over the points within 2.2 edges
// with weights near 1 - d^2 / (2.2 edges)^2; the first leads from the mesh to the points. Points that look
// away lie on another side of a thin body and do not count. Near the border of an open mesh the means lean
// inwards. Throws WorkError when progress asks to stop.
HeightBands height_bands(const EvenedSurface& even, const Progress& progress = {});

inline constexpr double kMostBodyShare = 0.45;

}  // namespace astrolith
