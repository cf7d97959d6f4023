#include <algorithm>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "synthesis/mesh/sample_grid.h"
#include "tasks/job/output_names.h"
#include "tasks/synth/bake.h"
#include "tasks/synth/detail_levels.h"
#include "tasks/synth/ground_maps.h"
#include "tasks/synth/mesh_job.h"
#include "tasks/synth/surface_gravity.h"

namespace astrolith {

namespace fs = std::filesystem;

std::vector<NamedFile> list_files(MeshSinks& sinks) {
  return {{"--output", &sinks.file},
          {"--preview", &sinks.preview.file},
          {"--preview-maps", &sinks.preview.maps},
          {"--height-map", &sinks.height_map},
          {"--hazard-map", &sinks.hazard_map},
          {"--feature-list", &sinks.landforms},
          {"--write-recipe", &sinks.recipe}};
}

std::vector<fs::path> mesh_files(const MeshSinks& sinks, const fs::path& file) {
  std::vector<fs::path> files = level_files(file, sinks.levels);
  for (fs::path& map : map_files(file, sinks)) files.push_back(std::move(map));
  return files;
}

void declare_mesh_options(Job& job, MeshJob& mesh) {
  auto& [spec, sinks, device, max_memory_gb, only_predict] = mesh;
  Option resolution =
      job.options
          .add_option("--resolution", spec.resolution, "cells along the body's longest side, border included")
          .check(in_range(kMinResolution, kMaxResolution));
  job.options
      .add_option("--triangles", spec.triangles,
                  "choose the resolution that gives this many triangles, to about a twentieth, such as 1e6")
      .check(in_range(100.0, 1e10))
      .excludes(resolution)
      .default_text("");
  job.options
      .add_option(
          "--max-memory", max_memory_gb,
          "stay below this many gigabytes of memory: a mesh that is predicted to need more is refused, one "
          "that turns out to need more is stopped; without it meshes predicted to need more than three "
          "quarters of the machine's memory are refused")
      .check(above_zero())
      .default_text("");
  job.options.add_flag(
      "--predict", only_predict,
      "only say how many triangles, bytes (of .ply.zst before it is compressed), how much "
      "memory and how many "
      "seconds the mesh would take, from a coarse mesh and some places of its surface; "
      "nothing is written but "
      "the summary. Seconds of the processor are those of all threads together; seconds on "
      "idle cores are what "
      "the clock shows while nothing else runs on them. Triangles are mostly within 30 %, memory "
      "within 50 %, seconds "
      "within a factor of two. With --members it is said of the meshes and recipes of the "
      "set, from up to eight "
      "of them");
  Option tile =
      job.options
          .add_option(
              "--tile", spec.tile,
              "only tile I of N, slabs along z that many machines can make: open where cut, with the same "
              "vertices there as the next tile, so that all join without cracks; --summary then has a "
              "certificate for check_tiles")
          .placeholder("I/N");
  job.options
      .add_option(
          "--patch", spec.patch,
          "only what a cube holds of the surface, given by its centre and its side; --resolution then "
          "counts cells along that side. Its vertices are relative to the centre, which the file states "
          "as its origin")
      .expected(4)
      .excludes(tile)
      .placeholder("X Y Z SIDE");
  job.options
      .add_flag(
          "--aligned", spec.aligned,
          "the cube of --patch stands on its ground: it is turned so that one axis is the mean normal of "
          "the surface in it. A --height-map then has the cube's square and no empty border; vertices "
          "still lie along the recipe's axes")
      .needs(job.options.option("--patch"));
  job.options
      .add_option(
          "--min-component", spec.least_component,
          "leave out pieces and cavities of less volume than this share of the largest piece's; the mesh is "
          "then made twice")
      .check(in_range(0.0, 1.0))
      .default_text("0, all stay");
  job.options.add_flag(
      "--even", spec.even,
      "make the triangles more even: vertices move along the surface by about a quarter of a cell, and back "
      "onto it, but for those at the cuts of tiles and patches. Keeps the mesh in memory, about 75 bytes for "
      "each triangle");
  job.options
      .add_option("--lod", sinks.levels,
                  "levels of detail: so many meshes, each of a quarter of the triangles of the one before. A "
                  ".glb holds all of them (MSFT_lod); of other formats they are files: rock.ply, "
                  "rock_lod1.ply. The summary says how far each one lies from the finest")
      .check(in_range(1, 10))
      .placeholder("N");
  job.options
      .add_option(
          "--height-map", sinks.height_map,
          "also the patch as a GeoTIFF of metres over its mean plane, and its frame beside it as JSON")
      .placeholder("FILE.tif")
      .writes(height_map_files);
  job.options.add_flag("--points", spec.points,
                       "only the mesh's vertices with their outward unit normals, as an oriented point cloud "
                       "(.ply without faces)");
  job.options.add_flag(
      "--labels", spec.labels,
      "with each vertex the layer that changed the surface most there (0 = the bare body, 1 = "
      "the recipe's first layer; the file's header says which is which) and the height of "
      "all layers (.ply)");
  Option uv =
      job.options
          .add_option(
              "--uv", spec.uv,
              "texture coordinates in a .glb or .obj. longitude, which --uv means by itself: u = 1/2 + "
              "longitude / 360 degrees, v from the north pole to the south; the 180th meridian cuts the "
              "triangles that cross it. charts: an atlas of charts of one scale, none of which overlap, "
              "padded by 4 texels of a map of 2048, or of --bake")
          .check(one_of({"longitude", "charts"}))
          .implied("longitude")
          .default_text("");
  job.options
      .add_option(
          "--bake", sinks.bake,
          "with --uv charts: maps of N x N texels that show the whole recipe on this mesh, however "
          "coarse it is. Each texel is carried along the mesh's normal to the surface. Files beside "
          "the mesh: rock_normal.png (tangent space, MikkTSpace, y up), _height (16 bits), "
          "_occlusion, _curvature, _label, _color where the recipe has colours, and _albedo (16 bits, "
          "linear, 65535 = 1) where it states one; a .glb holds normals, "
          "occlusion and colours in its material. Maps of each level of --lod have half of the side, "
          "64 at least")
      .check(in_range(kLeastMap, kMostMap))
      .placeholder("N")
      .default_text("")
      .needs(uv);
  for (const char* excluded : {"--tile", "--patch", "--points"}) {
    job.options.option("--bake").excludes(job.options.option(excluded));
  }
  device.add_to(job.options);
  declare_preview_options(job, sinks.preview);
  job.options
      .add_option(
          "--gravity", spec.gravity,
          "with each vertex potential, acceleration, slope and elevation for this density and this period of "
          "rotation about z, 0 = at rest (.ply); of a patch, for the mass of the whole body")
      .expected(2)
      .placeholder("KG_M3 HOURS");
  job.options
      .add_option(
          "--hazard-map", sinks.hazard_map,
          "also a GeoTIFF with the pixels of --height-map that says of the ground that a lander stands "
          "on, about each pixel, its slope in degrees, its roughness in metres, and the diameter of the "
          "largest boulder in it")
      .placeholder("FILE.tif")
      .needs(job.options.option("--patch"))
      .needs(job.options.option("--gravity"))
      .writes();
  job.options
      .add_option("--footprint", sinks.footprint,
                  "of --hazard-map: the side of the square of ground that a lander stands on")
      .placeholder("L")
      .needs(job.options.option("--hazard-map"))
      .default_text("");
  job.options
      .add_option("--feature-list", sinks.landforms,
                  "also a list of the craters and boulders, those of the recipe and those drawn: places, "
                  "sizes, ages and angles (degrees), in the recipe's unit")
      .placeholder("FILE.csv|FILE.json")
      .writes();
  for (const char* excluded : {"--tile", "--patch", "--points", "--labels", "--gravity"}) {
    job.options.option("--lod").excludes(job.options.option(excluded));
  }
}

void check_mesh(const MeshJob& mesh, const Recipe& recipe, const fs::path& file) {
  const MeshSpec& spec = mesh.spec;
  const Region region = make_region(spec);
  const auto refuse_eroded = [&](bool is_asked, const std::string& reason, const char* option) {
    if (!recipe.erosion || !is_asked) return;
    throw InputError(file.string() + ": erosion: " + reason + "; leave out " + option +
                     ", or take erosion out of the recipe");
  };
  refuse_eroded(region.is_cut() || spec.points, "is of the whole mesh",
                region.is_patch   ? "--patch"
                : region.is_cut() ? "--tile"
                                  : "--points");
  refuse_eroded(mesh.sinks.levels > 1, "is of one mesh", "--lod");
  refuse_eroded(spec.labels, "moves what layers made", "--labels");
  refuse_eroded(mesh.sinks.bake > 0, "moves the mesh away from the layers that maps show", "--bake");
  if (!spec.gravity.empty() && (region.tile.count > 1 || spec.points || spec.labels)) {
    throw InputError("--gravity: is of the whole body or a patch; leave out --tile, --points and --labels");
  }
  if (mesh.sinks.bake > 0 && !spec.has_charts())
    throw InputError("--bake: maps lie on charts; add --uv charts");
  check_gravity(spec.gravity, recipe);
  if (spec.least_component > 0.0 && region.is_cut()) {
    throw InputError(
        "--min-component: the size of a piece that is cut is not known; leave out --tile and "
        "--patch");
  }
}

void check_mesh_name(const MeshJob& mesh, const fs::path& file) {
  const MeshSpec& spec = mesh.spec;
  const MeshFormat& format = written_mesh_format(file);
  if (spec.points || spec.labels || !spec.gravity.empty()) require_mesh_format(file, &MeshFormat::has_values);
  if (!spec.uv.empty()) require_mesh_format(file, &MeshFormat::has_texture_coordinates);
  if ((spec.even || mesh.sinks.levels > 1) && format.counts != nullptr) {
    throw InputError(file.string() + ": has facets of its own; leave out --even and --lod, or write a .ply");
  }
}

void check_mesh_outputs(const Job& job, const MeshJob& mesh) {
  const MeshSinks& sinks = mesh.sinks;
  if (sinks.file.empty() && sinks.arrays && (sinks.levels > 1 || !mesh.spec.uv.empty()))
    throw InputError("--lod, --uv: are of a file; name it by --output");
  if (!sinks.file.empty()) {
    check_mesh_name(mesh, sinks.file);
    for (const fs::path& file : mesh_files(sinks, sinks.file)) require_writable(file);
  }
  check_preview(job, sinks.preview);
  for (const fs::path& map : {sinks.height_map, sinks.hazard_map}) {
    if (!map.empty()) require_extension(map, {".tif"});
  }
  if (sinks.landforms.empty()) return;
  require_extension(sinks.landforms, {".csv", ".json"});
  require_writable(sinks.landforms);
}

MeshCost estimate_cost(const MeshJob& mesh, const Recipe& recipe) {
  // A triangle and its half vertex: half a vertex and half a normal as doubles, and a triangle; half of one
  // array is copied as it grows.
  constexpr double kCollected = 36.0 + 6.0;
  // Evening keeps the mesh as it was recorded, and has neighbours, places and vertices before and after a
  // pass.
  constexpr double kRecorded = 24.0 + 6.0, kEvenTables = 50.0;
  // The picture, and facets, nodes and multipoles of gravity with its eight columns at half a vertex.
  constexpr double kPicture = 120.0, kGravityTables = 240.0;
  constexpr double kMapTexel = 22.0;  // six maps with their floats, their borders and their files
  constexpr double kLabelShare = 0.5, kEvenShare = 0.5;
  const auto& [spec, sinks, device, max_memory_gb, only_predict] = mesh;
  const MeshFormat& format = sinks.format();
  const bool has_gravity = !spec.gravity.empty();
  const double used = std::max({sinks.need_whole() ? kPicture : 0.0, recipe.erosion ? kErosionTables : 0.0,
                                has_gravity ? kGravityTables : 0.0});
  MeshCost cost;
  if (format.streamed) {
    // Two numbers of four bytes at half a vertex with labels, eight with gravity.
    cost.file_bytes = format.file_bytes + (spec.labels ? 4.0 : has_gravity ? 16.0 : 0.0);
    cost.held_bytes = used > 0.0 ? kCollected + used : 0.0;
  } else {
    // Texture coordinates are two numbers of four bytes at half a vertex, and have triangles of their own.
    const double mapped = spec.uv.empty() ? 0.0 : 4.0;
    cost.file_bytes = format.file_bytes + mapped;
    cost.held_bytes = kCollected + format.kept_bytes + used + 4.0 * mapped;
  }
  if (spec.even) cost.held_bytes += kRecorded;
  cost.table_bytes = spec.even ? kEvenTables : 0.0;
  cost.map_bytes = kMapTexel * sinks.bake * sinks.bake;
  cost.times = spec.least_component > 0.0 ? 2.0 : 1.0;
  cost.shares = (spec.labels ? kLabelShare : 0.0) + (spec.even ? kEvenShare : 0.0);
  return cost;
}

}  // namespace astrolith
