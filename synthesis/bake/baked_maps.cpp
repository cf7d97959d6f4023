#include "synthesis/bake/baked_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "numerics/parallel_for.h"
#include "numerics/portable_angles.h"
#include "numerics/reported_loop.h"
#include "numerics/tangent_frame.h"
#include "numerics/vec3.h"
#include "synthesis/bake/texel_surface.h"
#include "synthesis/picture/ray_scene.h"

namespace astrolith {
namespace {

struct TexelStep {
  int x, y;
};
constexpr std::array<TexelStep, 8> kTexelSteps{
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};

// The 64 texels of a square of 8 x 8 have a direction each, and a blur over such a square adds all 64: each
// direction counts as often as any other (interleaved sampling, Keller and Heidrich 2001).
class TexelOcclusion {
 public:
  static constexpr int kPattern = 8;

  // `mesh` has cells of this side, length units. Rays start three quarters of a cell above the surface, since
  // the mesh does not follow details that are smaller.
  TexelOcclusion(const TriangleMesh& mesh, double cell);

  // Whether the ray of texel (x, y) leaves the body. Directions have the density of the cosine about the
  // normal.
  bool is_unoccluded(int x, int y, const Vec3f& place, const Vec3f& normal) const;

 private:
  RayScene scene_;
  float offset_;                   // length units
  std::vector<Vec3f> directions_;  // (kPattern x kPattern) about +z
};

constexpr std::uint8_t kNotCovered = 255;

// Directions about +z with the density of the cosine: points of Hammersley's set on the disk, lifted to the
// sphere (Malley).
std::vector<Vec3f> cosine_directions(int count) {
  std::vector<Vec3f> directions;
  for (int i = 0; i < count; ++i) {
    double radical = 0.0, share = 0.5;  // base 2
    for (int bits = i; bits > 0; bits >>= 1, share *= 0.5) radical += (bits & 1) * share;
    const double r = std::sqrt((i + 0.5) / count);
    const auto [sine, cosine] = portable::sine_and_cosine(2.0 * std::numbers::pi * radical);
    directions.push_back(to_float({r * cosine, r * sine, std::sqrt(1.0 - r * r)}));
  }
  return directions;
}

TexelOcclusion::TexelOcclusion(const TriangleMesh& mesh, double cell)
    : scene_(mesh),
      offset_(static_cast<float>(0.75 * cell)),
      directions_(cosine_directions(kPattern * kPattern)) {}

bool TexelOcclusion::is_unoccluded(int x, int y, const Vec3f& place, const Vec3f& normal) const {
  const auto number = static_cast<std::size_t>((y % kPattern) * kPattern + x % kPattern);
  const Vec3f above = place + normal * offset_, &d = directions_[number];
  const Vec3f origin = to_float(scene_.to_unit({double{above.x}, double{above.y}, double{above.z}}));
  const Tangents<float> frame = duff_tangents<SumRounding::kTwice>(normal, std::copysign(1.0f, normal.z));
  return !scene_.occluded(origin, frame.first * d.x + frame.second * d.y + normal * d.z);
}

// The share of open rays about each texel, 255 for all, over the covered texels of a square of 8 x 8.
// `unoccluded` is 1 where the ray of a texel leaves the body, and kNotCovered where it has none. Both (side x
// side). Charts are 8 texels apart, so that the square holds texels of one chart only.
std::vector<std::uint8_t> ambient_occlusion(std::span<const std::uint8_t> unoccluded, int side) {
  // Half weights at both ends give each place of the pattern the weight 1 along a row.
  constexpr int kReach = TexelOcclusion::kPattern / 2;
  constexpr std::array<int, 2 * kReach + 1> kWeights{1, 2, 2, 2, 2, 2, 2, 2, 1};
  std::vector<std::uint8_t> shares(unoccluded.size(), 255);
  const auto at = [side](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
  };
  parallel_for(0, side, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < side; ++x) {
      if (unoccluded[at(x, y)] == kNotCovered) continue;
      int sum = 0, weights = 0;
      for (int j = std::max(y - kReach, 0); j <= std::min(y + kReach, side - 1); ++j) {
        for (int i = std::max(x - kReach, 0); i <= std::min(x + kReach, side - 1); ++i) {
          const int value = unoccluded[at(i, j)];
          if (value == kNotCovered) continue;
          const int weight = kWeights[static_cast<std::size_t>(i - x + kReach)] *
                             kWeights[static_cast<std::size_t>(j - y + kReach)];
          sum += weight * value, weights += weight;
        }
      }
      shares[at(x, y)] = static_cast<std::uint8_t>((255 * sum + weights / 2) / std::max(weights, 1));
    }
  });
  return shares;
}

constexpr float kTightestCurve = 4.0f;  // texels: the radius at the ends of the map of curvature

std::uint8_t share_to_byte(float value) {  // of -1 .. 1
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
  std::vector<std::int16_t> point_labels;  // the label of each point
  std::vector<VertexColor> colors;
  std::vector<Vec3f> albedo;
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
        unoccluded_(num_texels(), kNotCovered) {
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
    if (has_albedo()) maps_.albedo.resize(3 * num_texels());
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
  bool has_albedo() const { return sources_.colors != nullptr && sources_.colors->has_albedo(); }
  static std::uint16_t sixteen_bits(float share) {
    return static_cast<std::uint16_t>(65535.0f * std::clamp(share, 0.0f, 1.0f) + 0.5f);
  }
  std::size_t num_texels() const { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x);
  }

  void bake(const TexelTile& tile, std::int64_t& missed) {
    // Not kept for a thread: layers are looked up in loops of their own, in which it may begin another tile.
    const auto owned = std::make_unique<TileWork>();
    TileWork& work = *owned;
    texels_.locate(tile, {work.places.data(), tile.num_texels()});
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
    work.point_labels.resize(work.points.size());
    std::array<std::int16_t, TexelTile::kMostTexels> first_texels;
    first_texels.fill(-1);
    for (std::size_t i = 0; i < tile.num_texels(); ++i) {
      if (work.number[i] < 0) continue;
      const auto point = static_cast<std::size_t>(work.number[i]);
      const auto row = static_cast<std::size_t>(tile.padded_width());
      std::int16_t& known = first_texels[(i / row / 2) * row + (i % row) / 2];
      if (known < 0) {
        known = static_cast<std::int16_t>(work.vertices.size());
        work.vertices.push_back({work.points[point].place(), work.points[point].normal});
      }
      work.point_labels[point] = known;
    }
    work.labels.resize(work.vertices.size());
    sources_.labels.label({}, work.vertices, work.labels);
    if (sources_.colors == nullptr) return;
    work.vertices.clear();
    for (const SurfacePoint& p : work.points) work.vertices.push_back({p.place(), p.normal});
    work.colors.resize(work.vertices.size());
    if (!has_albedo()) return sources_.colors->paint({}, work.vertices, work.colors);
    work.albedo.resize(work.vertices.size());
    sources_.colors->find_albedo({}, work.vertices, work.albedo);
    for (std::size_t i = 0; i < work.albedo.size(); ++i)
      work.colors[i] = sources_.colors->for_viewing(work.albedo[i]);
  }

  // Stores column x and row y of a tile. Returns 1 where no surface was met.
  int store(const TexelTile& tile, const TileWork& work, int x, int y) {
    const auto at = static_cast<std::size_t>((y + 1) * tile.padded_width() + x + 1);
    if (work.number[at] < 0) return 0;
    const auto number = static_cast<std::size_t>(work.number[at]);
    const SurfacePoint& point = work.points[number];
    const std::size_t i = index(tile.x + x, tile.y + y);
    const Vec3f v = in_tangent_space(work.places[at], point.normal);
    maps_.normal[3 * i] = share_to_byte(v.x);
    maps_.normal[3 * i + 1] = share_to_byte(v.y);
    maps_.normal[3 * i + 2] = share_to_byte(v.z);
    heights_[i] = point.height;
    unoccluded_[i] = occlusion_.is_unoccluded(tile.x + x, tile.y + y, point.place(), point.normal) ? 1 : 0;
    maps_.curvature[i] = curvature_byte(work, at, static_cast<std::size_t>(tile.padded_width()));
    const VertexLabel& label = work.labels[static_cast<std::size_t>(work.point_labels[number])];
    maps_.label[i] = static_cast<std::uint8_t>(std::min(label.label, 255));
    if (sources_.colors != nullptr) std::copy_n(work.colors[number].begin(), 3, &maps_.color[3 * i]);
    if (has_albedo()) {
      const Vec3f& albedo = work.albedo[number];
      maps_.albedo[3 * i] = sixteen_bits(albedo.x);
      maps_.albedo[3 * i + 1] = sixteen_bits(albedo.y);
      maps_.albedo[3 * i + 2] = sixteen_bits(albedo.z);
    }
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
      if (unoccluded_[i] == kNotCovered) continue;
      covered[i] = 1;
      ++maps_.covered;
      low = std::min(low, heights_[i]), high = std::max(high, heights_[i]);
    }
    for (const std::int64_t missed : missed_) maps_.missed += missed;
    maps_.occlusion = ambient_occlusion(unoccluded_, side_);
    unoccluded_ = {};
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
    if (has_albedo()) fill_borders<std::uint16_t>(copies, 3, maps_.albedo);
  }

  const BakeSources& sources_;
  int side_;
  float texel_;
  AtlasTexels texels_;
  TexelOcclusion occlusion_;
  BakedMaps maps_;
  std::vector<float> heights_;            // length units
  std::vector<std::uint8_t> unoccluded_;  // 1: the ray leaves the body; or kNotCovered
  std::vector<std::int64_t> missed_;      // by tile
};

}  // namespace

std::vector<BorderCopy> border_copies(std::span<const std::uint8_t> covered, int side, int reach) {
  const auto width = static_cast<std::size_t>(side);
  std::vector<std::uint8_t> known(covered.begin(), covered.end());
  const auto neighbour = [&](std::size_t texel, const TexelStep& step) -> std::optional<std::size_t> {
    const int x = static_cast<int>(texel % width) + step.x, y = static_cast<int>(texel / width) + step.y;
    if (x < 0 || y < 0 || x >= side || y >= side) return std::nullopt;
    return static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
  };
  // The texels that the next ring grows from: at first those at the edge of what is covered.
  std::vector<BorderCopy> copies, last;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] == 0) continue;
    for (const TexelStep& step : kTexelSteps) {
      const auto at = neighbour(i, step);
      if (!at || known[*at] != 0) continue;
      last.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i)});
      break;
    }
  }
  for (int ring = 0; ring < reach; ++ring) {
    std::vector<BorderCopy> next;
    for (const TexelStep& step : kTexelSteps) {
      for (const BorderCopy& source : last) {
        const auto at = neighbour(source.to, {-step.x, -step.y});
        if (!at || known[*at] != 0) continue;
        known[*at] = 1;
        next.push_back({static_cast<std::uint32_t>(*at), source.from});
      }
    }
    copies.insert(copies.end(), next.begin(), next.end());
    last = std::move(next);
  }
  return copies;
}

BakedMaps bake_maps(const BakeSources& sources, const TexturedMesh& textured, const Progress& progress) {
  return MapBaker(sources, textured).result(progress);
}

}  // namespace astrolith
