// Where a lander may stand: squares of ground that are level, smooth and apart from one another.
//
// A site is what a square of side L, seen along the mean normal of its ground, holds of the surface: the
// ground of `synth --patch X Y Z L --aligned`. The cost of a site is an angle in degrees:
//
//   cost = mean slope + (180 / pi) roughness / (L / 2)
//
// where the roughness is the root mean square of the heights over the plane that fits the ground best. The
// site of least cost comes first. The next one is the site of least cost among those that lie far enough from
// all sites before it, and so on.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "geometry/surface/ground_plane.h"
#include "numerics/progress.h"
#include "tasks/gravity/gravity_body.h"
#include "tasks/gravity/gravity_table.h"

namespace astrolith {

struct SiteSearch {
  int count = 0;          // of sites, 1 to 1000
  double side = 0.0;      // of a site's square, in the body's unit
  double distance = 0.0;  // between the centres of two sites at least, straight, in the body's unit
};

// Means are over the square, not over the inclined surface.
struct LandingSite {
  double side = 0.0;                    // of the square, body's unit
  Vec3d center;                         // on the mesh, in the body's unit and frame
  GroundAxes axes;                      // `up` is the mean normal of the ground
  double latitude = 0.0;                // of the centre, seen from the frame's origin, degrees
  double longitude = 0.0;               // east from +x, -180 to 180 degrees
  double mean_slope = 0.0;              // degrees
  double largest_slope = 0.0;           // of all facets that reach into the square, degrees
  double roughness = 0.0;               // body's unit
  double cost = 0.0;                    // degrees
  std::vector<std::uint32_t> facets{};  // that reach into the square
};

// The sites, best first; fewer than asked for where the body has no more. Their centres are centres of
// facets; of a mesh with many facets a site, only every so many facets are tried. Ground whose square is not
// covered once, as at an overhang, is no site. `slopes` has the slope of each facet in degrees. Throws
// InputError for a side of less than 4 mean edges or above a quarter of the body's diagonal, and WorkError
// where progress asks to stop.
std::vector<LandingSite> find_landing_sites(const GravityBody& body, std::span<const double> slopes,
                                            const SiteSearch& search, const Progress& progress);

// "X Y Z L", as synth's --patch takes it, in the body's unit.
std::string patch_words(const LandingSite& site);

// One object for each site, for the summary. The centre is in the body's unit, the roughness in metres.
nlohmann::ordered_json sites_json(std::span<const LandingSite> sites, const GravityBody& body);

}  // namespace astrolith
