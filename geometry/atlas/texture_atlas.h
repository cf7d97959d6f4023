// An atlas: the charts of a surface, side by side in one square image.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/atlas/texture_coordinates.h"

namespace astrolith {

struct RectangleSize {
  int width, height;
};
struct RectanglePlace {
  int x = 0, y = 0;  // of the corner next to (0, 0)
};

// (#sizes) Places that do not overlap in a square of `side`; none where the rectangles do not fit. The
// highest rectangles come first, each as low as the outline of those before it allows (a skyline, "bottom
// left"). The result depends on sizes and order alone.
std::optional<std::vector<RectanglePlace>> pack_rectangles(std::span<const RectangleSize> sizes, int side);

// Empty texels on every side of a chart. Charts are twice as far apart.
inline constexpr int kChartPadding = 4;

struct TextureAtlas {
  TextureCoordinates coordinates;
  std::vector<std::uint32_t> triangle_chart;  // (#F)
  // (#charts) The rectangle of each chart with its padding, in texels.
  std::vector<RectanglePlace> places;
  std::vector<RectangleSize> sizes;
  int side = 0;        // of the image, texels
  double texel = 0.0;  // side of a texel where the surface faces its chart's axis, length units of the mesh
};

// Lays the charts of surface_charts() out in an image of side x side texels, as large as they fit; where they
// do not, the side is doubled up to `most_side`. All charts have one scale. A textured vertex at (x, y)
// texels from the image's top left corner has u = x / side and v = y / side. Throws InputError, which begins
// with `name`, where the charts do not fit with a texel for each mean edge.
TextureAtlas make_texture_atlas(const TriangleMesh& mesh, int side, const std::string& name,
                                int most_side = 0);

// How an atlas distorts: the ratio of the singular values of each triangle's map from the surface to the
// image, 1 for none. Triangles without area are left out.
struct AtlasStretch {
  double mean = 1.0, p99 = 1.0, largest = 1.0;
  double filled = 0.0;  // share of the image that triangles fill
};
AtlasStretch atlas_stretch(const TriangleMesh& mesh, const TextureCoordinates& coordinates);

}  // namespace astrolith
