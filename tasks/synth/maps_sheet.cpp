#include "tasks/synth/maps_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "numerics/srgb.h"
#include "synthesis/picture/figure.h"
#include "synthesis/picture/preview.h"

namespace astrolith {
namespace {

constexpr int kPanel = 256, kCaption = 24;  // pixels
constexpr std::array<const char*, MapsSheet::kColumns> kCaptions{
    "finest mesh", "coarsest mesh", "with its maps", "normal", "height", "occlusion", "curvature", "color"};

// A channel of a map of bytes, between the centres of texels.
float sample(const std::vector<std::uint8_t>& map, int side, std::size_t channels, std::size_t channel,
             const std::array<float, 2>& uv) {
  const auto last = static_cast<float>(side - 1);
  const float x = std::clamp(uv[0] * static_cast<float>(side) - 0.5f, 0.0f, last);
  const float y = std::clamp(uv[1] * static_cast<float>(side) - 0.5f, 0.0f, last);
  const int column = std::min(static_cast<int>(x), side - 2), row = std::min(static_cast<int>(y), side - 2);
  const auto at = [&](int dx, int dy) {
    const auto texel = static_cast<std::size_t>(row + dy) * static_cast<std::size_t>(side) +
                       static_cast<std::size_t>(column + dx);
    return static_cast<float>(map[channels * texel + channel]);
  };
  const float s = x - static_cast<float>(column), t = y - static_cast<float>(row);
  return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
}

// Looks up maps as an engine does (BakedMaps, MikkTSpace).
SurfaceMaps look_up(const TriangleMesh& mesh, const MeshSkin& skin, const BakedMaps& maps) {
  return [&](std::uint32_t triangle, float u, float v) {
    const TextureCoordinates& coordinates = skin.coordinates;
    const std::array<float, 3> weights{1.0f - u - v, u, v};
    std::array<float, 2> uv{};
    Vec3f normal, tangent;
    float sign = 1.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = coordinates.triangles[triangle][k];
      const VertexTangent& along = skin.tangents[corner];
      for (std::size_t i = 0; i < 2; ++i) uv[i] += weights[k] * coordinates.uv[corner][i];
      normal += weights[k] * to_float(mesh.normals[coordinates.mesh_vertex[corner]]);
      tangent += weights[k] * Vec3f{along[0], along[1], along[2]};
      sign = along[3];
    }
    const auto axis = [&](std::size_t k) { return sample(maps.normal, maps.side, 3, k, uv) / 127.5f - 1.0f; };
    const Vec3f bitangent = sign * cross(normal, tangent);
    MappedPlace place{normalized(axis(0) * tangent + axis(1) * bitangent + axis(2) * normal)};
    place.open = sample(maps.occlusion, maps.side, 1, 0, uv) / 255.0f;
    if (maps.color.empty()) return place;
    const auto linear = [&](std::size_t k) {
      return static_cast<float>(srgb_to_linear(double{sample(maps.color, maps.side, 3, k, uv)} / 255.0));
    };
    place.albedo = Vec3f{linear(0), linear(1), linear(2)};
    return place;
  };
}

RgbImage draw_panel(const TriangleMesh& mesh, SurfaceMaps maps) {
  PreviewOptions options;
  options.width = options.height = kPanel;
  options.views = {standard_views().back()};
  options.maps = std::move(maps);
  options.vertex_colors = linear_colors(mesh);
  return render_preview(mesh, options);
}

// The mean of each pixel's texels; `byte` gives a channel of a texel.
template <class Byte>
RgbImage reduced(int side, const Byte& byte) {
  RgbImage image{kPanel, kPanel, {}};
  const auto begin = [side](int pixel) { return pixel * side / kPanel; };
  for (int y = 0; y < kPanel; ++y) {
    for (int x = 0; x < kPanel; ++x) {
      const int x1 = std::max(begin(x) + 1, begin(x + 1)), y1 = std::max(begin(y) + 1, begin(y + 1));
      for (std::size_t k = 0; k < 3; ++k) {
        std::int64_t sum = 0;
        for (int row = begin(y); row < y1; ++row) {
          for (int column = begin(x); column < x1; ++column)
            sum += byte(static_cast<std::size_t>(row) * static_cast<std::size_t>(side) +
                            static_cast<std::size_t>(column),
                        k);
        }
        image.pixels.push_back(static_cast<std::uint8_t>(sum / ((x1 - begin(x)) * (y1 - begin(y)))));
      }
    }
  }
  return image;
}

}  // namespace

void MapsSheet::add(std::uint64_t member, std::size_t level, std::size_t levels, const TriangleMesh& mesh,
                    const MeshSkin& skin, const BakedMaps& maps) {
  Row made;
  if (level == 0) made[kFinest] = draw_panel(mesh, {});
  if (level + 1 == levels) {
    const auto grey = [&](const auto& map, int step) {
      return reduced(maps.side, [&map, step](std::size_t texel, std::size_t) { return map[texel] / step; });
    };
    const auto rgb = [&](const std::vector<std::uint8_t>& map) {
      return reduced(maps.side, [&map](std::size_t texel, std::size_t k) { return map[3 * texel + k]; });
    };
    made[kCoarsest] = draw_panel(mesh, {});
    made[kMapped] = draw_panel(mesh, look_up(mesh, skin, maps));
    made[kNormal] = rgb(maps.normal);
    made[kHeight] = grey(maps.height, 257);
    made[kOcclusion] = grey(maps.occlusion, 1);
    made[kCurvature] = grey(maps.curvature, 1);
    if (!maps.color.empty()) made[kColor] = rgb(maps.color);
  }
  const std::lock_guard lock(mutex_);
  Row& row = rows_[member];
  for (std::size_t k = 0; k < kColumns; ++k) {
    if (made[k].width > 0) row[k] = std::move(made[k]);
  }
}

void MapsSheet::write(const std::filesystem::path& file) const {
  if (rows_.empty()) return;
  const bool has_color =
      std::ranges::any_of(rows_, [](const auto& row) { return row.second[kColor].width > 0; });
  const int columns = has_color ? kColumns : kColumns - 1, rows = static_cast<int>(rows_.size());
  const Rectangle all{0.0, 0.0, double{kPanel} * columns, double{kCaption} + double{kPanel} * rows};
  constexpr double kText = 16.0;
  Figure sheet(all.width, all.height);
  sheet.fill(all, {0.0, 0.0, 0.0});
  const auto caption = [&](double left, double top, const std::string& words) {
    sheet.text(left + 6.0, top + kText, words, kText, Figure::Align::kLeft, false, {1.0, 1.0, 1.0});
  };
  double top = kCaption;
  for (const auto& [member, row] : rows_) {
    for (int k = 0; k < columns; ++k) {
      const RgbImage& panel = row[static_cast<std::size_t>(k)];
      if (panel.width > 0) sheet.picture({double{kPanel} * k, top, kPanel, kPanel}, panel, false);
    }
    if (rows > 1) caption(0.0, top + 4.0, std::to_string(member));
    top += kPanel;
  }
  for (int k = 0; k < columns; ++k) caption(double{kPanel} * k, 3.0, kCaptions[static_cast<std::size_t>(k)]);
  sheet.write_png(file, 72.0);
}

}  // namespace astrolith
