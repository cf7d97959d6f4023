#include "synthesis/bake/atlas_texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace astrolith {
namespace {

struct TexelPoint {
  double x, y;
};

std::array<TexelPoint, 3> texel_corners(const TextureAtlas& atlas, std::uint32_t triangle) {
  std::array<TexelPoint, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k) {
    const TexturePoint& uv = atlas.coordinates.uv[atlas.coordinates.triangles[triangle][k]];
    corners[k] = {double{uv[0]} * atlas.side, double{uv[1]} * atlas.side};
  }
  return corners;
}

// The texels whose centres lie in a box: first and last column and row.
struct TexelRange {
  int x0, y0, x1, y1;
};

TexelRange covered_texels(const std::array<TexelPoint, 3>& c) {
  const auto first = [](double low) { return static_cast<int>(std::ceil(low - 0.5)); };
  const auto last = [](double high) { return static_cast<int>(std::floor(high - 0.5)); };
  return {first(std::min({c[0].x, c[1].x, c[2].x})), first(std::min({c[0].y, c[1].y, c[2].y})),
          last(std::max({c[0].x, c[1].x, c[2].x})), last(std::max({c[0].y, c[1].y, c[2].y}))};
}

double texel_turn(const TexelPoint& a, const TexelPoint& b, double x, double y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

// The tiles of the charts: those of a chart are numbered row by row from `first`.
struct ChartTiles {
  std::uint32_t first;
  int x, y, columns, rows;
};

}  // namespace

AtlasTexels::AtlasTexels(const TexturedMesh& textured) : textured_(textured) {
  const TextureAtlas& atlas = textured.atlas;
  std::vector<ChartTiles> charts;
  const auto tiles_along = [](int length) { return (length + TexelTile::kSide - 1) / TexelTile::kSide; };
  for (std::size_t c = 0; c < atlas.places.size(); ++c) {
    const auto [x, y] = atlas.places[c];
    const auto [width, height] = atlas.sizes[c];
    charts.push_back(
        {static_cast<std::uint32_t>(tiles_.size()), x, y, tiles_along(width), tiles_along(height)});
    for (int ty = 0; ty < height; ty += TexelTile::kSide) {
      for (int tx = 0; tx < width; tx += TexelTile::kSide) {
        tiles_.push_back({x + tx, y + ty, std::min(TexelTile::kSide, width - tx),
                          std::min(TexelTile::kSide, height - ty), 0, 0});
      }
    }
  }
  // A triangle belongs to the tiles that its box reaches, with their borders.
  const auto for_each_tile = [&](std::uint32_t f, const auto& use) {
    const ChartTiles& chart = charts[atlas.triangle_chart[f]];
    const TexelRange range = covered_texels(texel_corners(atlas, f));
    const auto tile_at = [](int texel, int begin, int count) {
      return std::clamp((texel - begin) / TexelTile::kSide, 0, count - 1);
    };
    for (int j = tile_at(range.y0 - 1, chart.y, chart.rows); j <= tile_at(range.y1 + 1, chart.y, chart.rows);
         ++j) {
      for (int i = tile_at(range.x0 - 1, chart.x, chart.columns);
           i <= tile_at(range.x1 + 1, chart.x, chart.columns); ++i)
        use(chart.first + static_cast<std::uint32_t>(j * chart.columns + i));
    }
  };
  const auto count = static_cast<std::uint32_t>(atlas.coordinates.triangles.size());
  for (std::uint32_t f = 0; f < count; ++f)
    for_each_tile(f, [&](std::uint32_t tile) { ++tiles_[tile].count; });
  std::uint32_t sum = 0;
  for (TexelTile& tile : tiles_) tile.first = sum, sum += tile.count, tile.count = 0;
  triangles_.resize(sum);
  for (std::uint32_t f = 0; f < count; ++f) {
    for_each_tile(f, [&](std::uint32_t tile) { triangles_[tiles_[tile].first + tiles_[tile].count++] = f; });
  }
  std::erase_if(tiles_, [](const TexelTile& tile) { return tile.count == 0; });
}

void AtlasTexels::locate(const TexelTile& tile, std::span<TexelPlace> places) const {
  std::fill(places.begin(), places.end(), TexelPlace{});
  for (std::uint32_t k = 0; k < tile.count; ++k) draw(triangles_[tile.first + k], tile, places);
}

void AtlasTexels::draw(std::uint32_t triangle, const TexelTile& tile, std::span<TexelPlace> places) const {
  const std::array<TexelPoint, 3> c = texel_corners(textured_.atlas, triangle);
  const double area = texel_turn(c[0], c[1], c[2].x, c[2].y);
  if (area == 0.0) return;
  const TexelRange range = covered_texels(c);
  const Triangle& corners = textured_.atlas.coordinates.triangles[triangle];
  for (int y = std::max(range.y0, tile.y - 1); y <= std::min(range.y1, tile.y + tile.height); ++y) {
    for (int x = std::max(range.x0, tile.x - 1); x <= std::min(range.x1, tile.x + tile.width); ++x) {
      TexelPlace& place =
          places[static_cast<std::size_t>((y - tile.y + 1) * tile.padded_width() + x - tile.x + 1)];
      if (place.is_covered) continue;
      const double px = x + 0.5, py = y + 0.5;
      const std::array<double, 3> weights{texel_turn(c[1], c[2], px, py) / area,
                                          texel_turn(c[2], c[0], px, py) / area,
                                          texel_turn(c[0], c[1], px, py) / area};
      if (std::min({weights[0], weights[1], weights[2]}) < 0.0) continue;
      Vec3d position, normal, tangent;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t w = corners[k], v = textured_.atlas.coordinates.mesh_vertex[w];
        const VertexTangent& t = textured_.tangents[w];
        position += weights[k] * textured_.mesh.vertices[v];
        normal += weights[k] * textured_.mesh.normals[v];
        tangent += weights[k] * Vec3d{double{t[0]}, double{t[1]}, double{t[2]}};
      }
      place = {true, to_float(position), to_float(normal), to_float(tangent),
               textured_.tangents[corners[0]][3]};
    }
  }
}

}  // namespace astrolith
