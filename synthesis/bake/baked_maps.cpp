#include "synthesis/bake/baked_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "numerics/reported_loop.h"
#include "synthesis/bake/map_borders.h"
#include "synthesis/bake/texel_occlusion.h"
#include "synthesis/bake/texel_surface.h"

namespace astrolith {
namespace {

constexpr float kTightestCurve = 4.0f;  // texels: the radius at the ends of the map of curvature

std::uint8_t byte_of_share(float value) {  // of -1 .. 1
  return static_cast<std::uint8_t>(127.5f + 127.5f * std::clamp(value, -1.0f, 1.0f) + 0.5f);
}

// The normal in the frame of a texel: the solution of x t + y b + z n = m by Cramer's rule, made unit. It
// points out of the mesh's own surface, however steep the detail is.
Vec3f in_tangent_space(const TexelPlace& texel, const Vec3f& m) {
  const Vec3f &n = texel.normal, &t = texel.tangent;
  const Vec3f b = cross(n, t) * texel.sign;
  const float volume = dot(cross(t, b), n);
  if (volume == 0.0f) return {0.0f, 0.0f, 1.0f};
  const float side = volume > 0.0f ? 1.0f : -1.0f;
  Vec3f v = Vec3f{dot(m, cross(b, n)), dot(m, cross(n, t)), dot(m, cross(t, b))} * side;
  constexpr float kLeastRise = 0.02f;
  v.z = std::max(v.z, kLeastRise * norm(v));
  const Vec3f unit = normalized(v);
  return unit == Vec3f{} ? Vec3f{0.0f, 0.0f, 1.0f} : unit;
}

// A tile at work: its texels, and the points of those that are covered.
struct TileWork {
  std::array<TexelPlace, TexelTile::kMostTexels> places;
  std::array<std::int16_t, TexelTile::kMostTexels> number;  // of a texel's point; -1: not covered
  std::vector<SurfacePoint> points;
  std::vector<MeshVertex> vertices;  // whose layers are looked up
  std::vector<VertexLabel> labels;
  std::vector<std::int16_t> label_of;  // the label of each point
  std::vector<VertexColor> colors;
};

class MapBaker {
 public:
  MapBaker(const BakeSources& sources, const TexturedMesh& textured)
      : sources_(sources),
        side_(textured.atlas.side),
        texel_(static_cast<float>(textured.atlas.texel)),
        texels_(textured),
        occlusion_(sources.occluder.mesh, sources.occluder.cell),
        heights_(num_texels()),
        open_(num_texels(), kNotCovered) {
    maps_.side = side_;
    maps_.normal.resize(3 * num_texels());
    for (std::size_t i = 0; i < num_texels(); ++i)
      maps_.normal[3 * i] = 128, maps_.normal[3 * i + 1] = 128, maps_.normal[3 * i + 2] = 255;
    maps_.curvature.assign(num_texels(), 128);
    maps_.curvature_radius = kTightestCurve * double{texel_};
    maps_.label.assign(num_texels(), 0);
    if (sources.colors != nullptr) {
      maps_.color.resize(3 * num_texels());
      for (std::size_t i = 0; i < maps_.color.size(); ++i) maps_.color[i] = kBareColor[i % 3];
    }
  }

  BakedMaps result(const Progress& progress) {
    const auto count = static_cast<std::int64_t>(texels_.tiles().size());
    missed_.resize(static_cast<std::size_t>(count));
    reported_parallel_for({0, count, count}, progress, "bake", [&](std::int64_t i) {
      bake(texels_.tiles()[static_cast<std::size_t>(i)], missed_[static_cast<std::size_t>(i)]);
    });
    finish();
    return std::move(maps_);
  }

 private:
  std::size_t num_texels() const { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x);
  }

  void bake(const TexelTile& tile, std::int64_t& missed) {
    // Not kept for a thread: layers are looked up in loops of their own, in which it may begin another tile.
    const auto owned = std::make_unique<TileWork>();
    TileWork& work = *owned;
    texels_.places_of(tile, {work.places.data(), tile.num_texels()});
    work.points.clear();
    for (std::size_t i = 0; i < tile.num_texels(); ++i) {
      const TexelPlace& place = work.places[i];
      work.number[i] = place.is_covered ? static_cast<std::int16_t>(work.points.size()) : std::int16_t{-1};
      if (place.is_covered)
        work.points.push_back({place.position, normalized(place.normal), 0.0f, {}, false});
    }
    if (work.points.empty()) return;
    const TexelGrid grid{{work.number.data(), tile.num_texels()}, tile.padded_width()};
    find_surface(sources_.field, texel_, grid, work.points);
    look_up_layers(tile, work);
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x) missed += store(tile, work, x, y);
    }
  }

  // A label stands for a square of 2 x 2 texels: that of its first covered one. Colours are of each texel.
  void look_up_layers(const TexelTile& tile, TileWork& work) const {
    work.vertices.clear();
    work.label_of.resize(work.points.size());
    std::array<std::int16_t, TexelTile::kMostTexels> of_square;
    of_square.fill(-1);
    for (std::size_t i = 0; i < tile.num_texels(); ++i) {
      if (work.number[i] < 0) continue;
      const auto point = static_cast<std::size_t>(work.number[i]);
      const auto row = static_cast<std::size_t>(tile.padded_width());
      std::int16_t& known = of_square[(i / row / 2) * row + (i % row) / 2];
      if (known < 0) {
        known = static_cast<std::int16_t>(work.vertices.size());
        work.vertices.push_back({work.points[point].place(), work.points[point].normal});
      }
      work.label_of[point] = known;
    }
    work.labels.resize(work.vertices.size());
    sources_.labels.label({}, work.vertices, work.labels);
    if (sources_.colors == nullptr) return;
    work.vertices.clear();
    for (const SurfacePoint& p : work.points) work.vertices.push_back({p.place(), p.normal});
    work.colors.resize(work.vertices.size());
    sources_.colors->paint({}, work.vertices, work.colors);
  }

  // Stores column x and row y of a tile. Returns 1 where no surface was met.
  int store(const TexelTile& tile, const TileWork& work, int x, int y) {
    const auto at = static_cast<std::size_t>((y + 1) * tile.padded_width() + x + 1);
    if (work.number[at] < 0) return 0;
    const auto number = static_cast<std::size_t>(work.number[at]);
    const SurfacePoint& point = work.points[number];
    const std::size_t i = index(tile.x + x, tile.y + y);
    const Vec3f v = in_tangent_space(work.places[at], point.normal);
    maps_.normal[3 * i] = byte_of_share(v.x);
    maps_.normal[3 * i + 1] = byte_of_share(v.y);
    maps_.normal[3 * i + 2] = byte_of_share(v.z);
    heights_[i] = point.height;
    open_[i] = occlusion_.is_open(tile.x + x, tile.y + y, point.place(), point.normal) ? 1 : 0;
    maps_.curvature[i] = curvature_byte(work, at, static_cast<std::size_t>(tile.padded_width()));
    const VertexLabel& label = work.labels[static_cast<std::size_t>(work.label_of[number])];
    maps_.label[i] = static_cast<std::uint8_t>(std::min(label.label, 255));
    if (sources_.colors != nullptr) std::copy_n(work.colors[number].begin(), 3, &maps_.color[3 * i]);
    return point.is_found ? 0 : 1;
  }

  // Twice the mean curvature is the sum of those along both axes of the texture: dn . dp / |dp|^2.
  std::uint8_t curvature_byte(const TileWork& work, std::size_t at, std::size_t row) const {
    const float sum =
        curvature_along(work, at - 1, at, at + 1) + curvature_along(work, at - row, at, at + row);
    const float share = 0.5f * sum * kTightestCurve * texel_;
    return static_cast<std::uint8_t>(128.0f + 127.0f * std::clamp(share, -1.0f, 1.0f) + 0.5f);
  }

  static float curvature_along(const TileWork& work, std::size_t before, std::size_t at, std::size_t after) {
    const auto point = [&](std::size_t texel) {
      return work.points[static_cast<std::size_t>(work.number[work.number[texel] < 0 ? at : texel])];
    };
    const SurfacePoint a = point(before), b = point(after);
    const Vec3f way = b.place() - a.place();
    const float length = squared_norm(way);
    return length > 0.0f ? dot(b.normal - a.normal, way) / length : 0.0f;
  }

  void finish() {
    std::vector<std::uint8_t> covered(num_texels());
    float low = std::numeric_limits<float>::max(), high = -low;
    for (std::size_t i = 0; i < covered.size(); ++i) {
      if (open_[i] == kNotCovered) continue;
      covered[i] = 1;
      ++maps_.covered;
      low = std::min(low, heights_[i]), high = std::max(high, heights_[i]);
    }
    for (const std::int64_t missed : missed_) maps_.missed += missed;
    maps_.occlusion = blurred_occlusion(open_, side_);
    open_ = {};
    maps_.lowest = low, maps_.highest = high;
    const float range = high > low ? high - low : 1.0f, middle = std::clamp(0.0f, low, high);
    maps_.height.resize(num_texels());
    for (std::size_t i = 0; i < covered.size(); ++i) {
      const float height = covered[i] != 0 ? heights_[i] : middle;
      maps_.height[i] = static_cast<std::uint16_t>(65535.0f * ((height - low) / range) + 0.5f);
    }
    heights_ = {};
    const std::vector<BorderCopy> copies = border_copies(covered, side_, kChartPadding);
    fill_borders<std::uint8_t>(copies, 3, maps_.normal);
    fill_borders<std::uint16_t>(copies, 1, maps_.height);
    fill_borders<std::uint8_t>(copies, 1, maps_.occlusion);
    fill_borders<std::uint8_t>(copies, 1, maps_.curvature);
    fill_borders<std::uint8_t>(copies, 1, maps_.label);
    if (sources_.colors != nullptr) fill_borders<std::uint8_t>(copies, 3, maps_.color);
  }

  const BakeSources& sources_;
  int side_;
  float texel_;
  AtlasTexels texels_;
  TexelOcclusion occlusion_;
  BakedMaps maps_;
  std::vector<float> heights_;        // length units
  std::vector<std::uint8_t> open_;    // 1: the ray leaves the body; or kNotCovered
  std::vector<std::int64_t> missed_;  // by tile
};

}  // namespace

BakedMaps bake_maps(const BakeSources& sources, const TexturedMesh& textured, const Progress& progress) {
  return MapBaker(sources, textured).result(progress);
}

}  // namespace astrolith
