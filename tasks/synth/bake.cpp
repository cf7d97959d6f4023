#include "tasks/synth/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "geometry/atlas/texture_atlas.h"
#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/parallel_for.h"
#include "synthesis/bake/baked_maps.h"
#include "synthesis/mesh/sample_grid.h"
#include "synthesis/picture/image_file.h"
#include "tasks/job/output_names.h"
#include "tasks/synth/detail_levels.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// The image for which charts are padded where no maps are baked.
constexpr int kUsualMap = 2048;
constexpr int kCoarseMap = 128;  // below, seams of charts show on levels of detail
constexpr std::array<const char*, 7> kMapWords{"normal", "height", "occlusion", "curvature",
                                               "label",  "color",  "albedo"};

int level_side(const MeshSinks& sinks, std::size_t level) {
  const int side = sinks.bake > 0 ? sinks.bake : kUsualMap;
  return std::max(side >> level, kLeastMap);
}

// Where no maps are baked, the image is as large as the charts need.
TextureAtlas make_level_atlas(const TriangleMesh& mesh, const MeshSinks& sinks, std::size_t level) {
  const int side = level_side(sinks, level);
  return sinks.bake > 0 ? make_texture_atlas(mesh, side, "--bake")
                        : make_texture_atlas(mesh, side, "--uv", kMostMap);
}

fs::path map_file(const fs::path& output, std::size_t level, const std::string& word) {
  const std::string lod = level == 0 ? "" : "_lod" + std::to_string(level);
  return output.parent_path() / (output.stem().string() + lod + "_" + word + ".png");
}

// The mesh to which rays of the occlusion go: its cells are four texels of the finest maps wide.
class Occluder {
 public:
  Occluder(Job& job, const MeshPart& finest, double texel) {
    constexpr int kMostCells = 640;
    constexpr double kTexelsPerCell = 4.0;
    const double longest = finest.field.bounds().longest_side();
    MeshSpec plain = finest.spec;
    plain.even = false;
    const MeshPart part{plain, finest.recipe, finest.file, finest.region, finest.field, 0, finest.device};
    const int cells =
        std::clamp(static_cast<int>(longest / (kTexelsPerCell * texel)), kMinResolution, kMostCells);
    cell_ = make_body_mesh(part.with_cells(cells), collector_, job.stages()).statistics.step;
  }

  BakeOccluder get() const { return {collector_.mesh, cell_}; }

 private:
  MeshCollector collector_;
  double cell_ = 0.0;
};

struct EncodedMap {
  const char* word;
  std::function<std::string()> encode;
  std::string png = {};
};

// Encodes the maps side by side.
std::vector<EncodedMap> encoded_maps(const BakedMaps& maps) {
  const auto bytes = [side = maps.side](const std::vector<std::uint8_t>& values, int channels) {
    return [&values, side, channels] { return encode_png(values, side, side, channels); };
  };
  std::vector<EncodedMap> all{{"normal", bytes(maps.normal, 3)},
                              {"height", [&maps] { return encode_png(maps.height, maps.side, maps.side); }},
                              {"occlusion", bytes(maps.occlusion, 1)},
                              {"curvature", bytes(maps.curvature, 1)},
                              {"label", bytes(maps.label, 1)}};
  if (!maps.color.empty()) all.push_back({"color", bytes(maps.color, 3)});
  if (!maps.albedo.empty())
    all.push_back({"albedo", [&maps] { return encode_png(maps.albedo, maps.side, maps.side, 3); }});
  parallel_for(0, static_cast<std::int64_t>(all.size()), [&](std::int64_t i) {
    EncodedMap& map = all[static_cast<std::size_t>(i)];
    map.png = map.encode();
  });
  return all;
}

nlohmann::ordered_json map_figures(const BakedMaps& maps) {
  return {{"side", maps.side},
          {"height_lowest", maps.lowest},
          {"height_highest", maps.highest},
          {"curvature_radius", maps.curvature_radius},
          {"covered_texels", maps.covered},
          {"missed_texels", maps.missed}};
}

// The use of a map in a material; none for maps that glTF has no place for.
std::optional<SkinMap::Use> find_map_use(const std::string& word) {
  if (word == "normal") return SkinMap::Use::kNormal;
  if (word == "occlusion") return SkinMap::Use::kOcclusion;
  if (word == "color") return SkinMap::Use::kBaseColor;
  return std::nullopt;
}

bool has_material_file(const fs::path& mesh) { return mesh_extension(mesh) == ".obj"; }

void add_maps(Job& job, const fs::path& mesh, std::size_t level, const BakedMaps& maps, MeshSkin& skin) {
  nlohmann::ordered_json figures = map_figures(maps);
  auto files = nlohmann::ordered_json::object();
  if (has_material_file(mesh))
    files["material"] = material_file(level_file(mesh, static_cast<int>(level))).filename().string();
  for (EncodedMap& map : encoded_maps(maps)) {
    const fs::path file = map_file(mesh, level, map.word);
    write_file(file, map.png);
    files[map.word] = file.filename().string();
    if (const auto use = find_map_use(map.word))
      skin.maps.push_back({*use, file.stem().string(), std::move(map.png)});
  }
  figures["files"] = std::move(files);
  job.summary["maps"].push_back(std::move(figures));
}

nlohmann::ordered_json atlas_figures(const TextureAtlas& atlas, const AtlasStretch& stretch) {
  return {{"charts", atlas.places.size()}, {"side", atlas.side},
          {"texel", atlas.texel},          {"padding", kChartPadding},
          {"filled", stretch.filled},      {"stretch_mean", stretch.mean},
          {"stretch_p99", stretch.p99},    {"stretch_largest", stretch.largest}};
}

}  // namespace

std::vector<fs::path> map_files(const fs::path& mesh, const MeshSinks& sinks) {
  std::vector<fs::path> files;
  for (int level = 0; sinks.bake > 0 && level < sinks.levels; ++level) {
    for (const char* word : kMapWords) files.push_back(map_file(mesh, static_cast<std::size_t>(level), word));
    if (has_material_file(mesh)) files.push_back(material_file(level_file(mesh, level)));
  }
  return files;
}

void add_skins(Job& job, const MeshSinks& sinks, const MeshPart& part, const SurfaceColors* colors,
               std::vector<MeshLevel>& levels) {
  std::optional<Occluder> occluder;
  std::optional<SurfaceLabels> labels;
  // All atlases come first: charts that do not fit leave no maps behind.
  std::vector<TextureAtlas> atlases;
  for (std::size_t level = 0; level < levels.size(); ++level)
    atlases.push_back(make_level_atlas(*levels[level].mesh, sinks, level));
  const int coarsest = level_side(sinks, levels.size() - 1);
  if (sinks.bake > 0 && levels.size() > 1 && coarsest < kCoarseMap)
    job.say(fmt::format("note: maps of level {} have {} x {} texels; --bake {} gives them {}",
                        levels.size() - 1, coarsest, coarsest, kCoarseMap << (levels.size() - 1),
                        kCoarseMap));
  job.summary["charts"] = nlohmann::ordered_json::array();
  if (sinks.bake > 0) job.summary["maps"] = nlohmann::ordered_json::array();
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const TriangleMesh& mesh = *levels[level].mesh;
    const TextureAtlas& atlas = atlases[level];
    MeshSkin skin{atlas.coordinates};
    skin.tangents = vertex_tangents(mesh, skin.coordinates);
    const AtlasStretch stretch = atlas_stretch(mesh, skin.coordinates);
    job.summary["charts"].push_back(atlas_figures(atlas, stretch));
    if (sinks.bake > 0) {
      if (!occluder) occluder.emplace(job, part, atlas.texel);
      if (!labels) labels.emplace(part.recipe, part.field);
      const BakeSources all{part.field, *labels, colors, occluder->get()};
      const BakedMaps maps = bake_maps(all, {mesh, atlas, skin.tangents}, job.progress("bake"));
      add_maps(job, sinks.file, level, maps, skin);
      if (sinks.sheet) sinks.sheet->add(sinks.member, level, levels.size(), mesh, skin, maps);
    }
    levels[level].skin = std::make_shared<const MeshSkin>(std::move(skin));
  }
}

}  // namespace astrolith
